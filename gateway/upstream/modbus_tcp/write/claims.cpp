// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/write/claims.hpp"

#include "gateway/upstream/modbus_tcp/client/edges.hpp"

namespace axisgate::modbus_tcp {
namespace {

bool hands_over(Command command) { return command == Command::release || command == Command::take_over; }

}  // namespace

bool register_claims(const WriteBatch& batch) {
  if (!batch.setpoints.empty() || batch.mode || batch.set_position_value || batch.jog_velocity) return true;
  // Bits 0..3 = 6 or 7 are a stop of anybody's in a single write alone; the words without bit 1 or 2 always are.
  constexpr std::uint16_t kStoppingBits = 0x0006;
  if (batch.controlword) {
    const bool stops = (*batch.controlword & kStoppingBits) != kStoppingBits;
    if (!stops && !(batch.single_controlword && is_stop_controlword(*batch.controlword))) return true;
  }
  return batch.command != Command::none && !is_stop(batch.command) && !hands_over(batch.command);
}

// Coil 1 (fault_reset) neither takes nor needs the lease while nobody owns the axis: it never enables.
bool coil_claims(Command command) {
  switch (command) {
    case Command::enable:
    case Command::move_absolute:
    case Command::move_relative:
    case Command::home:
    case Command::run_velocity:
    case Command::jog_forward:
    case Command::jog_reverse:
      return true;
    default:
      return false;
  }
}

}  // namespace axisgate::modbus_tcp
