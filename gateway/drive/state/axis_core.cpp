// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/state/axis_core.hpp"

#include <algorithm>
#include <cstdlib>

namespace axisgate::drive {
namespace {

constexpr std::int64_t kNoMode = 0;  // which mode is in force nobody knows

bool holds(const AxisCore& core, const model::Condition& condition) {
  const ObjectState& s = core.store[condition.object];
  return s.known && condition.holds(core.object(condition.object), static_cast<std::uint32_t>(s.number));
}

bool holds(const AxisCore& core, const std::optional<model::Condition>& condition) {
  return condition && holds(core, *condition);
}

// A composed quantity: bit fields of one or more objects side by side.
std::optional<std::int64_t> composed(const AxisCore& core, const model::Binding& binding) {
  std::uint32_t out = 0;
  for (const model::BitField& field : binding.bits) {
    const ObjectState& s = core.store[field.object];
    if (s.refused) continue;  // what this drive does not have reads 0
    if (!s.known) return std::nullopt;
    const std::uint32_t mask = field.count >= 32 ? ~0U : (1U << field.count) - 1U;
    std::uint32_t bits = (static_cast<std::uint32_t>(s.number) >> field.from) & mask;
    if (field.inverted) bits ^= mask;
    out |= bits << field.to;
  }
  return static_cast<std::int64_t>(out);
}

}  // namespace

std::optional<std::int64_t> AxisCore::value(Quantity quantity) const {
  const model::Binding* binding = model.binding(quantity);
  if (binding == nullptr) return std::nullopt;
  if (!binding->bits.empty()) return composed(*this, *binding);
  if (binding->object == model::kNoObject || !store[binding->object].known) return std::nullopt;
  return binding->to_register(store[binding->object].number);
}

model::ObjectId AxisCore::object_of(Quantity quantity) const {
  const model::Binding* binding = model.binding(quantity);
  const bool there = binding != nullptr && binding->object != model::kNoObject && !store[binding->object].refused;
  return there ? binding->object : model::kNoObject;
}

model::ObjectId AxisCore::motion_object() const {
  if (!model.moving) return object_of(Quantity::velocity_actual);
  return store[model.moving->object].refused ? model::kNoObject : model.moving->object;
}

int AxisCore::mode_in_force() const {
  const model::ObjectId id = model.mode_display != model::kNoObject ? model.mode_display : model.mode;
  if (id == model::kNoObject || !store[id].known) return 0;
  for (const auto& [unified, raw] : model.modes)
    if (raw == store[id].number) return unified;
  return static_cast<int>(store[id].number);
}

std::uint16_t AxisCore::controlword() const {
  if (model.controlword == model::kNoObject) return 0;
  const ObjectState& s = store[model.controlword];
  return s.known ? static_cast<std::uint16_t>(s.number) : 0;
}

ShownState AxisCore::state() const {
  ShownState out{.reachable = reachable()};
  const ObjectState& status = store[model.statusword];
  if (status.known) out.state = model::state_of(static_cast<std::uint16_t>(status.number));
  return out;
}

bool AxisCore::moving() const {
  if (model.moving) return holds(*this, model.moving);
  const auto velocity = value(Quantity::velocity_actual);
  return velocity && std::llabs(*velocity) > model.standstill_velocity;
}

AxisFacts AxisCore::facts() const {
  AxisFacts facts{state()};
  facts.at = turn.now;
  const ObjectState& status = store[model.statusword];
  const auto word = static_cast<std::uint16_t>(status.known ? status.number : 0);
  facts.statusword_exchange = status.exchange;
  if (const model::ObjectId id = object_of(Quantity::position_actual); id != model::kNoObject)
    facts.position_exchange = store[id].exchange;
  facts.target_reached = (word & model::statusword::kTargetReached) != 0;
  const model::ObjectId word_object = model.controlword;
  facts.commanded = word_object == model::kNoObject || !store[word_object].known || model::enables(controlword());
  facts.mode = mode_in_force();
  facts.own_velocity_mode = model.is_own_velocity_mode(facts.mode);
  facts.acknowledges = model.cia402.setpoint_acknowledge;
  facts.reference_tells = !model.homed_mode || facts.mode == *model.homed_mode;
  facts.reference = is_virtual() ? machine.homing_attained() : facts.reference_tells && holds(*this, model.homed);
  facts.homing_failed =
      is_virtual() ? machine.homing_failed() : facts.reference_tells && holds(*this, model.homing_failed);
  facts.motion_failed = machine.motion_failed();
  facts.moving = moving();
  // Found turning in a mode that nobody can tell, it may follow a velocity: it is stopped and led as if it did.
  const bool tells_no_mode = is_virtual() && model.virtual_axis->gate_only;
  facts.own_velocity_mode = facts.own_velocity_mode || (tells_no_mode && facts.moving && motion.found_at_start());
  if (const model::ObjectId id = motion_object(); id != model::kNoObject && !store[id].emulated)
    facts.moving_at = store[id].sent_at;
  facts.follows = follows(facts);
  return facts;
}

bool AxisCore::is_continuous(int mode) const { return model::is_continuous(mode) || model.is_own_velocity_mode(mode); }

// A CiA 402 drive tells its set-point, and turns by it alone; of another the motor itself has to tell.
bool AxisCore::follows(const AxisFacts& facts) const {
  const std::optional<Quantity> followed = followed_target(facts);
  if (!followed || (controlword() & model::controlword::kHalt) != 0) return false;
  const model::Binding* target = model.binding(*followed);
  const bool tells =
      !is_virtual() && target != nullptr && target->object != model::kNoObject && store[target->object].known;
  return tells ? store[target->object].number != 0 : facts.moving;
}

// --- Virtual axes --------------------------------------------------------------------------------------------------

std::optional<VirtualAxis::Seen> AxisCore::seen() const {
  VirtualAxis::Seen out;
  out.at = turn.now;
  out.exchange = UINT64_MAX;
  for (const model::ObjectId id : model.state_sources) {
    if (store[id].refused) continue;
    if (!store[id].known) return std::nullopt;
    out.exchange = std::min(out.exchange, store[id].exchange);
  }
  const model::VirtualProperties& by = *model.virtual_axis;
  out.enabled = holds(*this, by.enabled);
  out.fault = holds(*this, by.fault);
  out.limit = holds(*this, by.limit);
  out.moving = moving();
  out.standing = by.reached ? holds(*this, by.reached) : !out.moving;
  out.homed_at = !by.homed_at || holds(*this, by.homed_at);
  if (const model::Binding* position = model.binding(Quantity::position_actual);
      position != nullptr && position->object != model::kNoObject && store[position->object].known) {
    out.position = store[position->object].number;
    out.position_exchange = store[position->object].exchange;
  }
  out.controlword = controlword();
  out.mode = mode_in_force();
  out.running = motion.running();
  const auto target = value(Quantity::target_velocity);
  out.speed_asked = target.value_or(0) != 0;
  out.invalidations = store.invalidations();
  constexpr std::int64_t kTolerance = 50;  // a fiftieth of the target: "reached" is a window in CiA 402 as well (606Dh)
  const bool runs = target && out.running == MotionKind::velocity;
  if (const auto velocity = runs ? value(Quantity::velocity_actual) : std::nullopt)
    out.at_velocity = std::llabs(*velocity - *target) <= std::llabs(*target) / kTolerance + model.standstill_velocity;
  return out;
}

void AxisCore::refresh_virtual() {
  if (!is_virtual()) return;
  const auto newest = seen();
  if (!newest) return;
  machine.observe(*newest, *model.virtual_axis);
  // What shows enabled takes starts: a CiA 402 drive that is found so holds this word as well.
  constexpr std::uint16_t kEnabled = 0x000F;
  if (machine.take_found_enabled()) store.make(model.controlword, kEnabled);
  Instant oldest = kNever;
  bool cached = true;
  for (const model::ObjectId id : model.state_sources) {
    if (store[id].refused) continue;
    oldest = std::min(oldest, store[id].sent_at);
    cached = cached && store[id].cached;
  }
  store.make(model.statusword, machine.statusword(*newest), cached, oldest, newest->exchange);
  // Without torque no mode is in force, and the next enable says in which it is to be.
  const auto state = model::state_of(static_cast<std::uint16_t>(store[model.statusword].number));
  if (store[model.mode].known && store[model.mode].number == kNoMode && state != model::State402::operation_enabled)
    begin_mode();
}

void AxisCore::begin_mode() {
  if (is_virtual()) store.make(model.mode, model.modes.empty() ? kNoMode : model.modes.front().first);
}

void AxisCore::make(model::ObjectId id, std::int64_t number) {
  // What enables one enables all: each gate is its own axis's.
  for (AxisCore* other : shared())
    if (id == other->model.controlword && id != model.controlword) return other->make(id, number);
  store.make(id, number);
  if (id == model.controlword) machine.control(static_cast<std::uint16_t>(number), *model.virtual_axis);
  refresh_virtual();
}

void AxisCore::started(MotionKind kind, bool relative, std::optional<std::int64_t> ends_at) {
  sent_to.reset();
  // A button starts nothing that a client has asked for.
  const bool runs = kind == MotionKind::velocity || kind == MotionKind::torque;
  if (runs && !jog.speed()) motion.record().run();
  if (ends_at) sent_to = {*ends_at, store.invalidations()};
  if (!is_virtual()) return;
  std::optional<std::int64_t> goal;
  const model::Binding* target = model.binding(Quantity::target_position);
  const model::Binding* actual = model.binding(Quantity::position_actual);
  if (kind == MotionKind::discrete && target != nullptr && store[target->object].known) {
    goal = store[target->object].number;
    if (relative) goal = *goal + store[actual->object].number;  // read at standstill, just before the start
  }
  machine.started(kind, goal, turn.now, store.exchange());
  refresh_virtual();
}

model::ObjectId AxisCore::to_read(model::ObjectId id) const {
  const auto older = [&](model::ObjectId a, model::ObjectId b) {
    if (store[a].refused != store[b].refused) return store[b].refused;
    return store[a].exchange < store[b].exchange;
  };
  if (id != model::kNoObject && object(id).is_directed())
    return drive.whole(std::min(object(id).part.whole, object(id).part.sign, older));
  if (id != model.statusword || !object(id).emulated) return drive.whole(id);
  return drive.whole(*std::ranges::min_element(model.state_sources, older));
}

bool AxisCore::cannot_deenergise() const {
  if (!is_virtual() || !model.virtual_axis->gate_only) return false;
  const auto newest = seen();
  return newest && machine.cannot_deenergise(*newest, *model.virtual_axis);
}

bool AxisCore::shows_torque() const {
  const ShownState now = state();
  return now.enabled() || (now.reachable && now.state == model::State402::quick_stop_active) || cannot_deenergise();
}

bool AxisCore::held_back(Quantity quantity) const {
  const model::Binding* binding = model.binding(quantity);
  if (binding == nullptr || binding->object == model::kNoObject) return false;
  const bool followed = state().enabled() && (this->controlword() & model.cia402.follow_bits) != 0;
  return object(binding->object).trigger || followed;
}

std::optional<Wanted> AxisCore::target_position() const {
  if (const auto wanted = asked.taken(Quantity::target_position)) return wanted;
  if (const auto cached = value(Quantity::target_position)) return Wanted{*cached};
  return std::nullopt;
}

std::optional<std::int64_t> AxisCore::setpoint_position() const {
  const model::Binding* target = model.binding(Quantity::target_position);
  if (sent_to && motion.arrived() && sent_to->invalidations == store.invalidations() && target != nullptr &&
      target->object != model::kNoObject && store[target->object].known &&
      target->to_raw(sent_to->position, object(target->object)) == store[target->object].number)
    return sent_to->position;
  const model::ObjectId actual = object_of(Quantity::position_actual);
  const bool sampled =
      actual != model::kNoObject && store[actual].known && store[actual].sent_at >= motion.rests_since();
  return sampled ? value(Quantity::position_actual) : std::nullopt;
}

std::optional<Wanted> AxisCore::running_target(Quantity quantity) const {
  const auto speed = quantity == Quantity::target_velocity ? jog.speed() : std::nullopt;
  if (speed && motion.record().void_since(speed->at)) return std::nullopt;
  return speed ? speed : asked.taken(quantity);
}

std::optional<std::int64_t> AxisCore::homing_method() const {
  if (const auto wanted = asked.taken(Quantity::homing_method)) return wanted->value;
  return model.homing_method;
}

// --- Faults --------------------------------------------------------------------------------------------------------

bool tells_state(const model::AxisModel& model, model::ObjectId id) {
  return std::ranges::find(model.state_sources, id) != model.state_sources.end();
}

bool AxisCore::names_cause(model::ObjectId id) const {
  return store[id].known && fault.counts(tells_state(model, id), store[id].exchange);
}

void AxisCore::watch_fault() {
  const ObjectState& status = store[model.statusword];
  FaultWatch::Seen seen{.at = turn.now,
                        .known = status.known,
                        .faulted = status.known && state().faulted(),
                        .statusword_exchange = status.exchange,
                        .words = {}};
  for (const model::ObjectId id : causes) {
    const ObjectState& word = store[id];
    seen.words.push_back({id, word.refused, tells_state(model, id), word.exchange});
  }
  fault.observe(seen);
  fault.name(named_code(*this));
}

const model::AlarmRow* active_alarm(const AxisCore& core) {
  std::array<std::optional<std::uint64_t>, std::tuple_size_v<decltype(core.model.fault_words)>> words;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const model::ObjectId id = core.model.fault_words[i];
    if (id != model::kNoObject && core.names_cause(id)) words[i] = static_cast<std::uint64_t>(core.store[id].number);
  }
  for (const model::AlarmRow& row : core.drive.alarms) {
    const auto& word = words[row.word];
    if (word && (row.value ? *word == *row.value : ((*word >> row.bit) & 1U) != 0)) return &row;
  }
  return nullptr;
}

std::uint16_t named_code(const AxisCore& core) {
  if (const model::AlarmRow* row = active_alarm(core)) return row->code;
  const model::Binding* listed = core.model.binding(Quantity::error_code);
  if (listed == nullptr || listed->object == model::kNoObject || !core.names_cause(listed->object)) return 0;
  return static_cast<std::uint16_t>(core.store[listed->object].number);
}

}  // namespace axisgate::drive
