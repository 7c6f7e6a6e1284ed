#include "gateway/upstream/modbus_tcp/claims.hpp"

#include "gateway/upstream/modbus_tcp/edges.hpp"

namespace axisgate::modbus_tcp {
namespace {

constexpr std::uint16_t kFirstOwned = 40;
constexpr std::uint16_t kLastOwned = 79;

// Coils, by their offsets.
constexpr unsigned kEnable = 0;
constexpr unsigned kFirstStart = 4;
constexpr unsigned kRunVelocity = 7;

/// Coil 7 = 0 halts, or finds nothing to halt; a button that is let go claims nothing. Coils 8 and 9 are held by the
/// owner alone, and so claim with 0 as well.
bool coil_claims(unsigned offset, bool value) {
  if (offset == kEnable || offset == kRunVelocity) return value;
  return offset >= kFirstStart && offset < kCoils;
}

bool hands_over(Command command) { return command == Command::release || command == Command::take_over; }

bool is_controlword(const RegisterRow& row) {
  return row.source == Source::quantity && row.quantity == Quantity::controlword;
}

}  // namespace

bool asks_nothing(const Group& group) {
  return group.setpoints.empty() && !group.mode && !group.controlword && group.command == Command::none &&
         !group.set_position_value && !group.jog_velocity && !group.object;
}

bool claims(const RowWrites& found, const Group& group, Role role) {
  // A viewer comes this far with rows alone that the drive holds already.
  if (role < Role::operator_) return false;
  const RowWrite* const row = found.of(Source::command);
  const Command command = row == nullptr ? Command::none : Command{static_cast<std::uint8_t>(row->value)};
  if (hands_over(command)) {
    // A scanner's block keeps the command that it was given: it must not take back at once what it has released. So
    // only what it asks for anew counts.
    Group rest = group;
    rest.command = Command::none;
    return !asks_nothing(rest);
  }
  for (const RowWrite& each : found.rows) {
    const RegisterRow& it = *each.row;
    if (it.offset < kFirstOwned || it.offset > kLastOwned) continue;
    const bool of_a_stop = (it.source == Source::command || it.source == Source::command_id) && is_stop(command);
    // Judged by its value: pressed twice within rearm_ms, the second press is a stop as well.
    const bool is_single_stop =
        is_controlword(it) && found.rows.size() == 1 && is_stop_controlword(static_cast<std::uint16_t>(each.value));
    if (!of_a_stop && !is_single_stop) return true;
  }
  return false;
}

bool claims(const Request& coils, std::uint16_t first) {
  for (std::uint16_t i = 0; i < coils.write_count; ++i)
    if (coil_claims(static_cast<unsigned>(first + i), coils.written_coil(i))) return true;
  return false;
}

}  // namespace axisgate::modbus_tcp
