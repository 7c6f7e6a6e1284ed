// SPDX-License-Identifier: Apache-2.0
#include "gateway/model/model.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "gateway/model/real32.hpp"
#include "gateway/model/scale.hpp"

namespace axisgate::model {
namespace {

std::uint32_t low_bits(std::uint32_t raw, int bits) {
  return bits >= 32 ? raw : raw & ((std::uint32_t{1} << bits) - 1U);
}

int bits_of(const ObjectDef& object) {
  return object.is_part() && !object.is_directed() ? object.part.count : 8 * object.size;
}

}  // namespace

std::int64_t ObjectDef::number(std::uint32_t raw) const {
  if (is_real) return real_of_bits(raw);
  const std::int64_t value = low_bits(raw, bits_of(*this));
  const std::int64_t span = std::int64_t{1} << bits_of(*this);
  return is_signed && value >= span / 2 ? value - span : value;
}

std::uint32_t ObjectDef::raw(std::int64_t number) const {
  if (is_real) return bits_of_real(number);
  return low_bits(static_cast<std::uint32_t>(static_cast<std::uint64_t>(number)), 8 * size);
}

Range ObjectDef::range() const {
  if (is_real) return {-kLargestReal, kLargestReal};
  const std::int64_t span = std::int64_t{1} << bits_of(*this);
  return is_signed ? Range{-span / 2, span / 2 - 1} : Range{0, span - 1};
}

std::uint32_t ObjectDef::mask() const {
  return is_part() && !is_directed() ? low_bits(~0U, part.count) << part.from : 0;
}

std::optional<std::int64_t> Binding::to_register(std::int64_t raw) const {
  if (!codes.empty()) {
    const auto code = std::ranges::find_if(codes, [&](const auto& c) { return c.second == raw; });
    return code == codes.end() ? std::nullopt : std::optional(code->first);
  }
  if (!scaled) return std::nullopt;
  const std::optional<std::int64_t> value = inverse   ? raw_per_unit.over(raw)
                                            : is_real ? scaled_real(raw, raw_per_unit.inverse())
                                                      : raw_per_unit.inverse().scale(raw);
  if (!value || !range_of(row(quantity).type).holds(*value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> Binding::to_register_or_bound(std::int64_t raw) const {
  const bool no_number = is_real && std::abs(raw) > kLargestReal;
  if (!codes.empty() || !scaled || inverse || no_number) return to_register(raw);
  const Range held = range_of(row(quantity).type);
  const bool negative = (raw < 0) != (raw_per_unit.numerator() < 0);
  const Rational per_raw = raw_per_unit.inverse();
  const std::optional<std::int64_t> value = is_real ? scaled_real(raw, per_raw) : per_raw.scale(raw);
  return std::clamp(value.value_or(negative ? held.min : held.max), held.min, held.max);
}

std::optional<std::int64_t> Binding::to_raw(std::int64_t value, const ObjectDef& object_def) const {
  if (!codes.empty()) {
    const auto code = std::ranges::find_if(codes, [&](const auto& c) { return c.first == value; });
    return code == codes.end() ? std::nullopt : std::optional(code->second);
  }
  if (!scaled) return std::nullopt;
  std::optional<std::int64_t> raw = inverse ? raw_per_unit.over(value)
                                    : is_real
                                        ? real_of(Int128{value} * raw_per_unit.numerator(), raw_per_unit.denominator())
                                        : raw_per_unit.scale(value);
  if (!raw) return std::nullopt;
  // Where no number of the drive meets the limit: the last one before it.
  const std::int64_t told = to_register_or_bound(*raw).value_or(value);
  const std::int64_t up = (raw_per_unit.numerator() > 0) != inverse ? 1 : -1;
  if (limits.holds(value) && told > limits.max) *raw -= up;
  if (limits.holds(value) && told < limits.min) *raw += up;
  if (!object_def.range().holds(*raw)) return std::nullopt;
  return raw;
}

bool Condition::holds(const ObjectDef& object_def, std::uint32_t raw) const {
  const std::int64_t seen =
      mask == 0 ? object_def.number(raw) : std::int64_t{low_bits(raw, bits_of(object_def)) & mask};
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
  for (const DriveConstant& constant : model.constants)
    for (const ObjectId id : objects_of(constant))
      if (std::ranges::find(out, id) == out.end()) out.push_back(id);
  return out;
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

std::vector<ObjectWrite> setup_writes(const DriveModel& model, const NumberOf& number_of, const IsAbsent& is_absent) {
  std::vector<ObjectWrite> out = model.setup;
  if (model.factory_writes.empty()) return out;
  std::vector<std::optional<Rational>> constants;
  for (const DriveConstant& constant : model.constants)
    constants.push_back(evaluate(constant, number_of, is_absent).value);
  for (const FactoryWrite& write : model.factory_writes) {
    const std::optional<std::int64_t> held = number_of(write.object);
    if (!held || std::ranges::find(write.instead_of, *held) == write.instead_of.end()) continue;
    const std::optional<std::int64_t> raw = raw_of(write, constants);
    if (raw && *raw != *held) out.push_back({write.object, *raw, write.why});
  }
  return out;
}

bool AxisModel::counts_known() const {
  return std::ranges::all_of(bindings, [](const Binding& each) {
    const Kind kind = row(each.quantity).kind;
    const bool of_motion = kind == Kind::position || kind == Kind::velocity || kind == Kind::acceleration;
    return each.scaled || !of_motion;
  });
}

bool AxisModel::is_own_velocity_mode(int in_force) const {
  const std::vector<std::int16_t>& own = cia402.velocity_modes;
  return std::ranges::find(own, in_force) != own.end();
}

bool AxisModel::needs_for_state(ObjectId object) const {
  if (!virtual_axis) return object == statusword;
  return object == virtual_axis->enabled.object || object == virtual_axis->fault.object;
}

std::vector<ObjectId> DriveModel::with_parts(ObjectId object) const {
  std::vector<ObjectId> out{object};
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].part.whole == object || (objects[i].is_directed() && objects[i].part.sign == object))
      out.push_back(static_cast<ObjectId>(i));
  return out;
}

bool DriveModel::needs_for_state(ObjectId object) const {
  return std::ranges::any_of(axes, [&](const AxisModel& axis) {
    return std::ranges::any_of(with_parts(object), [&](ObjectId id) { return axis.needs_for_state(id); });
  });
}

bool DriveModel::needs(ObjectId object) const {
  return needs_for_state(object) || std::ranges::any_of(axes, [&](const AxisModel& axis) {
           const Binding* position = axis.binding(Quantity::position_actual);
           return position != nullptr && position->object != kNoObject && whole(position->object) == whole(object);
         });
}

ObjectId DriveModel::find(ObjectAddress address, std::uint32_t mask) const {
  const auto at = std::ranges::find_if(objects, [&](const ObjectDef& candidate) {
    return !candidate.emulated && !candidate.is_directed() && candidate.address == address && candidate.mask() == mask;
  });
  return at == objects.end() ? kNoObject : static_cast<ObjectId>(at - objects.begin());
}

}  // namespace axisgate::model
