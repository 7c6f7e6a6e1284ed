// SPDX-License-Identifier: Apache-2.0
// What a drive reads in one request, and what becomes of the numbers that come back.
#include <algorithm>

#include "gateway/drive/device/drive.hpp"
#include "gateway/drive/device/requests.hpp"
#include "gateway/model/scale.hpp"

namespace axisgate::drive {

bus::Exchange Drive::write(ObjectId object, std::int64_t number) const {
  bus::Exchange exchange = read_of(model_, object);
  exchange.access = bus::Access::write;
  exchange.size = width_[object];
  exchange.raw = static_cast<std::uint32_t>(static_cast<std::uint64_t>(number));
  return exchange;
}

bool Drive::tells_state(ObjectId object) const {
  return std::any_of(axes_.begin(), axes_.end(), [&](const auto& axis) { return axis->core().tells_state(object); });
}

// What comes along in the same request at little cost: in bring-up all that is not known yet, in a poll all that is due
// as well, and of the state never a part without the rest.
void Drive::widen(bus::Exchange& exchange) {
  if (on_wire_.resync || on_wire_.probe) return;
  const bool polled = on_wire_.job == 0;
  const bool setup = on_wire_.job == jobs_.setup && jobs_.setup != 0;
  blocks_.widen(exchange, [&](ObjectId id) {
    if (store_[id].refused) return false;
    return setup || tells_state(id) || (polled && plan_.due(id, now()));
  });
  on_wire_.widened = exchange.access == bus::Access::read && !exchange.more.empty() && !blocks_.one_answer(exchange);
}

bool Drive::split(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  if (!on_wire_.widened || resync_.suspect()) return false;
  if (result.code != Errc::refused_by_drive) {
    blocks_.answered(exchange);
    return false;
  }
  return !result.for_now && blocks_.refused(exchange);
}

// Unsupported: not asked again until the next bring-up. The state is asked for ever: without it there is no axis.
void Drive::store_refusal(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  const ObjectId id = model_.find(exchange.object);
  if (id == kNoObject) return;
  if (on_wire_.widened && !result.for_now) return;  // which of them it was is not known yet
  plan_.done(id, now());
  for (const bus::Neighbour& neighbour : exchange.more) plan_.done(model_.find(neighbour.object), now());
  if (result.for_now || plain_read(model_).object == exchange.object || model_.needs_for_state(id)) return;
  const auto refuse = [this](ObjectId object) {
    if (object == kNoObject) return;
    store_.refused(object);
    plan_.drop(object);
  };
  refuse(id);
  if (!blocks_.one_answer(exchange)) return;
  for (const bus::Neighbour& neighbour : exchange.more) refuse(model_.find(neighbour.object));
}

namespace {

/// The width that this object was asked for in; 0: in whatever it has.
std::uint8_t asked_width(const bus::Exchange& exchange, const bus::ObjectAddress& object) {
  for (const bus::Neighbour& neighbour : exchange.more)
    if (neighbour.object == object) return neighbour.size;
  return exchange.size;
}

}  // namespace

void Drive::store_fields(const bus::Exchange& exchange, const bus::ExchangeResult& result) {
  if (exchange.access != bus::Access::read) return;
  if (result.code == Errc::refused_by_drive) return store_refusal(exchange, result);
  for (const bus::ReplyField& field : result.fields) {
    const ObjectId id = model_.find(field.object);
    if (id == kNoObject) continue;
    const ObjectDef& object = model_.object(id);
    // A width other than the profile's is a wrong profile, not a value (JD sheet, K7): it is not shown. A
    // resynchronisation read reads registers as they come.
    if (field.size == object.size) {
      width_[id] = field.size;
      store_.read(id, object.number(field.raw), on_wire_.sent_at);
    } else if (object.any_width && field.size < object.size) {
      width_[id] = field.size;
      ObjectDef narrow;
      narrow.size = field.size;
      narrow.is_signed = object.is_signed;
      store_.read(id, narrow.number(field.raw), on_wire_.sent_at);
    } else if (on_wire_.resync || asked_width(exchange, field.object) != object.size) {
      continue;  // the mailbox asks in its client's width: what comes proves nothing of the profile
    } else if (!store_[id].refused) {
      store_.refused(id);
      if (!model_.needs_for_state(id)) plan_.drop(id);
      event(axes_.front()->core().model.number, EventKind::warning, 0,
            object.name + ": the drive answers " + std::to_string(field.size) + " bytes, the profile says " +
                std::to_string(object.size) + ": not used");
      continue;
    }
    plan_.done(id, now());
    for (const ObjectId alias : object.aliases) plan_.done(alias, now());
  }
  read_constants();
  for (auto& axis : axes_) axis->on_samples();
}

void Drive::read_constants() {
  bool changed = false;
  for (std::size_t i = 0; i < constants_.size(); ++i) {
    const auto value = value_of(model_.constants[i], [&](ObjectId id) {
      return store_[id].known ? std::optional(store_[id].number) : std::nullopt;
    });
    if (!value || constants_[i] == value) continue;
    constants_[i] = value;
    changed = true;
  }
  if (!changed) return;
  for (AxisModel& axis : model_.axes)
    for (Binding& binding : axis.bindings)
      if (binding.recipe.waits()) apply_recipe(binding, constants_, model_.object(binding.object));
  for (auto& axis : axes_) axis->on_scale();
}

}  // namespace axisgate::drive
