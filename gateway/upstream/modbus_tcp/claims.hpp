// What makes a client the owner of an axis (design 3.5): a write to registers 40..79, coils 4..9 or coil 0 = 1, whether
// or not anything in it acts. Promises that a request of nothing but stops, and one that hands the axis over (commands
// release and take_over), claims nothing. Never looks at who owns the axis: the command port does.
#pragma once

#include "gateway/upstream/modbus_tcp/row_writes.hpp"

namespace axisgate::modbus_tcp {

/// The group asks for something to be done: without that it is submitted for its client's ownership alone, and leaves
/// the client's result registers as they are.
[[nodiscard]] bool asks_nothing(const Group& group);

/// Of a register write that was checked. `group`: what it asks of the axis.
[[nodiscard]] bool claims(const RowWrites& found, const Group& group, Role role);
/// Of a coil write that was checked; `first`: the offset of its first coil.
[[nodiscard]] bool claims(const Request& coils, std::uint16_t first);

}  // namespace axisgate::modbus_tcp
