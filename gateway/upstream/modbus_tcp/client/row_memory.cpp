// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/client/row_memory.hpp"

#include "gateway/image/register_map.hpp"

namespace axisgate::modbus_tcp {

std::uint64_t RowMemory::targets_of(Command command) const {
  const auto target = command == Command::home ? std::optional(Quantity::homing_method) : target_of(command);
  return target ? changes(axis_offset(*target)) : 0;
}

std::uint64_t RowMemory::targets() const {
  using enum Quantity;
  std::uint64_t sum = 0;
  for (const Quantity target : {target_position, target_velocity, target_torque, homing_method})
    sum += changes(axis_offset(target));
  return sum;
}

}  // namespace axisgate::modbus_tcp
