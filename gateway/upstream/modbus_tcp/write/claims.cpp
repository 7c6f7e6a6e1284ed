// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/write/claims.hpp"

namespace axisgate::modbus_tcp {

bool register_claims(const WriteBatch& batch) {
  if (!batch.setpoints.empty() || batch.mode || batch.set_position_value || batch.jog_velocity) return true;
  if (batch.controlword && !is_stop(*batch.controlword, batch.single_controlword)) return true;
  return batch.command != Command::none && !is_stop(batch.command) && !hands_over(batch.command);
}

// Coil 1 (fault_reset) neither takes nor needs the lease while nobody owns the axis: it never enables.
bool coil_claims(Command command) { return command == Command::enable || asks_to_move(command); }

}  // namespace axisgate::modbus_tcp
