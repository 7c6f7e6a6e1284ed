// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/capture/causes.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "gateway/core/error.hpp"
#include "gateway/core/name_table.hpp"
#include "gateway/image/events.hpp"
#include "gateway/upstream/web_process/values/value_names.hpp"

namespace axisgate::web {
namespace {

/// A result's age comes in whole milliseconds.
constexpr SteadyNs kResultTremble = 5 * kMillisecond;
constexpr std::uint32_t kNoResult = UINT32_MAX;

constexpr auto kNames = names_of<Cause>({
    {Cause::fault, "fault"},
    {Cause::link_lost, "link_lost"},
    {Cause::lease_stop, "lease_stop"},
    {Cause::stranger_stop, "stranger_stop"},
    {Cause::command_failed, "command_failed"},
    {Cause::unexpected_motion, "unexpected_motion"},
    {Cause::units_disagree, "units_disagree"},
    {Cause::trigger, "trigger"},
});
static_assert(kNames.has_all_to(last_of(Cause{})));

bool is_out_of_sight(LinkState link) { return link == LinkState::offline || link == LinkState::link_down; }
/// What it shows is what the drive shows.
bool is_seen(LinkState link) { return link == LinkState::online || link == LinkState::suspect; }

bool has(const AxisSample& sample, AxisAlarm alarm) { return (sample.alarms & bit(alarm)) != 0; }

bool is_faulted(const AxisSample& sample) {
  return (sample.inputs & bit(AxisInput::fault)) != 0 ||
         sample.axis_state == static_cast<std::uint8_t>(AxisState::error_stop);
}

}  // namespace

std::string_view text(Cause cause) { return kNames.of(cause); }

Causes::Causes(std::vector<Trigger> triggers) : settings_(std::move(triggers)) { begin(0); }

void Causes::begin(SteadyNs now) {
  if (began_ == 0) began_ = now;
  seen_.clear();
  triggers_.clear();
  for (const Trigger& trigger : settings_) triggers_.emplace_back(trigger);
}

std::vector<CauseSeen> Causes::in(const SamplesRecord& record, const Picture& picture) {
  std::vector<CauseSeen> out;
  for (const AxisSample& sample : record.axes) {
    const AxisPicture* axis = picture.find(sample.axis);
    if (axis == nullptr) continue;
    look(sample, record.at, out);
    look_at_triggers(sample, record.at, *axis, out);
  }
  return out;
}

void Causes::look(const AxisSample& sample, SteadyNs at, std::vector<CauseSeen>& out) {
  Seen& seen = seen_[sample.axis];
  const auto link = static_cast<LinkState>(sample.link_state);
  const auto add = [&](Cause cause, std::string what) { out.push_back({cause, sample.axis, at, std::move(what)}); };
  // Once it was online: a drive that is searched for goes to and fro between setup and offline.
  if (link == LinkState::online || is_out_of_sight(link))
    if (seen.lost.rises(is_out_of_sight(link))) add(Cause::link_lost, "the link is lost");
  if (is_seen(link)) {
    if (seen.fault.rises(is_faulted(sample))) add(Cause::fault, std::string(kFaultUnnamed));
    if (seen.unexpected_motion.rises(has(sample, AxisAlarm::unexpected_motion)))
      add(Cause::unexpected_motion, "a motion that nothing explains");
    if (seen.units_disagree.rises(has(sample, AxisAlarm::units_disagree)))
      add(Cause::units_disagree, "position and velocity do not fit each other");
  }
  const bool failed =
      sample.result == static_cast<std::uint8_t>(CommandResult::not_reached) && sample.result_age_ms != kNoResult;
  const SteadyNs failed_at = failed ? at - sample.result_age_ms * SteadyNs{kMillisecond} : 0;
  if (failed && seen.failed && std::abs(failed_at - *seen.failed) > kResultTremble)
    add(Cause::command_failed, sample.result_what + " of " + sample.result_who + " was not reached");
  seen.failed = failed_at;
}

void Causes::look_at_triggers(const AxisSample& sample, SteadyNs at, const AxisPicture& axis,
                              std::vector<CauseSeen>& out) {
  for (TriggerWatch& watch : triggers_) {
    const Trigger& trigger = watch.trigger();
    const bool valid = (sample.valid & sample.supported & bit(trigger.quantity)) != 0;
    if (trigger.axis != sample.axis || !valid) continue;
    for (const Value& value : sample.values)
      if (value.quantity == static_cast<std::uint8_t>(trigger.quantity)) {
        const std::int64_t number = axis.of(trigger.quantity).value;
        if (watch.sees(number, value_json(trigger.quantity, number, axis.info).get<double>()))
          out.push_back({Cause::trigger, sample.axis, at, trigger.name});
      }
  }
}

std::optional<CauseSeen> Causes::in(const EventRecord& event) const {
  if (event.axis == 0 || event.at < began_) return std::nullopt;
  const auto kind = static_cast<EventKind>(event.kind);
  // Of a lease that ends where nothing is done, or that goes to another, the code is 0.
  if (kind == EventKind::lease && event.code != 0)
    return CauseSeen{Cause::lease_stop, event.axis, event.at, event.text};
  if (kind == EventKind::command && event.text.find(kByAnother) != std::string::npos)
    return CauseSeen{Cause::stranger_stop, event.axis, event.at, event.text};
  return std::nullopt;
}

}  // namespace axisgate::web
