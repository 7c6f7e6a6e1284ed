// SPDX-License-Identifier: Apache-2.0
// Exact conversions between what a drive counts and the units of the registers (design 2).
// Promises that limits are rounded inwards, so that no value a limit allows goes beyond it in the drive.
// Never uses floating point.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/model/model.hpp"

namespace axisgate::model {

/// What a unit counts, before the drive's own factors.
enum class Base : std::uint8_t { rpm, rps, rpm_per_s, rps_per_s, rev, arms, percent, degc, volt };
[[nodiscard]] std::optional<Base> base_named(std::string_view name);
/// The kind of quantity that this base can stand for.
[[nodiscard]] Kind kind_of(Base base);

/// A number, or the constant of this name.
using Factor = std::variant<Rational, std::string>;

/// raw = engineering * product(mul) / product(div); inverse: product(mul) / product(div) / engineering.
struct Unit {
  Base base{};
  std::vector<Factor> mul, div;
  bool inverse = false;
};

/// "-3000 rpm", "rated_speed_rpm rpm".
struct Amount {
  bool negative = false;
  Factor number;
  Base base{};
};

/// The constants of one configured drive: overrides over defaults. What is in neither is absent.
using Constants = std::map<std::string, Rational, std::less<>>;

[[nodiscard]] std::optional<Rational> value_of(const Factor& factor, const Constants& constants);
/// raw = engineering * this; no value where a constant is absent. Throws std::overflow_error beyond 64 bits.
[[nodiscard]] std::optional<Rational> raw_per_base(const Unit& unit, const Constants& constants);
/// How many of this base one register unit is: 1/1000 for rpm.
[[nodiscard]] Rational base_per_register(Base base, const Rational& units_per_rev);
/// In register units, not rounded; no value where a constant is absent.
[[nodiscard]] std::optional<Rational> in_registers(const Amount& amount, const Constants& constants,
                                                   const Rational& units_per_rev);

[[nodiscard]] std::int64_t rounded_up(const Rational& value);
[[nodiscard]] std::int64_t rounded_down(const Rational& value);
/// The register values whose raw values lie in `raw`; inverse: raw_per_register / register value, `raw` from 1 on.
[[nodiscard]] Range registers_within(const Range& raw, const Rational& raw_per_register, bool inverse = false);
/// Those that can be written to an object which takes `raw`. REAL32 takes them all, those above 0 where it takes no 0.
[[nodiscard]] Range registers_for(const ObjectDef& object, const Range& raw, const Rational& raw_per_register,
                                  bool inverse);
[[nodiscard]] Range intersection(const Range& a, const Range& b);

/// fixed * product(mul) / product(div); none where a constant that it waits for is not known or not above 0, or where
/// the product fits no rational number.
[[nodiscard]] std::optional<Rational> scale_of(const ScaleRecipe& recipe,
                                               const std::vector<std::optional<Rational>>& constants);
/// Makes scale and limits of a binding whose recipe waits for the drive's constants (model.hpp) out of what they are
/// now: by position in DriveModel::constants, no value where one is not known. Afterwards the binding is as if they had
/// been configured; it has no scale where a constant is not known, not above 0, or makes more than 64 bits. Limits may
/// then hold nothing at all (first above second). Never throws; leaves a binding that waits for nothing alone.
void apply_recipe(Binding& binding, const std::vector<std::optional<Rational>>& constants, const ObjectDef& object);

}  // namespace axisgate::model
