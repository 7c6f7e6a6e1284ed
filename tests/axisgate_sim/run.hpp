// SPDX-License-Identifier: Apache-2.0
// The simulator's poll loop: signals, ptys, control socket and the drives' next event, in one thread.
// Promises to end with 0 on SIGINT and SIGTERM, with every link and socket removed by their owners.
// Never decides anything about a drive.
#pragma once

#include "tests/axisgate_sim/control_socket.hpp"
#include "tests/axisgate_sim/simulator.hpp"

namespace axisgate::simulated {

// Call before any thread or signal may come; `run` then hears them.
Descriptor block_end_signals();

void run(Simulator& simulator, ControlSocket* control, const Descriptor& end_signals);

}  // namespace axisgate::simulated
