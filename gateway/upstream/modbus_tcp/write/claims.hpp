// SPDX-License-Identifier: Apache-2.0
// What makes a client the owner of an axis (design 3.5): a write that asks for something of registers 40..79,
// coils 4..9 or coil 0 = 1. Promises that a stop, what asks for nothing, and what hands the axis over (commands release
// and take_over) claims nothing. Never looks at who owns the axis: the command port does.
#pragma once

#include "gateway/image/command.hpp"

namespace axisgate::modbus_tcp {

/// Of a register write.
[[nodiscard]] bool register_claims(const WriteBatch& batch);
/// Of what one coil asks.
[[nodiscard]] bool coil_claims(Command command);

}  // namespace axisgate::modbus_tcp
