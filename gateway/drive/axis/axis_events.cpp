// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/axis_events.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>

#include "gateway/core/words.hpp"
#include "gateway/drive/axis/command_text.hpp"
#include "gateway/drive/plan/admission.hpp"

namespace axisgate::drive {
namespace {

std::string outcome_text(const WriteBatch& batch, const Outcome& outcome) {
  return batch.life && batch.life->strength ? dds_text(outcome) : modbus_text(outcome);
}

/// What is wrong with a Modbus request itself its server tells, which knows the rows.
bool told_by_its_server(const WriteBatch& batch, Errc code) {
  const bool modbus = batch.life && !batch.life->strength;
  return modbus && (code == Errc::bad_value || code == Errc::not_supported || code == Errc::role_forbidden);
}

/// Those that the drive must tell for what it does not give a value for yet.
std::string constants_awaited(const AxisCore& core) {
  std::vector<std::string> names;
  for (const model::Binding& binding : core.model.bindings)
    for (const auto* needed : {&binding.recipe.mul, &binding.recipe.div})
      for (const std::size_t at : *needed)
        if (const std::string& name = core.drive.constants[at].name;
            !binding.scaled && std::ranges::find(names, name) == names.end())
          names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// ": alarm local_control: ...", of an enable or a start that is refused for what an alarm says, or for want of a
/// target.
std::string why_against(const AxisCore& core, AxisNumber axis, const WriteBatch& batch, Errc code) {
  const bool by_alarm = code == Errc::state_unsuitable || code == Errc::identity_mismatch;
  if (by_alarm && starts_motion(core, batch) && core.alarm(AxisAlarm::units_disagree))
    return ": alarm units_disagree: a fault_reset ends it, once its cause is mended";
  if (code == Errc::still_in_setup && core.reachable() && !core.model.counts_known())
    return ": the drive does not tell " + constants_awaited(core);
  if (code == Errc::state_unsuitable && asks_to_enable(batch) && core.motion.latched_by_another())
    return ": an axis that is stopped as one with it is stop-latched: enable that one";
  const auto target = target_of(batch.command);
  const bool runs = target == Quantity::target_velocity || target == Quantity::target_torque;
  if (code == Errc::state_unsuitable && runs && !core.running_target(*target) && core.motion.may_start(core.facts()))
    return fmt::format(": write {} anew, none was asked for since motions were ended last", row(*target).name);
  if (!by_alarm || !asks_to_enable(batch)) return {};
  const std::string alarm = against_enable(core.alarms, axis);
  return alarm.empty() ? alarm : ": " + alarm;
}

}  // namespace

// --- What was asked --------------------------------------------------------------------------------------------------

// `carried_out`: what has become of a coil that ends a run, or of a stop beside which something was refused. A stop is
// everybody's: whoever owns the axis must see who has used that.
void AxisEvents::asked(const WriteBatch& asked, const WriteBatch& carried_out) {
  if (!asked.life || reads_alone(asked)) return;
  const auto left_out = telling_.asked(carried_out, core_.turn.now);
  if (!left_out) return;
  WriteBatch shown = asked;
  // A target that was accepted and waits for the wire is the one that the start will use.
  const auto target = target_of(asked.command);
  const auto value = target ? core_.asked.accepted(*target) : std::nullopt;
  if (value && !sets(asked, *target)) shown.setpoints.push_back({*target, *value});
  const bool ends_run = asked.command != carried_out.command && is_stop(carried_out.command);
  const bool foreign =
      holds_stop(carried_out) && guard_.ownership().owner() && !guard_.ownership().is_owner(asked.client);
  const std::string who = foreign ? "stopped by " + asked.life->name + std::string(kByAnother) : asked.life->name;
  const std::string how = ends_run ? fmt::format(" ({})", text(carried_out.command)) : std::string();
  event(EventKind::command, static_cast<std::uint32_t>(asked.command),
        fmt::format("{}: {}{}{}", who, command_text(core_, shown, image_.jog_velocity), how, left_out_text(*left_out)));
}

void AxisEvents::owner(const std::string& what) {
  if (const auto left_out = telling_.owner(core_.turn.now)) event(EventKind::lease, 0, what + left_out_text(*left_out));
}

// --- What became of it -----------------------------------------------------------------------------------------------

void AxisEvents::refused(const WriteBatch& asked, const BatchResult& result) {
  const Outcome& outcome = result.outcome;
  if (!asked.life || reads_alone(asked) || told_by_its_server(asked, outcome.code)) return;
  const auto left_out = telling_.refused(asked, outcome.code, core_.turn.now);
  if (!left_out) return;
  const auto owner = guard_.ownership().owner();
  const std::string whose = outcome.code == Errc::not_owner && owner ? "; its owner is " + owner->name : std::string();
  event(EventKind::command, static_cast<std::uint32_t>(asked.command),
        fmt::format("{}: {} is refused: {}{}{}{}{}", asked.life->name, command_text(core_, asked, image_.jog_velocity),
                    outcome_text(asked, outcome), why_against(core_, image_.number, asked, outcome.code),
                    result.limit.empty() ? result.limit : "; its limit is " + result.limit, whose,
                    left_out_text(*left_out)));
}

// A set-point in whose place a newer one was sent is no news; what was not reached is told with what was awaited.
void AxisEvents::ended(const Pending& pending, const Outcome& outcome) {
  const WriteBatch& batch = pending.command_sequence->batch();
  if (outcome.code == Errc::ok || outcome.code == Errc::superseded || outcome.code == Errc::not_reached) return;
  if (batch.client == 0 || reads_alone(batch)) return;
  if (pending.refusal == Errc::ok && told_by_its_server(batch, outcome.code)) return;
  const auto left_out = telling_.refused(batch, outcome.code, core_.turn.now);
  if (!left_out) return;
  const bool beside = pending.refusal != Errc::ok && outcome.code == pending.refusal;
  const bool stopped = outcome.code == Errc::stopped_by_other || outcome.code == Errc::dropped_by_stop;
  const std::string by = stopped && !pending.stopped_by_name.empty() ? ", " + pending.stopped_by_name : std::string();
  const bool by_drive = outcome.code == Errc::refused_by_drive;
  const std::string refused = by_drive ? pending.command_sequence->missed() : std::string();
  const std::string what = batch.jogs ? std::string("jog") : command_text(core_, batch, image_.jog_velocity);
  event(EventKind::command, static_cast<std::uint32_t>(batch.command),
        fmt::format("{}: {}{}: {}{}{}{}{}", batch.life ? batch.life->name : "a client",
                    beside ? "what stood beside " : "", what, outcome_text(batch, outcome),
                    refused.empty() ? refused : ": " + refused, why_against(core_, image_.number, batch, outcome.code),
                    by, left_out_text(*left_out)));
}

void AxisEvents::not_reached(const Pending& pending) {
  const WriteBatch& batch = pending.batch();
  const std::string who = batch.life ? batch.life->name + ": " : std::string();
  const std::string what = batch.command == Command::none ? "a write" : std::string(text(batch.command));
  event(EventKind::command, static_cast<std::uint32_t>(batch.command),
        who + what + " was not reached: " + pending.command_sequence->missed());
}

}  // namespace axisgate::drive
