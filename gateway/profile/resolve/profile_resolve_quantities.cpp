// SPDX-License-Identifier: Apache-2.0
// Quantities of one axis: where each is had from, its exact scale and the limits of a write.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

/// Where a write may be repeated by every scan, the drive's own value seldom changes: it is read once and after each
/// write.
model::PollClass default_poll(const QuantityRow& row) {
  return row.writable ? model::PollClass::once : model::PollClass::normal;
}

/// What an inverted axis negates. Magnitudes (profile_velocity, max_torque) have no direction.
bool is_directed(const QuantityRow& row) {
  const bool directed =
      row.kind == Kind::position || row.kind == Kind::velocity || row.kind == Kind::torque || row.kind == Kind::current;
  return directed && (row.type == RegisterType::i16 || row.type == RegisterType::i32);
}

constexpr std::string_view kPosition = "position", kVelocity = "velocity", kAcceleration = "acceleration",
                           kTorque = "torque", kQuickStop = "quick_stop_deceleration_min";

/// A speed, a ramp or a max_torque that the drive would hold as 0 is none: 0 means "leave as it is" (design 3.3 Zeros),
/// and a drive that is told to slow down at 0, or without torque, may turn on.
Range numbers_of_write(const QuantityRow& row, const model::ObjectDef& def) {
  Range out = model::intersection(def.printed, def.range());
  const bool rate = row.type == RegisterType::u32 && (row.kind == Kind::velocity || row.kind == Kind::acceleration);
  const bool torque = row.type == RegisterType::u16 && row.kind == Kind::torque;
  if ((rate || torque) && row.writable) out.min = std::max<std::int64_t>(out.min, 1);
  return out;
}

/// On an inverted axis the drive's positive limit is the axis's negative one.
Quantity opposite(Quantity quantity) {
  if (quantity == Quantity::position_limit_min) return Quantity::position_limit_max;
  if (quantity == Quantity::position_limit_max) return Quantity::position_limit_min;
  return quantity;
}

/// Limits of the axis that hold for this quantity, and the configuration key that says so.
struct AxisLimit {
  Range range{INT64_MIN, INT64_MAX};
  std::string key;  ///< empty: none does
  [[nodiscard]] bool is_one() const { return range.min != INT64_MIN || range.max != INT64_MAX; }
};

AxisLimit axis_limit(const AxisLimits& limits, const QuantityRow& row) {
  AxisLimit out;
  const std::string_view key = limit_key(row.quantity);
  const std::optional<std::int64_t> magnitude = key == kVelocity       ? limits.velocity
                                                : key == kAcceleration ? limits.acceleration
                                                : key == kTorque       ? limits.torque
                                                                       : std::nullopt;
  if (magnitude) out.range = {-*magnitude, *magnitude};
  if (key == kPosition && limits.position) out.range = *limits.position;
  if (key == kQuickStop) out.range.min = limits.quick_stop_deceleration_min.value_or(INT64_MIN);
  if (out.is_one()) out.key = key;
  return out;
}

class AxisQuantities {
 public:
  AxisQuantities(Resolving& resolving, AxisSlot slot)
      : r_(resolving), slot_(slot), axis_(resolving.input.axes[slot]), model_(resolving.model.axes[slot]) {}

  void run() {
    model_.binding_of.fill(-1);
    for (const QuantityRow& row : quantity_table())
      if (std::optional<model::Binding> binding = bind(row)) add(std::move(*binding));
  }

 private:
  std::optional<model::Binding> bind(const QuantityRow& row) {
    if (r_.profile.state.is_virtual)
      if (std::optional<model::Binding> made = bind_emulated(row)) return made;
    const QuantitySpec* spec = r_.profile.find(axis_.inverted ? opposite(row.quantity) : row.quantity);
    if (!r_.can_follow(slot_, row.quantity)) return std::nullopt;
    if (spec == nullptr) return row.quantity == Quantity::error_code ? from_alarm_table() : std::nullopt;
    model::Binding out;
    out.quantity = row.quantity;
    out.poll = spec->poll.value_or(default_poll(row));
    out.limits = range_of(row.type);
    if (!spec->bits.empty()) return compose(*spec, std::move(out));
    for (const std::string& name : spec->objects) {
      out.object = r_.id(name, slot_);
      if (out.object != model::kNoObject)
        return scaled(row, *spec, *r_.profile.find(name, r_.motor(slot_)), std::move(out));
    }
    return std::nullopt;
  }

  /// Statusword, controlword and mode of a virtual axis: the gateway's own objects hold the registers' numbers.
  std::optional<model::Binding> bind_emulated(const QuantityRow& row) const {
    using enum Quantity;
    model::Binding out;
    out.quantity = row.quantity;
    out.object = row.quantity == statusword                             ? model_.statusword
                 : row.quantity == controlword                          ? model_.controlword
                 : row.quantity == mode || row.quantity == mode_display ? model_.mode
                                                                        : model::kNoObject;
    if (out.object == model::kNoObject) return std::nullopt;
    out.poll = row.writable ? model::PollClass::once : model::PollClass::fast;
    out.writable = row.writable;
    out.limits = model::intersection(range_of(row.type), r_.model.object(out.object).range());
    return out;
  }

  /// error_code is read from no object where the profile has an alarm table: it follows from the fault words, or from
  /// what the drive sends.
  std::optional<model::Binding> from_alarm_table() {
    const auto there = [&](const model::AlarmRow& row) {
      return r_.id(r_.profile.fault_words()[row.word], slot_) != model::kNoObject;
    };
    if (!std::ranges::any_of(r_.profile.alarms, there) && !r_.profile.has_emergency_word(r_.input.protocol))
      return std::nullopt;
    model::Binding out;
    out.quantity = Quantity::error_code;
    out.limits = range_of(RegisterType::u16);
    return out;
  }

  std::optional<model::Binding> compose(const QuantitySpec& spec, model::Binding out) {
    const bool swaps = axis_.inverted && out.quantity == Quantity::digital_inputs;
    for (const BitsSpec& field : spec.bits) {
      const model::ObjectId object = r_.id(field.name, slot_);
      if (object == model::kNoObject) continue;  // a bit the drive cannot give is 0
      if (!swaps) {
        out.bits.emplace_back(field).object = object;
        continue;
      }
      for (std::uint8_t i = 0; i < field.count; ++i) {
        const auto to = static_cast<std::uint8_t>(field.to + i);
        const std::uint8_t swapped = to < 2 ? static_cast<std::uint8_t>(1 - to) : to;
        out.bits.push_back({object, static_cast<std::uint8_t>(field.from + i), 1, swapped, field.inverted});
      }
    }
    return out.bits.empty() ? std::nullopt : std::optional(std::move(out));
  }

  std::optional<model::Binding> scaled(const QuantityRow& row, const QuantitySpec& spec, const Object& object,
                                       model::Binding out) {
    if (row.kind != Kind::code) {
      const model::Unit& unit = r_.profile.units.find(spec.unit_of(object))->second;
      std::vector<std::string> missing;
      std::optional<model::ScaleRecipe> recipe = r_.recipe(unit, &missing);
      if (!recipe) {  // not supported, never guessed
        refuse_limit(row, missing);
        return std::nullopt;
      }
      const Rational base = base_per_register(unit.base, axis_.units_per_rev);
      recipe->fixed = unit.inverse ? recipe->fixed / base : recipe->fixed * base;
      out.inverse = unit.inverse;
      if (axis_.inverted && is_directed(row)) recipe->fixed = recipe->fixed * Rational(-1);
      out.scaled = !recipe->waits();
      if (out.scaled)
        out.raw_per_unit = recipe->fixed;
      else
        out.recipe = std::move(*recipe);
    }
    const model::ObjectDef& def = r_.model.object(out.object);
    out.is_real = def.is_real;
    out.writable = row.writable && def.writable;
    // What cannot be read back is no quantity, except where writing is all there is to it.
    if (!out.writable && !def.readable) return std::nullopt;
    if (row.quantity == Quantity::homing_method) translate(out);
    if (row.quantity == Quantity::position_actual) model_.position_commanded = spec.commanded;
    if (row.writable) limit(row, spec, def, out);
    if (!out.scaled) {
      out.recipe.raw = numbers_of_write(row, def);
      out.recipe.allowed = out.limits;
    }
    return out;
  }

  /// Of a quantity that the axis lacks for want of constants: who wrote it believes that the axis is limited.
  void refuse_limit(const QuantityRow& row, const std::vector<std::string>& constants) {
    const AxisLimit own = axis_limit(axis_.limits, row);
    if (!row.writable || own.key.empty() || constants.empty()) return;
    const std::string pointer = "/axes/" + std::to_string(slot_) + "/limits/" + own.key;
    if (std::ranges::find(r_.faults, pointer, &Fault::pointer) != r_.faults.end()) return;  // by another quantity
    r_.fault(pointer, fmt::format("limits nothing: this drive's unit of it needs {}: add {} to the drive's "
                                  "\"constants\", or take the limit out",
                                  fmt::join(constants, " and "), constants.size() == 1 ? "it" : "them"));
  }

  /// A drive that numbers its homing methods otherwise: the register has CiA 402's.
  void translate(model::Binding& out) const {
    const auto& methods = r_.profile.state.homing_methods;
    if (std::ranges::all_of(methods, [](const auto& row) { return row.first == row.second; })) return;
    out.codes.assign(methods.begin(), methods.end());
  }

  void limit(const QuantityRow& row, const QuantitySpec& spec, const model::ObjectDef& def, model::Binding& out) {
    const Range raw = numbers_of_write(row, def);
    if (!out.codes.empty())
      out.limits = {out.codes.front().first, out.codes.back().first};
    else if (out.scaled)
      out.limits = model::intersection(out.limits, model::registers_for(def, raw, out.raw_per_unit, out.inverse));
    out.limits = model::intersection(out.limits, profile_limit(spec));
    const AxisLimit own = axis_limit(axis_.limits, row);
    const Range allowed = model::intersection(out.limits, own.range);
    if (allowed.min > allowed.max)
      r_.fault(fmt::format("/axes/{}/limits/{}", slot_, own.key),
               fmt::format("leaves no value for {}, which this drive takes from {} to {}", row.name, out.limits.min,
                           out.limits.max));
    out.limits = allowed;
    out.limited = own.is_one();
  }

  [[nodiscard]] Range profile_limit(const QuantitySpec& spec) const {
    Range out{INT64_MIN, INT64_MAX};
    const auto end = [&](const std::optional<model::Amount>& amount) -> std::optional<Rational> {
      return amount ? model::in_registers(*amount, r_.constants, axis_.units_per_rev) : std::nullopt;
    };
    if (const auto low = end(spec.min)) out.min = model::rounded_up(*low);
    if (const auto high = end(spec.max)) out.max = model::rounded_down(*high);
    if (!axis_.inverted || !is_directed(row(spec.quantity))) return out;
    return {out.max == INT64_MAX ? INT64_MIN : -out.max, out.min == INT64_MIN ? INT64_MAX : -out.min};
  }

  void add(model::Binding binding) {
    model_.binding_of[static_cast<std::size_t>(binding.quantity)] = static_cast<std::int16_t>(model_.bindings.size());
    model_.supported |= bit(binding.quantity);
    if (binding.writable) model_.writable |= bit(binding.quantity);
    model_.bindings.push_back(std::move(binding));
  }

  Resolving& r_;
  AxisSlot slot_;
  const ResolveAxis& axis_;
  model::AxisModel& model_;
};

}  // namespace

std::string_view limit_key(Quantity quantity) {
  using enum Quantity;
  static constexpr auto kKeys = names_of<Quantity>({
      {target_position, kPosition},
      {position_limit_min, kPosition},
      {position_limit_max, kPosition},
      {target_velocity, kVelocity},
      {profile_velocity, kVelocity},
      {homing_speed_switch, kVelocity},
      {homing_speed_zero, kVelocity},
      {max_velocity, kVelocity},
      {profile_acceleration, kAcceleration},
      {profile_deceleration, kAcceleration},
      {homing_acceleration, kAcceleration},
      {target_torque, kTorque},
      {max_torque, kTorque},
      {quick_stop_deceleration, kQuickStop},
  });
  return kKeys.of(quantity, "");
}

void resolve_quantities(Resolving& resolving, AxisSlot slot) { AxisQuantities(resolving, slot).run(); }

}  // namespace axisgate::profile
