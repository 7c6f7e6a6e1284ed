// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive_reads.hpp"

#include <algorithm>
#include <utility>

#include "gateway/drive/device/answer_width.hpp"
#include "gateway/drive/device/requests.hpp"
#include "gateway/drive/device/unknown_constant.hpp"
#include "gateway/model/scale.hpp"

namespace axisgate::drive {

DriveReads::DriveReads(model::DriveModel& model, ObjectStore& store)
    : model_(model),
      store_(store),
      plan_(model),
      resync_(model.resync, model.objects),
      blocks_(model),
      tries_(model.objects.size()),
      constants_(model.constants.size()),
      unknown_(model.constants.size()),
      mapped_(model.objects.size(), false),
      tells_state_(model.objects.size(), false) {
  for (const model::ObjectDef& object : model.objects) width_.push_back(object.size);
  for (const model::AxisModel& axis : model.axes)
    for (const model::ObjectId id : axis.state_sources)
      if (id != model::kNoObject) tells_state_[model.whole(id)] = true;
  // What a drive sends by itself, whatever we tell it: mapped for good.
  for (const model::ObjectId id : model.unsolicited.objects) {
    mapped_[id] = true;
    if (model.unsolicited.every > Duration{} && !tells_state(id)) store_.set_period(id, model.unsolicited.every);
  }
}

// --- What is read next -----------------------------------------------------------------------------------------------

void DriveReads::restart(Instant now) {
  store_.forget_all();
  resync_.forget();
  tries_.restart();
  silent_.reset();
  answers_ = false;
  probes_ = 0;
  wide_reported_ = false;
  plan_.restart(now);
}

std::optional<bus::Exchange> DriveReads::poll(Instant now) const {
  const auto object = plan_.next(now);
  if (!object) return std::nullopt;
  return read_of(model_, *object);
}

void DriveReads::widen(bus::Exchange& exchange, Asked& asked, For whom, Instant now) const {
  if (asked.resync || asked.probe || asked.counted) return;
  blocks_.widen(exchange, [&](model::ObjectId id) {
    if (store_[id].refused) return false;
    return whom == For::bring_up || tells_state(id) || (whom == For::poll && plan_.due(id, now));
  });
  asked.widened = exchange.access == bus::Access::read && !exchange.more.empty() && !blocks_.one_answer(exchange);
}

void DriveReads::hurry_state(const model::AxisModel& axis, Instant now) {
  for (const model::ObjectId id : axis.state_sources) hurry(id, now);
}

void DriveReads::refresh(Instant now) {
  if (invalidations_seen_ == store_.invalidations()) return;
  invalidations_seen_ = store_.invalidations();
  plan_.refresh(now);
}

// --- Late replies ----------------------------------------------------------------------------------------------------

std::optional<bus::Exchange> DriveReads::resync(Asked& asked, Instant now) {
  const auto candidate = resync_.candidate();
  if (candidate && !resync_.exhausted()) {
    resync_.resync_sent(*candidate);
    asked.resync = true;
    return read_of(model_, *candidate);
  }
  if (now < resync_.silent_until()) return std::nullopt;
  if (resync_.counts_out()) return after_silence(asked, &Asked::resync);
  resync_.waited_out();
  asked.resync = true;
  return probe_read(model_);
}

bus::Exchange DriveReads::after_silence(Asked& asked, bool Asked::*trusted) {
  const auto candidate = resync_.candidate();
  (candidate ? asked.*trusted : asked.counted) = true;
  return read_of(model_, candidate ? *candidate : resync_.counted());
}

bool DriveReads::may_probe(Instant now) {
  if (!resync_.suspect()) return true;
  if (now < resync_.silent_until()) return false;
  if (!resync_.counts_out()) resync_.waited_out();
  return true;
}

bus::Exchange DriveReads::probe(Asked& asked) {
  if (resync_.suspect()) return after_silence(asked, &Asked::probe);
  asked.probe = true;
  // A drive whose state is unresponsive is there all the same.
  return probes_++ % 2 == 0 ? probe_read(model_) : other_probe_read(model_);
}

// --- What comes back -------------------------------------------------------------------------------------------------

void DriveReads::timed_out(const bus::Exchange& exchange, const Asked& asked, Instant now) {
  resync_.lost(exchange, now);
  const bool plain = exchange.access == bus::Access::read && !asked.resync && !asked.probe && !asked.counted;
  if (plain && !silent_) silent_ = {exchange, asked};
  store_.lose_contact();
}

// An error answer is no answered resynchronisation read; the next candidate is tried.
bool DriveReads::answered(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked,
                          Instant now) {
  const bool proves = result.code == Errc::ok && (asked.resync || asked.probe);
  if (proves) {
    resync_.answered();
    if (asked.resync) was_silent(now);
    silent_.reset();
  }
  if (result.code == Errc::ok && asked.counted) resync_.counted_one();
  const bool of_resync = asked.resync || asked.counted || (asked.probe && resync_.suspect());
  if (result.code == Errc::refused_by_drive && of_resync) resync_.refused(exchange, now);
  return proves;
}

bool DriveReads::split(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked) {
  if (!asked.widened || resync_.suspect()) return false;
  if (result.code != Errc::refused_by_drive) {
    blocks_.answered(exchange);
    return false;
  }
  return result.for_now || !answers_ ? blocks_.silent(exchange) : blocks_.refused(exchange);
}

bool DriveReads::needed(model::ObjectId object) const {
  return model_.needs_for_state(object) || object == model_.find(plain_read(model_).object);
}

// After the second time a block falls in two: which of its objects it is shows in the end.
void DriveReads::was_silent(Instant now) {
  if (!silent_) return;
  const bus::Exchange& exchange = silent_->exchange;
  if (silent_->asked.widened) {
    static_cast<void>(blocks_.silent(exchange));
    return;
  }
  const auto count = [&](const ObjectAddress& address) {
    const model::ObjectId id = model_.find(address);
    // It has come by itself meanwhile, by a TPDO: nobody needs the read.
    if (id != model::kNoObject && store_[id].sent_at <= silent_->asked.sent_at) in_vain(id, std::nullopt, now);
  };
  count(exchange.object);
  for (const bus::Neighbour& neighbour : exchange.more) count(neighbour.object);
}

bool DriveReads::expects_silence(const bus::Exchange& exchange) const {
  const model::ObjectId id = exchange.access == bus::Access::read ? model_.find(exchange.object) : model::kNoObject;
  return id != model::kNoObject && tries_.given_up(id);
}

void DriveReads::in_vain(model::ObjectId object, const ObjectTries::Refusal& refusal, Instant now) {
  const bool given_up = tries_.in_vain(object, refusal, needed(object), now);
  if (given_up && !needed(object)) store_.unresponsive(object);
  if (tries_.again(object) > now) plan_.rest(object, tries_.again(object));
}

// What the drive does not have is not asked again until the next bring-up; it must have answered something before it is
// believed, since a drive that still starts may refuse all. Any other refusal may pass.
void DriveReads::take_refusal(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked,
                              Instant now) {
  const model::ObjectId id = model_.find(exchange.object);
  if (id == model::kNoObject) return;
  if (asked.widened) return;  // which of them it was is not known yet
  const bool for_ever = !result.for_now && answers_;
  const auto refuse = [&](model::ObjectId object) {
    if (object == model::kNoObject) return;
    if (!for_ever || needed(object)) return in_vain(object, result.detail, now);
    store_.refused(object);
    plan_.drop(object);
  };
  refuse(id);
  if (!blocks_.one_answer(exchange)) return;
  for (const bus::Neighbour& neighbour : exchange.more) refuse(model_.find(neighbour.object));
}

namespace {

/// The width that this object was asked for in; 0: in whatever it has.
std::uint8_t asked_width(const bus::Exchange& exchange, const ObjectAddress& object) {
  for (const bus::Neighbour& neighbour : exchange.more)
    if (neighbour.object == object) return neighbour.size;
  return exchange.size;
}

std::string width_text(const model::ObjectDef& object, const bus::ReplyField& field) {
  return object.name + ": the drive answers " + std::to_string(field.size) + " bytes, the profile says " +
         std::to_string(object.size);
}

}  // namespace

DriveReads::Taken DriveReads::take(const bus::Exchange& exchange, const bus::ExchangeResult& result, const Asked& asked,
                                   Instant now) {
  Taken taken;
  if (exchange.access != bus::Access::read) return taken;
  if (result.code == Errc::refused_by_drive) {
    take_refusal(exchange, result, asked, now);
    return taken;
  }
  for (const bus::ReplyField& field : result.fields) take_field(exchange, field, asked, taken, now);
  answers_ = answers_ || !result.fields.empty();
  if (taken.back) plan_.wake(now);
  taken.scales = read_constants();
  taken.samples = true;
  return taken;
}

void DriveReads::take_field(const bus::Exchange& exchange, const bus::ReplyField& field, const Asked& asked,
                            Taken& taken, Instant now) {
  const model::ObjectId id = model_.find(field.object);
  if (id == model::kNoObject) return;
  const model::ObjectDef& object = model_.object(id);
  const std::uint8_t asked_for = asked_width(exchange, field.object);
  const bool proves = !asked.resync && (asked_for == object.size || (object.any_width && asked_for == 0));
  const auto wide = proves ? narrowed(model_, id, field) : std::nullopt;
  // A width other than the profile's is a wrong profile, not a value (JD sheet, K7): it is not shown, unless the drive
  // merely says more than it has. A resynchronisation read reads registers as they come.
  if (field.size == object.size) {
    width_[id] = field.size;
    store_.read(id, object.number(field.raw), asked.sent_at);
  } else if (object.any_width && field.size < object.size) {
    width_[id] = field.size;
    model::ObjectDef narrow;
    narrow.size = field.size;
    narrow.is_signed = object.is_signed;
    store_.read(id, narrow.number(field.raw), asked.sent_at);
  } else if (wide) {
    store_.read(id, *wide, asked.sent_at);
    if (!asked.probe && !std::exchange(wide_reported_, true))
      taken.unlike.push_back(width_text(object, field) +
                             ": the bytes above are empty: taken, and so is whatever else "
                             "this drive answers so");
  } else if (!proves) {
    return;  // the mailbox asks in its client's width: what comes proves nothing of the profile
  } else if (!store_[id].refused) {
    store_.unlike(id);
    if (!model_.needs_for_state(id)) plan_.drop(id);
    taken.unlike.push_back(width_text(object, field) + ": not used");
    return;
  }
  taken.back = tries_.answered(id) || taken.back;
  plan_.done(id, now);
  for (const model::ObjectId alias : object.aliases) plan_.done(alias, now);
}

bool DriveReads::read_constants() {
  bool changed = false;
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    const auto value = evaluated(model_.constants[i]).value;
    if (!value || constants_[i] == value) continue;
    constants_[i] = value;
    changed = true;
  }
  if (changed) rescale();
  return changed;
}

model::Evaluated DriveReads::evaluated(const model::DriveConstant& constant) const {
  return model::evaluate(
      constant, [&](model::ObjectId id) { return store_[id].known ? std::optional(store_[id].number) : std::nullopt; },
      [&](model::ObjectId id) { return store_.is_absent(id); });
}

DriveReads::Settled DriveReads::settle() {
  Settled out;
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    const model::Evaluated found = evaluated(model_.constants[i]);
    out.scales = out.scales || constants_[i] != found.value;
    constants_[i] = found.value;
    std::string why = unknown_text(model_, model_.constants[i], found, store_);
    if (why != unknown_[i] && !why.empty()) out.unknown.push_back(why);
    unknown_[i] = std::move(why);
  }
  if (out.scales) rescale();
  return out;
}

void DriveReads::rescale() {
  for (model::AxisModel& axis : model_.axes)
    for (model::Binding& binding : axis.bindings)
      if (binding.recipe.waits()) model::apply_recipe(binding, constants_, model_.object(binding.object));
}

// --- What comes unasked ----------------------------------------------------------------------------------------------

void DriveReads::map(model::ObjectId object, std::optional<Duration> event) {
  mapped_[object] = true;
  plan_.map(object, event, model_.canopen.confirm);
  store_.set_period(object, event.value_or(model_.canopen.confirm));
}

void DriveReads::unmap(Instant now) {
  for (std::size_t i = 0; i < mapped_.size(); ++i) {
    if (!mapped_[i]) continue;
    mapped_[i] = false;
    store_.set_period(static_cast<model::ObjectId>(i), Duration{});
  }
  plan_.unmap_all(now);
}

void DriveReads::outdate_mapped() {
  for (std::size_t i = 0; i < mapped_.size(); ++i)
    if (mapped_[i]) store_.outdate(static_cast<model::ObjectId>(i));
}

void DriveReads::take_unsolicited(const bus::ReplyFields& fields, Instant now) {
  for (const bus::ReplyField& field : fields) {
    const model::ObjectId id = model_.find(field.object);
    if (id == model::kNoObject || !mapped_[id] || field.size != model_.object(id).size) continue;
    store_.received(id, model_.object(id).number(field.raw), now);
    plan_.received(id, now);
  }
}

void DriveReads::watch_position(const model::AxisModel& axis, bool moves, Instant now) {
  const model::Binding* position = axis.binding(Quantity::position_actual);
  const model::ObjectId id = position == nullptr ? model::kNoObject : model_.whole(position->object);
  if (id == model::kNoObject || !mapped_[id]) return;
  plan_.confirm_within(id, moves ? std::optional(kMovingConfirm) : std::nullopt, now);
}

}  // namespace axisgate::drive
