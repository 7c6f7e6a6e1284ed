// SPDX-License-Identifier: Apache-2.0
#include "gateway/model/model.hpp"

#include <algorithm>
#include <stdexcept>

#include "gateway/model/scale.hpp"

namespace axisgate::model {
namespace {

std::uint32_t low_bytes(std::uint32_t raw, std::uint8_t size) {
  return size >= 4 ? raw : raw & ((std::uint32_t{1} << (8U * size)) - 1U);
}

}  // namespace

std::int64_t ObjectDef::number(std::uint32_t raw) const {
  const std::int64_t value = low_bytes(raw, size);
  const std::int64_t span = std::int64_t{1} << (8 * size);
  return is_signed && value >= span / 2 ? value - span : value;
}

Range ObjectDef::range() const {
  const std::int64_t span = std::int64_t{1} << (8 * size);
  return is_signed ? Range{-span / 2, span / 2 - 1} : Range{0, span - 1};
}

std::optional<std::int64_t> Binding::to_register(std::int64_t raw) const {
  if (!codes.empty()) {
    const auto code = std::ranges::find_if(codes, [&](const auto& c) { return c.second == raw; });
    return code == codes.end() ? std::nullopt : std::optional(code->first);
  }
  if (!scaled) return std::nullopt;
  const std::optional<std::int64_t> value = raw_per_unit.inverse().scale(raw);
  if (!value || !range_of(row(quantity).type).holds(*value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> Binding::to_register_or_bound(std::int64_t raw) const {
  if (!codes.empty() || !scaled) return to_register(raw);
  const Range held = range_of(row(quantity).type);
  const bool negative = (raw < 0) != (raw_per_unit.numerator() < 0);
  return std::clamp(raw_per_unit.inverse().scale(raw).value_or(negative ? held.min : held.max), held.min, held.max);
}

std::optional<std::int64_t> Binding::to_raw(std::int64_t value, const ObjectDef& object_def) const {
  if (!codes.empty()) {
    const auto code = std::ranges::find_if(codes, [&](const auto& c) { return c.first == value; });
    return code == codes.end() ? std::nullopt : std::optional(code->second);
  }
  if (!scaled) return std::nullopt;
  std::optional<std::int64_t> raw = raw_per_unit.scale(value);
  if (!raw) return std::nullopt;
  // Where no number of the drive meets the limit: the last one before it.
  const std::int64_t told = to_register_or_bound(*raw).value_or(value);
  const std::int64_t up = raw_per_unit.numerator() > 0 ? 1 : -1;
  if (limits.holds(value) && told > limits.max) *raw -= up;
  if (limits.holds(value) && told < limits.min) *raw += up;
  if (!object_def.range().holds(*raw)) return std::nullopt;
  return raw;
}

bool Condition::holds(const ObjectDef& object_def, std::uint32_t raw) const {
  const std::int64_t seen = mask == 0 ? object_def.number(raw) : std::int64_t{low_bytes(raw, object_def.size) & mask};
  const bool found = std::ranges::find(values, seen) != values.end();
  const bool wanted = test == Test::equals || test == Test::in;
  return found == wanted;
}

const Binding* AxisModel::binding(Quantity q) const {
  const std::int16_t at = binding_of[static_cast<std::size_t>(q)];
  return at < 0 ? nullptr : &bindings[static_cast<std::size_t>(at)];
}

std::vector<ObjectId> constant_objects(const DriveModel& model) {
  std::vector<ObjectId> out;
  const auto add = [&](const DriveConstant::Operand& operand) {
    if (operand.object != kNoObject && std::ranges::find(out, operand.object) == out.end())
      out.push_back(operand.object);
  };
  for (const DriveConstant& constant : model.constants) {
    for (const DriveConstant::Rule& rule : constant.rules) {
      add(rule.left);
      add(rule.right);
      for (const auto* operands : {&rule.mul, &rule.div}) std::for_each(operands->begin(), operands->end(), add);
    }
  }
  return out;
}

std::optional<Rational> value_of(const DriveConstant& constant,
                                 const std::function<std::optional<std::int64_t>(ObjectId)>& number_of) {
  const auto number = [&](const DriveConstant::Operand& operand) -> std::optional<Rational> {
    if (operand.object == kNoObject) return operand.number;
    const std::optional<std::int64_t> known = number_of(operand.object);
    return known ? std::optional(Rational(*known)) : std::nullopt;
  };
  try {
    for (const DriveConstant::Rule& rule : constant.rules) {
      if (rule.conditional) {
        const auto left = number(rule.left);
        const auto right = number(rule.right);
        if (!left || !right) return std::nullopt;
        if ((*left == *right) != rule.equal) continue;
      }
      Rational out(1);
      for (const auto& operand : rule.mul) {
        const auto factor = number(operand);
        if (!factor) return std::nullopt;
        out = out * *factor;
      }
      for (const auto& operand : rule.div) {
        const auto factor = number(operand);
        if (!factor || factor->numerator() == 0) return std::nullopt;
        out = out / *factor;
      }
      return out;
    }
  } catch (const std::overflow_error&) {
    return std::nullopt;
  }
  return std::nullopt;
}

namespace {

/// What it writes, once every constant it waits for is known.
std::optional<std::int64_t> raw_of(const FactoryWrite& write, const std::vector<std::optional<Rational>>& constants) {
  const std::optional<Rational> scale = scale_of(write.recipe, constants);
  if (!scale) return std::nullopt;
  try {
    const std::optional<std::int64_t> raw = (write.amount * *scale).scale(1);
    return raw && write.recipe.raw.holds(*raw) ? raw : std::nullopt;
  } catch (const std::overflow_error&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<ObjectWrite> setup_writes(const DriveModel& model,
                                      const std::function<std::optional<std::int64_t>(ObjectId)>& number_of) {
  std::vector<ObjectWrite> out = model.setup;
  if (model.factory_writes.empty()) return out;
  std::vector<std::optional<Rational>> constants;
  for (const DriveConstant& constant : model.constants) constants.push_back(value_of(constant, number_of));
  for (const FactoryWrite& write : model.factory_writes) {
    const std::optional<std::int64_t> held = number_of(write.object);
    if (!held || std::ranges::find(write.instead_of, *held) == write.instead_of.end()) continue;
    const std::optional<std::int64_t> raw = raw_of(write, constants);
    if (raw && *raw != *held) out.push_back({write.object, *raw, write.why});
  }
  return out;
}

bool AxisModel::is_own_velocity_mode(int in_force) const {
  const std::vector<std::int16_t>& own = cia402.velocity_modes;
  return std::ranges::find(own, in_force) != own.end();
}

bool AxisModel::needs_for_state(ObjectId object) const {
  if (!virtual_axis) return object == statusword;
  return object == virtual_axis->enabled.object || object == virtual_axis->fault.object;
}

bool DriveModel::needs_for_state(ObjectId object) const {
  return std::ranges::any_of(axes, [object](const AxisModel& axis) { return axis.needs_for_state(object); });
}

bool DriveModel::needs(ObjectId object) const {
  return needs_for_state(object) || std::ranges::any_of(axes, [object](const AxisModel& axis) {
           const Binding* position = axis.binding(Quantity::position_actual);
           return position != nullptr && position->object == object;
         });
}

ObjectId DriveModel::find(ObjectAddress address) const {
  const auto at = std::ranges::find_if(
      objects, [&](const ObjectDef& candidate) { return !candidate.emulated && candidate.address == address; });
  return at == objects.end() ? kNoObject : static_cast<ObjectId>(at - objects.begin());
}

}  // namespace axisgate::model
