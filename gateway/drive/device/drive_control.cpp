// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/drive_control.hpp"

#include <algorithm>

#include "gateway/drive/device/requests.hpp"
#include "gateway/drive/plan/write_exchange.hpp"

namespace axisgate::drive {

// --- Control frames ------------------------------------------------------------------------------------------------

bool DriveControl::shown_lately(model::ObjectId object, Instant now) const {
  return store_[object].cached && now - store_[object].sent_at <= kShownFor;
}

std::vector<MotorShows> DriveControl::motors_show(const Turn& turn) const {
  std::vector<MotorShows> out;
  const bool trusted = turn.online && !turn.suspect;
  for (const AxisTurn& axis : turn.axes) {
    const ShownState now = axis.core.state();
    const auto& state = axis.core.model.virtual_axis;
    const bool held =
        state && shown_lately(state->enabled.object, turn.now) && shown_lately(state->fault.object, turn.now);
    MotorShows shows{.enabled = trusted && held && now.enabled(),
                     .enabling = axis.enabling && !now.faulted(),
                     .disabling = axis.disabling,
                     .moving = axis.core.moving(),
                     .mode = axis.core.mode_in_force()};
    const model::Binding* position = axis.core.model.binding(Quantity::position_actual);
    if (position != nullptr && position->object != model::kNoObject && store_[position->object].known)
      shows.position = store_[position->object].number;
    out.push_back(shows);
  }
  return out;
}

// A frame tells the other motor as well: where something has invalidated its state, or it is old, it is looked at
// before. A stop is worth that look only where nothing but time has passed (this process was held up): without it the
// frame would have to turn the other motor off.
std::optional<model::ObjectId> DriveControl::look_before(const Turn& turn, bool stop) const {
  if (model_.composed.empty() || (stop && (turn.suspect || !turn.online))) return std::nullopt;
  for (const model::AxisModel& axis : model_.axes) {
    if (!axis.virtual_axis) continue;
    for (const model::ObjectId id : {axis.virtual_axis->enabled.object, axis.virtual_axis->fault.object})
      if (!shown_lately(id, turn.now) && !store_[id].refused && (!stop || store_[id].cached)) return id;
  }
  return std::nullopt;
}

std::optional<bus::Exchange> DriveControl::whole(const Turn& turn, const bus::Exchange& exchange, bool stop) const {
  if (!frame_.carries(exchange)) return exchange;
  return frame_.complete(exchange, store_, motors_show(turn), stop);
}

// A repetition changes nothing, whether it arrived or not.
void DriveControl::on_written(model::ObjectId id, std::uint32_t raw, Errc code, Instant sent_at) {
  if (id == model::kNoObject) return;
  const std::int64_t number = model_.object(id).number(raw);
  const ObjectState& told = store_[id];
  if (code == Errc::ok)
    store_.acknowledged(id, number, sent_at);
  else if (!told.known || told.unsure || told.number != number)
    store_.asked(id, number, sent_at);
}

// What all fields of a frame were told counts for each of them.
void DriveControl::on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result,
                             std::optional<AxisSlot> repeated, Instant sent_at, bool trusted, Instant now) {
  if (repeated && exchange.access == bus::Access::read && !looked_just_now(now)) keep_alive_.failed(*repeated, now);
  const model::ObjectId written = written_by(model_, exchange);
  if (written == model::kNoObject) return;
  if (repeated && result.code != Errc::ok) keep_alive_.failed(*repeated, now);
  if (result.code == Errc::refused_by_drive) return;
  const bool frame = frame_.carries(exchange);
  if (frame)
    for (const bus::Neighbour& neighbour : exchange.more)
      on_written(model_.find(neighbour.object), neighbour.raw, result.code, sent_at);
  if (frame || (repeated && result.code == Errc::ok)) on_written(written, exchange.raw, result.code, sent_at);
  if (result.code == Errc::ok && (trusted || frame)) keep_alive_.written(written, sent_at);
}

// --- Keep-alive ----------------------------------------------------------------------------------------------------

bool DriveControl::may_repeat(const Turn& turn) const {
  return keep_alive_.wanted() && turn.online && !turn.adopted && !turn.suspect;
}

// The newest exchange of this drive was a look at the state of all its axes: what it showed is what the frame that
// follows goes by. A motor that trips between the two is turned on again by that frame; no protocol of this drive can
// tell sooner.
bool DriveControl::looked_just_now(Instant now) const {
  return std::ranges::all_of(model_.axes, [&](const model::AxisModel& axis) {
    if (!axis.virtual_axis) return true;
    const ObjectState& state = store_[axis.virtual_axis->enabled.object];
    return shown_lately(axis.virtual_axis->enabled.object, now) && state.exchange == store_.exchange();
  });
}

std::optional<DriveControl::Due> DriveControl::due(const Turn& turn) const {
  if (!may_repeat(turn)) return std::nullopt;
  for (std::size_t slot = 0; slot < turn.axes.size(); ++slot) {
    const auto axis = static_cast<AxisSlot>(slot);
    if (keep_alive_.due(axis) > turn.now) continue;
    const auto repeat = keep_alive_.repeat(turn.axes[slot].core, turn.axes[slot].stopping, turn.axes[slot].live);
    if (!repeat) continue;
    const bus::Exchange write = write_of(model_, repeat->object, repeat->number);
    if (frame_.carries(write) && !looked_just_now(turn.now))
      return Due{axis, read_of(model_, model_.axes[slot].virtual_axis->enabled.object)};
    return Due{axis, write};
  }
  return std::nullopt;
}

Instant DriveControl::next_due(const Turn& turn) const {
  Instant next = kNever;
  if (may_repeat(turn))
    for (std::size_t slot = 0; slot < turn.axes.size(); ++slot)
      if (const AxisTurn& axis = turn.axes[slot]; keep_alive_.repeat(axis.core, axis.stopping, axis.live))
        next = std::min(next, keep_alive_.due(static_cast<AxisSlot>(slot)));
  return next;
}

}  // namespace axisgate::drive
