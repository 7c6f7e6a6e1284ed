// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/client/row_memory.hpp"

namespace axisgate::modbus_tcp {
namespace {

// Offsets of design 3.1.
constexpr std::uint16_t kTargetPosition = 42;
constexpr std::uint16_t kTargetVelocity = 44;
constexpr std::uint16_t kTargetTorque = 46;
constexpr std::uint16_t kHomingMethod = 60;

}  // namespace

std::uint64_t RowMemory::targets_of(Command command) const {
  switch (command) {
    case Command::move_absolute:
    case Command::move_relative:
      return changes(kTargetPosition);
    case Command::run_velocity:
      return changes(kTargetVelocity);
    case Command::run_torque:
      return changes(kTargetTorque);
    case Command::home:
      return changes(kHomingMethod);
    default:
      return 0;
  }
}

std::uint64_t RowMemory::targets() const {
  return changes(kTargetPosition) + changes(kTargetVelocity) + changes(kTargetTorque) + changes(kHomingMethod);
}

}  // namespace axisgate::modbus_tcp
