// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/poll_plan.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::drive {
namespace {

void add(const model::DriveModel& model, std::vector<PollItem>& items, model::ObjectId object,
         model::PollClass poll_class) {
  if (object == model::kNoObject) return;
  if (model.object(object).is_directed()) add(model, items, model.object(object).part.sign, poll_class);
  object = model.whole(object);
  const auto found = std::ranges::find_if(items, [&](const PollItem& i) { return i.object == object; });
  if (found == items.end())
    items.push_back({object, poll_class, false});
  else
    found->poll_class = std::min(found->poll_class, poll_class);
}

/// It comes by itself, in a known beat, and is asked for never; but the state is.
bool comes_unsolicited(const model::DriveModel& model, model::ObjectId id) {
  if (model.unsolicited.every == Duration{}) return false;
  const auto has = [id](const std::vector<model::ObjectId>& list) { return std::ranges::find(list, id) != list.end(); };
  const bool state = std::ranges::any_of(model.axes, [&](const auto& axis) { return has(axis.state_sources); });
  return !state && has(model.unsolicited.objects);
}

}  // namespace

std::vector<PollItem> poll_items(const model::DriveModel& model) {
  std::vector<PollItem> items;
  for (const model::AxisModel& axis : model.axes) {
    const auto read = [&](model::ObjectId id, model::PollClass poll_class) {
      if (id != model::kNoObject && !model.object(id).emulated) add(model, items, id, poll_class);
    };
    // A PLC sees everything else through the statusword: it, or what it is made from, is never slower than fast.
    for (const model::ObjectId source : axis.state_sources) read(source, model::PollClass::fast);
    read(axis.mode_display, model::PollClass::normal);
    for (const model::ObjectId word : axis.fault_words) add(model, items, word, model::PollClass::normal);
    for (const auto* condition : {&axis.homed, &axis.homing_failed, &axis.moving})
      if (condition->has_value()) add(model, items, (*condition)->object, model::PollClass::normal);
    for (const model::Binding& binding : axis.bindings) {
      if (binding.object != model::kNoObject && model.object(binding.object).readable)
        read(binding.object, binding.poll);
      for (const model::BitField& field : binding.bits) add(model, items, field.object, binding.poll);
    }
  }
  // Their zero is judged at each enable: read once, it need not be written.
  for (const model::AxisModel& axis : model.axes)
    for (const model::ObjectId id : axis.zero_before_enable)
      if (model.object(id).readable) add(model, items, id, model::PollClass::once);
  for (const model::AxisModel& axis : model.axes)
    for (const model::HomingNeed& need : axis.homing_needs)
      for (const model::ObjectId id : need.any_of) add(model, items, id, model::PollClass::once);
  for (const model::Check& check : model.checks) add(model, items, check.bad.object, model::PollClass::once);
  // Scales depend on them, and a panel or the mailbox may change what they follow from.
  for (const model::ObjectId id : model::constant_objects(model)) add(model, items, id, model::PollClass::slow);
  std::erase_if(items, [&](const PollItem& item) {
    return !model.object(item.object).readable || comes_unsolicited(model, item.object);
  });
  for (PollItem& item : items)
    for (const model::TpdoProperties& tpdo : model.canopen.tpdos)
      item.mapped = item.mapped || std::ranges::find(tpdo.map, item.object) != tpdo.map.end();
  return items;
}

PollPlan::PollPlan(const model::DriveModel& model) {
  for (const PollItem& item : poll_items(model)) {
    const auto index = static_cast<std::size_t>(item.poll_class);
    const Duration period = item.poll_class == model::PollClass::once ? Duration{} : model.poll_period[index];
    entries_.push_back({item.object, period, kNever, false, period, {}});
  }
}

void PollPlan::restart(Instant now) {
  for (Entry& e : entries_) e = {e.object, e.beat, now, false, e.beat, {}};
}

void PollPlan::map(model::ObjectId object, std::optional<Duration> event, Duration confirm) {
  Entry* e = entry(object);
  if (e == nullptr || e->beat == Duration{}) return;
  constexpr int kMissedEvents = 3;
  e->silence = event ? kMissedEvents * *event : confirm;
  e->period = event ? e->beat : std::max(e->beat, confirm);
}

void PollPlan::unmap_all(Instant now) {
  for (Entry& e : entries_) {
    if (e.silence == Duration{}) continue;
    e.silence = {};
    e.period = e.beat;
    if (!e.dropped) e.due = std::min(e.due, now);
  }
}

void PollPlan::received(model::ObjectId object, Instant now) {
  Entry* e = entry(object);
  if (e != nullptr && e->silence != Duration{}) e->due = now + std::min(e->silence, e->limit);
}

void PollPlan::confirm_within(model::ObjectId object, std::optional<Duration> limit, Instant now) {
  Entry* e = entry(object);
  if (e == nullptr || e->silence == Duration{}) return;
  const Duration before = std::exchange(e->limit, limit.value_or(Duration::max()));
  if (e->limit < before) e->due = std::min(e->due, now + e->limit);
}

void PollPlan::hurry(model::ObjectId object, Instant now) {
  if (Entry* e = entry(object)) e->due = std::min(e->due, now);
}

const PollPlan::Entry* PollPlan::earliest() const {
  const auto found = std::ranges::min_element(entries_, {}, &Entry::asked_at);
  return found == entries_.end() ? nullptr : &*found;
}

PollPlan::Entry* PollPlan::entry(model::ObjectId object) {
  const auto found = std::ranges::find(entries_, object, &Entry::object);
  return found == entries_.end() || found->dropped ? nullptr : &*found;
}

std::optional<model::ObjectId> PollPlan::next(Instant now) const {
  const Entry* e = earliest();
  if (e == nullptr || e->asked_at() > now) return std::nullopt;
  return e->object;
}

bool PollPlan::due(model::ObjectId object, Instant now) const {
  return std::ranges::any_of(entries_, [&](const Entry& e) { return e.object == object && e.asked_at() <= now; });
}

Instant PollPlan::next_due() const {
  const Entry* e = earliest();
  return e == nullptr ? kNever : e->asked_at();
}

void PollPlan::done(model::ObjectId object, Instant now) {
  Entry* e = entry(object);
  if (e == nullptr || e->due == kNever) return;
  if (e->period == Duration{}) {
    e->due = kNever;
    return;
  }
  if (e->silence != Duration{}) {
    e->due = now + std::min(e->period, e->limit);
    return;
  }
  // On time: keep the beat. Read early by somebody else, or late (an overloaded bus stretches instead of piling up):
  // one period from now.
  const bool on_time = now >= e->due && now - e->due < e->period;
  e->due = (on_time ? e->due : now) + e->period;
}

void PollPlan::drop(model::ObjectId object) {
  Entry* e = entry(object);
  if (e == nullptr) return;
  e->due = kNever;
  e->dropped = true;
}

void PollPlan::rest(model::ObjectId object, Instant until) {
  if (Entry* e = entry(object)) e->due = e->rests = until;
}

void PollPlan::wake(Instant now) {
  for (Entry& e : entries_) {
    if (e.rests <= now || e.dropped) continue;
    e.due = std::min(e.due, now);
    e.rests = kLongAgo;
  }
}

void PollPlan::written(model::ObjectId object, Instant now) {
  Entry* e = entry(object);
  if (e != nullptr && e->period == Duration{}) e->due = std::min(e->due, now);
}

void PollPlan::refresh(Instant now) {
  for (Entry& e : entries_) {
    if (e.period != Duration{} || e.dropped) continue;
    now += kRefreshPause;
    e.due = std::min(e.due, now);
  }
}

}  // namespace axisgate::drive
