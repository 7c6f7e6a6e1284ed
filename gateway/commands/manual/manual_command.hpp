// SPDX-License-Identifier: Apache-2.0
// `axisgate enable|move|jog|stop [HOST:PORT] AXIS`: one axis of a running gateway, moved manually over Modbus-TCP.
// Promises that the position is shown live, and that Ctrl-C, a signal, a terminal that is gone and a network that is
// lost stop the axis: the first three by a stop that is awaited, the last one by the axis's lease. Never presses a jog
// button but for a key.
#pragma once

#include <string>

#include "gateway/commands/client/named_axis.hpp"
#include "gateway/commands/manual/plan/manual_plan.hpp"

namespace axisgate::commands {

struct ManualOptions {
  ManualArguments arguments;  ///< its axis is that of `typed`
  TypedAxis typed{};
  std::string turns;  ///< of a move, as typed
  std::string rpm;    ///< empty: as it is
};

/// What is wrong with a number as typed; empty: nothing.
[[nodiscard]] std::string turns_mistake(const std::string& typed);
[[nodiscard]] std::string rpm_mistake(const std::string& typed);

/// Exit status: 0 where it was done: the axis stands at its target, was given back, was stopped; 1 where not; 2 for a
/// command line that is wrong.
[[nodiscard]] int run(const ManualOptions& options);

}  // namespace axisgate::commands
