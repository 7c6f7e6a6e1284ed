// SPDX-License-Identifier: Apache-2.0
#include "gateway/model/scale.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>

namespace axisgate::model {
namespace {

struct BaseRow {
  std::string_view name;
  Base base;
  Kind kind;
  std::int64_t registers;  ///< of design 2 that are one of it; 0: as many as the axis has units in a turn
};
constexpr std::array<BaseRow, 9> kBases{{
    {"rpm", Base::rpm, Kind::velocity, 1000},
    {"rps", Base::rps, Kind::velocity, 60000},
    {"rpm/s", Base::rpm_per_s, Kind::acceleration, 10},
    {"rps/s", Base::rps_per_s, Kind::acceleration, 600},
    {"rev", Base::rev, Kind::position, 0},
    {"Arms", Base::arms, Kind::current, 100},
    {"%", Base::percent, Kind::torque, 10},
    {"degC", Base::degc, Kind::temperature, 10},
    {"V", Base::volt, Kind::voltage, 10},
}};

std::int64_t saturated(Int128 value) {
  if (value > INT64_MAX) return INT64_MAX;
  if (value < INT64_MIN) return INT64_MIN;
  return static_cast<std::int64_t>(value);
}

/// numerator / denominator rounded towards minus infinity; `denominator` above 0.
Int128 floor_of(Int128 numerator, Int128 denominator) {
  const Int128 quotient = numerator / denominator;
  return numerator % denominator < 0 ? quotient - 1 : quotient;
}

Int128 ceiling_of(Int128 numerator, Int128 denominator) { return -floor_of(-numerator, denominator); }

}  // namespace

std::optional<Base> base_named(std::string_view name) {
  const auto at = std::ranges::find_if(kBases, [&](const BaseRow& row) { return row.name == name; });
  return at == kBases.end() ? std::nullopt : std::optional(at->base);
}

Kind kind_of(Base base) { return kBases[static_cast<std::size_t>(base)].kind; }

std::optional<Rational> value_of(const Factor& factor, const Constants& constants) {
  if (const auto* number = std::get_if<Rational>(&factor)) return *number;
  const auto at = constants.find(std::get<std::string>(factor));
  return at == constants.end() ? std::nullopt : std::optional(at->second);
}

std::optional<Rational> raw_per_base(const Unit& unit, const Constants& constants) {
  Rational out(1);
  for (const Factor& factor : unit.mul) {
    const std::optional<Rational> value = value_of(factor, constants);
    if (!value) return std::nullopt;
    out = out * *value;
  }
  for (const Factor& factor : unit.div) {
    const std::optional<Rational> value = value_of(factor, constants);
    if (!value || value->numerator() == 0) return std::nullopt;
    out = out / *value;
  }
  return out;
}

Rational base_per_register(Base base, const Rational& units_per_rev) {
  const std::int64_t registers = kBases[static_cast<std::size_t>(base)].registers;
  return registers == 0 ? units_per_rev.inverse() : Rational(1, registers);
}

std::optional<Rational> in_registers(const Amount& amount, const Constants& constants, const Rational& units_per_rev) {
  const std::optional<Rational> value = value_of(amount.number, constants);
  if (!value) return std::nullopt;
  return *value * Rational(amount.negative ? -1 : 1) / base_per_register(amount.base, units_per_rev);
}

std::int64_t rounded_up(const Rational& value) { return saturated(ceiling_of(value.numerator(), value.denominator())); }

std::int64_t rounded_down(const Rational& value) { return saturated(floor_of(value.numerator(), value.denominator())); }

Range registers_within(const Range& raw, const Rational& raw_per_register, bool inverse) {
  if (inverse) {
    const Int128 one = raw_per_register.denominator();
    const auto by = [&](std::int64_t number) { return one * std::max<std::int64_t>(number, 1); };
    return {saturated(ceiling_of(raw_per_register.numerator(), by(raw.max))),
            saturated(floor_of(raw_per_register.numerator(), by(raw.min)))};
  }
  Int128 numerator = raw_per_register.denominator();
  Int128 denominator = raw_per_register.numerator();
  assert(denominator != 0);
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  // An inverted axis has a negative factor: the ends change places.
  const Int128 low = numerator < 0 ? raw.max : raw.min;
  const Int128 high = numerator < 0 ? raw.min : raw.max;
  return {saturated(ceiling_of(low * numerator, denominator)), saturated(floor_of(high * numerator, denominator))};
}

Range registers_for(const ObjectDef& object, const Range& raw, const Rational& raw_per_register, bool inverse) {
  if (object.is_real) return {raw.min > 0 ? 1 : INT64_MIN, INT64_MAX};
  return registers_within(intersection(raw, object.range()), raw_per_register, inverse);
}

Range intersection(const Range& a, const Range& b) { return {std::max(a.min, b.min), std::min(a.max, b.max)}; }

std::optional<Rational> scale_of(const ScaleRecipe& recipe, const std::vector<std::optional<Rational>>& constants) {
  const auto known = [&](std::size_t at) { return at < constants.size() ? constants[at] : std::nullopt; };
  Rational out = recipe.fixed;
  try {
    for (const std::size_t at : recipe.mul) {
      const std::optional<Rational> value = known(at);
      if (!value || value->numerator() <= 0) return std::nullopt;
      out = out * *value;
    }
    for (const std::size_t at : recipe.div) {
      const std::optional<Rational> value = known(at);
      if (!value || value->numerator() <= 0) return std::nullopt;
      out = out / *value;
    }
  } catch (const std::overflow_error&) {
    return std::nullopt;
  }
  return out;
}

void apply_recipe(Binding& binding, const std::vector<std::optional<Rational>>& constants, const ObjectDef& object) {
  const ScaleRecipe& recipe = binding.recipe;
  if (!recipe.waits()) return;
  const std::optional<Rational> scale = scale_of(recipe, constants);
  binding.scaled = scale.has_value();
  binding.limits = recipe.allowed;
  if (!scale) return;
  binding.raw_per_unit = *scale;
  if (row(binding.quantity).writable)
    binding.limits = intersection(recipe.allowed, registers_for(object, recipe.raw, *scale, binding.inverse));
}

}  // namespace axisgate::model
