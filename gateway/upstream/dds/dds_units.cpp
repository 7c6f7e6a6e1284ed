// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/dds_units.hpp"

#include <cmath>
#include <limits>

namespace axisgate::dds {

DdsUnits::DdsUnits(const AxisUnits& units) {
  const auto at = [this](Kind kind) -> Scale& { return scales_[static_cast<std::size_t>(kind)]; };
  const auto number = [](std::int64_t value) { return DoubleDouble::of(value); };
  // A turn, in rad or in metres.
  Scale turn{kTwoPi, DoubleDouble(1)};
  if (units.metres_per_rev)
    turn = {number(units.metres_per_rev->numerator()), number(units.metres_per_rev->denominator())};
  turn_ = turn.numerator.high / turn.denominator.high;
  at(Kind::position) = {turn.numerator * number(units.units_per_rev.denominator()),
                        turn.denominator * number(units.units_per_rev.numerator())};
  constexpr std::int64_t kVelocityPerTurn = 60 * 1000;    // 0.001 rpm -> turns/s
  constexpr std::int64_t kAccelerationPerTurn = 60 * 10;  // 0.1 rpm/s -> turns/s2
  at(Kind::velocity) = {turn.numerator, turn.denominator * number(kVelocityPerTurn)};
  at(Kind::acceleration) = {turn.numerator, turn.denominator * number(kAccelerationPerTurn)};
  at(Kind::current) = {DoubleDouble(1), DoubleDouble(100)};
  at(Kind::temperature) = {DoubleDouble(1), DoubleDouble(10)};
  at(Kind::voltage) = {DoubleDouble(1), DoubleDouble(10)};
}

double DdsUnits::to_si(Quantity quantity, std::int64_t shown) const {
  const QuantityRow& what = row(quantity);
  if (shown == no_value(what.type)) return std::numeric_limits<double>::quiet_NaN();
  const Scale& by = scale(what.kind);
  return (DoubleDouble::of(shown) * by.numerator / by.denominator).high;
}

std::optional<std::int64_t> DdsUnits::to_register(Quantity quantity, double si) const {
  const QuantityRow& what = row(quantity);
  return to_register(what.kind, what.type, si);
}

std::optional<std::int64_t> DdsUnits::to_register(Kind kind, RegisterType type, double si) const {
  if (!std::isfinite(si)) return std::nullopt;
  const Scale& by = scale(kind);
  const Range range = range_of(type);
  // First in one double: far outside, the exact arithmetic would overflow.
  constexpr double kOneMore = 2;
  const double about = si * by.denominator.high / by.numerator.high;
  if (!(about > static_cast<double>(range.min) - kOneMore && about < static_cast<double>(range.max) + kOneMore))
    return std::nullopt;
  // A value that vanishes beside one register unit has no digits left to be exact about.
  constexpr double kNothing = 1e-6;
  if (std::fabs(about) < kNothing) return range.holds(0) ? std::optional<std::int64_t>(0) : std::nullopt;
  const auto nearest = static_cast<std::int64_t>(rounded(DoubleDouble(si) * by.denominator / by.numerator));
  return range.holds(nearest) ? std::optional(nearest) : std::nullopt;
}

}  // namespace axisgate::dds
