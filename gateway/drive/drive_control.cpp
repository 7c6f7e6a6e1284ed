// What a drive is told again so that it goes on, and frames that tell all of its motors at once what to do.
#include <algorithm>

#include "gateway/drive/action.hpp"
#include "gateway/drive/drive.hpp"

namespace axisgate::drive {
namespace {

// The queue was full: its own exchanges carry what is due meanwhile, and a place is asked for again.
constexpr Duration kPlaceRetry = std::chrono::milliseconds(5);
// What a motor showed longer ago says nothing of what it does now: this process may have been held up meanwhile, and
// the drive's watchdog (1000 ms after the last command) may have turned it off.
constexpr Duration kShownFor = std::chrono::milliseconds(500);

}  // namespace

// --- Control frames ------------------------------------------------------------------------------------------------

bool Drive::shown_lately(ObjectId object) const {
  return store_[object].held && now() - store_[object].sent_at <= kShownFor;
}

std::vector<MotorShows> Drive::motors_show() const {
  std::vector<MotorShows> out;
  const bool trusted = state_ == LinkState::online && !fence_.suspect();
  for (const auto& axis : axes_) {
    const AxisCore& core = axis->core();
    const AxisFacts facts = core.facts();
    const auto& state = core.model.virtual_axis;
    const bool held = state && shown_lately(state->enabled.object) && shown_lately(state->fault.object);
    MotorShows shows{.enabled = trusted && held && facts.enabled(),
                     .enabling = axis->enabling() && !facts.faulted(),
                     .disabling = axis->disable_waits(),
                     .moving = facts.moving,
                     .mode = facts.mode};
    const Binding* position = core.model.binding(Quantity::position_actual);
    if (position != nullptr && position->object != kNoObject && store_[position->object].known)
      shows.position = store_[position->object].number;
    out.push_back(shows);
  }
  return out;
}

// A frame tells the other motor as well: where something has made its state doubtful, or it is old, it is looked at
// before. A stop is worth that look only where nothing but time has passed (this process was held up): without it the
// frame would have to turn the other motor off.
std::optional<bus::Exchange> Drive::look_before_frame(bool stop) const {
  if (model_.composed.empty() || (stop && (fence_.suspect() || state_ != LinkState::online))) return std::nullopt;
  for (const AxisModel& axis : model_.axes) {
    if (!axis.virtual_axis) continue;
    for (const ObjectId id : {axis.virtual_axis->enabled.object, axis.virtual_axis->fault.object})
      if (!shown_lately(id) && !store_[id].refused && (!stop || store_[id].held)) return read(id);
  }
  return std::nullopt;
}

std::optional<bus::Exchange> Drive::whole_frame(const bus::Exchange& exchange, bus::OrderId id,
                                                bus::Priority priority) {
  if (!frame_.carries(exchange)) return exchange;
  const bool stop = priority == bus::Priority::stop;
  auto whole = frame_.complete(exchange, store_, motors_show(), stop);
  if (whole) return whole;
  if (on_wire_.keeps_alive) {
    keep_alive_.failed(*on_wire_.keeps_alive, now());
    return std::nullopt;
  }
  for (auto& axis : axes_)
    if (axis->has(id)) axis->on_order_ended(id, Errc::state_unsuitable);
  return std::nullopt;
}

// What all fields of a frame were told counts for each of them; a repetition changes nothing, whether it arrived or
// not.
void Drive::on_control_result(const bus::Exchange& exchange, const bus::ExchangeResult& result, const OnWire& asked,
                              ObjectId written, bool trusted) {
  if (asked.keeps_alive && exchange.access == bus::Access::read && !looked_just_now())
    keep_alive_.failed(*asked.keeps_alive, now());
  if (written == kNoObject) return;
  if (asked.keeps_alive && result.code != Errc::ok) keep_alive_.failed(*asked.keeps_alive, now());
  if (result.code == Errc::refused_by_drive) return;
  const bool frame = frame_.carries(exchange);
  const auto field = [&](const bus::ObjectAddress& address, std::uint32_t raw) {
    const ObjectId id = model_.find(address);
    if (id == kNoObject) return;
    const std::int64_t number = model_.object(id).number(raw);
    const ObjectState& told = store_[id];
    if (result.code == Errc::ok)
      store_.acknowledged(id, number, asked.sent_at);
    else if (!told.known || told.unsure || told.number != number)
      store_.asked(id, number, asked.sent_at);
  };
  if (frame)
    for (const bus::Neighbour& neighbour : exchange.more) field(neighbour.object, neighbour.raw);
  if (frame || (asked.keeps_alive && result.code == Errc::ok)) field(exchange.object, exchange.raw);
  if (result.code == Errc::ok && (trusted || frame)) keep_alive_.written(written, asked.sent_at);
}

// --- Keep-alive ----------------------------------------------------------------------------------------------------

bool Drive::may_repeat() const {
  return keep_alive_.wanted() && state_ == LinkState::online && !adopted_ && !fence_.suspect();
}

std::optional<KeepAlive::Repeat> Drive::repeat_for(std::size_t slot) const {
  const Axis& axis = *axes_[slot];
  return keep_alive_.repeat(axis.core(), axis.stopping() || axis.owes_stop(), axis.commands_live());
}

// The newest exchange of this drive was a look at the state of all its axes: what it showed is what the frame that
// follows goes by. A motor that trips between the two is turned on again by that frame; no protocol of this drive can
// tell sooner.
bool Drive::looked_just_now() const {
  return std::all_of(model_.axes.begin(), model_.axes.end(), [this](const AxisModel& axis) {
    if (!axis.virtual_axis) return true;
    const ObjectState& state = store_[axis.virtual_axis->enabled.object];
    return shown_lately(axis.virtual_axis->enabled.object) && state.exchange == store_.exchange();
  });
}

// Whatever of this drive has its turn lets what is due go first, and keeps its own; but a stop, which makes it void.
std::optional<bus::Exchange> Drive::keep_alive_turn(bus::Priority priority) {
  if (priority == bus::Priority::stop || !may_repeat()) return std::nullopt;
  for (std::size_t slot = 0; slot < axes_.size(); ++slot) {
    const auto axis = static_cast<bus::AxisSlot>(slot);
    if (keep_alive_.due(axis) > now()) continue;
    const auto repeat = repeat_for(slot);
    if (!repeat) continue;
    on_wire_.order = 0;
    on_wire_.keeps_alive = axis;
    if (frame_.carries({model_.node, bus::Access::write, model_.object(repeat->object).address}) && !looked_just_now())
      return read(model_.axes[slot].virtual_axis->enabled.object);
    const ObjectDef& def = model_.object(repeat->object);
    return bus::Exchange{model_.node, bus::Access::write, def.address, def.size, wire_bits(repeat->number, def.size)};
  }
  return std::nullopt;
}

Instant Drive::schedule_keep_alive() {
  Instant next = kNever;
  if (may_repeat())
    for (std::size_t slot = 0; slot < axes_.size(); ++slot)
      if (repeat_for(slot)) next = std::min(next, keep_alive_.due(static_cast<bus::AxisSlot>(slot)));
  if (next > now()) {
    if (keep_alive_order_ != 0) bus_.finish(keep_alive_order_);
    keep_alive_order_ = 0;
    return next;
  }
  if (keep_alive_order_ != 0) return kNever;
  const Queued queued = queue_own(bus::Priority::command);
  if (queued.code != Errc::ok) return now() + kPlaceRetry;
  keep_alive_order_ = queued.id;
  return kNever;
}

}  // namespace axisgate::drive
