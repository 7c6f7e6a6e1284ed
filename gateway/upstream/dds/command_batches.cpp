// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/command_batches.hpp"

#include <array>

#include "gateway/image/register_map.hpp"
#include "gateway/image/shown.hpp"
#include "gateway/upstream/dds_link/stop_commands.hpp"

namespace axisgate::dds {
namespace {

/// The numbers that axisgate-dds lets pass are those of the stops.
constexpr bool one_set_of_stops() {
  for (unsigned number = 0; number <= UINT8_MAX; ++number) {
    const auto command = static_cast<std::uint8_t>(number);
    const bool stop = is_stop(Command{command}) || Command{command} == Command::jog_end;
    if (is_stop_command(command) != stop) return false;
  }
  return true;
}
static_assert(one_set_of_stops());

struct Member {
  std::uint32_t has;
  Quantity quantity;
  double CommandRecord::*value;
};
/// In register order. Mode and homing method are numbers of their own.
constexpr std::array kMembers{
    Member{kHasTargetPosition, Quantity::target_position, &CommandRecord::target_position},
    Member{kHasTargetVelocity, Quantity::target_velocity, &CommandRecord::target_velocity},
    Member{kHasTargetTorque, Quantity::target_torque, &CommandRecord::target_torque},
    Member{kHasMaxTorque, Quantity::max_torque, &CommandRecord::max_torque},
    Member{kHasProfileVelocity, Quantity::profile_velocity, &CommandRecord::profile_velocity},
    Member{kHasProfileAcceleration, Quantity::profile_acceleration, &CommandRecord::profile_acceleration},
    Member{kHasProfileDeceleration, Quantity::profile_deceleration, &CommandRecord::profile_deceleration},
};

/// What says which motion is meant: beside a jog nobody could tell which of the two.
constexpr std::uint32_t kOtherMotion =
    kHasMode | kHasTargetPosition | kHasTargetVelocity | kHasTargetTorque | kHasHomingMethod | kHasSetPositionValue;

bool jogs(Command command) { return is_jog(command) || command == Command::jog_end; }

Command command_of(const CommandRecord& record) { return Command{record.command}; }

bool is_known(const CommandRecord& record) { return record.command <= kLastCommand || jogs(command_of(record)); }

bool has(const CommandRecord& record, std::uint32_t bits) { return (record.mask & bits) != 0; }

/// The drive has everything that the mask names.
bool members_exist(const CommandRecord& record, const AxisImage& axis) {
  for (const Member& member : kMembers)
    if (has(record, member.has) && !axis.takes(member.quantity)) return false;
  if (has(record, kHasMode) && !axis.takes(Quantity::mode)) return false;
  if (has(record, kHasHomingMethod) && !axis.takes(Quantity::homing_method)) return false;
  if (has(record, kHasJogVelocity) && !axis.supports(Command::run_velocity)) return false;
  return !has(record, kHasSetPositionValue) || axis.supports(Command::set_position);
}

bool command_exists(Command command, const AxisImage& axis) {
  return command == Command::none || axis.supports(jogs(command) ? Command::run_velocity : command);
}

/// Puts what the mask names into the write batch; false: a register could not hold it.
bool put_members(const CommandRecord& record, const AxisImage& axis, const DdsUnits& units, bool held,
                 WriteBatch& batch) {
  if (has(record, kHasMode)) batch.mode = record.mode;
  for (const Member& member : kMembers) {
    if (!has(record, member.has)) continue;
    const auto value = units.to_register(member.quantity, record.*member.value);
    if (!value) return false;
    batch.setpoints.push_back({member.quantity, *value});
  }
  if (has(record, kHasHomingMethod)) {
    if (!range_of(row(Quantity::homing_method).type).holds(record.homing_method)) return false;
    batch.setpoints.push_back({Quantity::homing_method, record.homing_method});
  }
  if (has(record, kHasSetPositionValue)) {
    const auto value = units.to_register(Kind::position, RegisterType::i32, record.set_position_value);
    if (!value) return false;
    batch.set_position_value = static_cast<std::int32_t>(*value);
  }
  if (has(record, kHasJogVelocity)) {
    const auto value = units.to_register(Kind::velocity, RegisterType::u32, record.jog_velocity);
    if (!value) return false;
    // A button that is held tells the same velocity again and again.
    const auto velocity = static_cast<std::uint32_t>(*value);
    // Refused before it is written: that would claim the axis for a jog that cannot begin.
    if (velocity == 0 && is_jog(command_of(record))) return false;
    if (!held || velocity != axis.jog_velocity) batch.jog_velocity = velocity;
  }
  return true;
}

/// What stands beside the command, or the reason why it cannot be taken.
struct Beside {
  WriteBatch batch;
  Errc wrong = Errc::ok;
};

Beside read_members(const CommandRecord& record, const WriteBatch& from, const AxisImage& axis, const DdsUnits& units,
                    bool held) {
  Beside out{from};
  const bool unclear = jogs(command_of(record)) && has(record, kOtherMotion);
  if (!members_exist(record, axis))
    out.wrong = Errc::not_supported;
  else if ((record.mask & ~kHasAny) != 0 || unclear || !put_members(record, axis, units, held, out.batch))
    out.wrong = Errc::bad_value;
  return out;
}

WriteBatch alone(const WriteBatch& from, Command command, bool claims) {
  WriteBatch batch = from;
  batch.command = command;
  batch.claims = claims;
  return batch;
}

CommandPlan plan_jog(Command command, const WriteBatch& from, WriteBatch beside, bool writes, bool held) {
  CommandPlan plan;
  beside.claims = true;
  if (command == Command::jog_end) {
    plan.batches.push_back(alone(from, command, false));
    if (writes) plan.batches.push_back(beside);
  } else if (held) {
    // With what is written beside it: what that waits for must not let the jog run out of time.
    beside.jog_again = command;
    plan.batches.push_back(beside);
  } else {
    // A jog begins at the velocity that the axis holds: it is written first.
    if (writes) plan.batches.push_back(beside);
    plan.batches.push_back(alone(from, command, true));
  }
  return plan;
}

}  // namespace

bool stops(const CommandRecord& record) { return is_stop_command(record.command); }

bool lets_go(const CommandRecord& record) { return stops(record) || command_of(record) == Command::release; }

bool starts(const CommandRecord& record, bool held) {
  const Command command = command_of(record);
  return command == Command::enable || (asks_to_move(command) && !(is_jog(command) && held));
}

bool velocity_runs(const AxisImage& axis) {
  constexpr unsigned kVelocityRuns = 1U << 7U;
  return (unsigned{shown_level_coils(axis)} & kVelocityRuns) != 0;
}

bool begins_beside(const CommandRecord& record, const AxisImage& axis) {
  const bool moves = axis.axis_state == AxisState::discrete_motion;
  const bool runs = axis.axis_state == AxisState::continuous_motion || velocity_runs(axis);
  if (has(record, kHasMode) && !((moves || runs) && record.mode == shown_value(axis, Quantity::mode_display)))
    return true;
  if (has(record, kHasTargetPosition) && !moves) return true;
  return has(record, kHasTargetVelocity | kHasTargetTorque) && !runs;
}

PlannedCommand plan_command(const CommandRecord& record, const WriteBatch& from, const AxisImage* axis,
                            const DdsUnits& units, bool held) {
  const Command command = command_of(record);
  if (from.role < Role::operator_) return Errc::role_forbidden;
  if (command == Command::save_parameters && from.role < Role::engineer) return Errc::role_forbidden;
  if (axis == nullptr) return Errc::no_path;
  if (!is_known(record) || (command == Command::none && record.mask == 0)) return Errc::bad_value;
  if (!command_exists(command, *axis)) return Errc::not_supported;

  WriteBatch asks = from;
  asks.beats = true;
  asks.command_id = static_cast<std::uint16_t>(record.request_id & 0xFFFFU);
  Beside beside = read_members(record, asks, *axis, units, held);
  if (beside.wrong != Errc::ok) {
    if (!stops(record)) return beside.wrong;
    return CommandPlan{{alone(asks, command, false)}, beside.wrong};
  }
  const bool writes = record.mask != 0;
  if (jogs(command)) return plan_jog(command, asks, beside.batch, writes, held);
  beside.batch.command = command;
  // Stops, and what hands the axis over, claim nothing by themselves.
  beside.batch.claims = writes || !(is_stop(command) || hands_over(command));
  return CommandPlan{{beside.batch}, Errc::ok};
}

}  // namespace axisgate::dds
