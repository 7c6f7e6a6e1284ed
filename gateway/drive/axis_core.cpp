#include "gateway/drive/axis_core.hpp"

#include <cstdlib>

namespace axisgate::drive {
namespace {

bool holds(const AxisCore& core, const std::optional<Condition>& condition) {
  if (!condition) return false;
  const ObjectState& s = core.store[condition->object];
  return s.known && condition->holds(core.object(condition->object), static_cast<std::uint32_t>(s.number));
}

// A composed quantity: bit fields of one or more objects side by side.
std::optional<std::int64_t> composed(const AxisCore& core, const Binding& binding) {
  std::uint32_t out = 0;
  for (const BitField& field : binding.bits) {
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
  const Binding* binding = model.binding(quantity);
  if (binding == nullptr) return std::nullopt;
  if (!binding->bits.empty()) return composed(*this, *binding);
  if (binding->object == kNoObject || !store[binding->object].known) return std::nullopt;
  return binding->to_register(store[binding->object].number);
}

int AxisCore::mode_in_force() const {
  const ObjectId id = model.mode_display != kNoObject ? model.mode_display : model.mode;
  if (id == kNoObject || !store[id].known) return 0;
  for (const auto& [unified, raw] : model.modes)
    if (raw == store[id].number) return unified;
  return static_cast<int>(store[id].number);
}

std::uint16_t AxisCore::controlword() const {
  if (model.controlword == kNoObject) return 0;
  const ObjectState& s = store[model.controlword];
  return s.known ? static_cast<std::uint16_t>(s.number) : 0;
}

AxisFacts AxisCore::facts() const {
  AxisFacts facts;
  facts.at = now;
  facts.reachable = reachable();
  const ObjectState& status = store[model.statusword];
  const auto word = static_cast<std::uint16_t>(status.known ? status.number : 0);
  facts.state = status.known ? state_of(word) : State402::not_ready_to_switch_on;
  facts.statusword_exchange = status.exchange;
  facts.target_reached = (word & statusword::kTargetReached) != 0;
  facts.mode = mode_in_force();
  facts.reference = holds(*this, model.homed);
  facts.homing_failed = holds(*this, model.homing_failed);
  if (model.moving) {
    facts.moving = holds(*this, model.moving);
  } else if (const auto velocity = value(Quantity::velocity_actual)) {
    facts.moving = std::llabs(*velocity) > model.standstill_velocity;
  }
  return facts;
}

bool AxisCore::held_back(Quantity quantity) const {
  const Binding* binding = model.binding(quantity);
  if (binding == nullptr || binding->object == kNoObject) return false;
  const bool followed = facts().enabled() && (this->controlword() & controlword::kMaker) != 0;
  return object(binding->object).trigger || followed;
}

std::optional<Wanted> AxisCore::target_position() const {
  if (const auto wanted = motion.wanted(Quantity::target_position)) return wanted;
  if (const auto held = value(Quantity::target_position)) return Wanted{*held};
  return std::nullopt;
}

Wanted AxisCore::running_target(Quantity quantity) const { return motion.wanted(quantity).value_or(Wanted{}); }

const AlarmRow* active_alarm(const AxisCore& core) {
  for (const AlarmRow& row : core.drive.alarms) {
    const ObjectId id = core.model.fault_words[row.word];
    if (id == kNoObject || !core.store[id].known) continue;
    if (((static_cast<std::uint64_t>(core.store[id].number) >> row.bit) & 1U) != 0) return &row;
  }
  return nullptr;
}

}  // namespace axisgate::drive
