// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/dds_units.hpp"

#include <cmath>
#include <limits>

namespace axisgate::dds {
namespace {

// The nearest whole number, half away from zero. What is only the arithmetic's own error does not make a half less.
template <typename Exact>
std::int64_t rounded(const Exact& value) {
  constexpr double kError = 1e-29;
  const Exact size = abs(value);
  const auto whole = static_cast<std::int64_t>(trunc(size + 0.5 + kError * size));
  return value < 0 ? -whole : whole;
}

}  // namespace

DdsUnits::DdsUnits(const AxisUnits& units) {
  const auto scale = [this](Kind kind, const Exact& numerator, const Exact& denominator) {
    scales_[static_cast<std::size_t>(kind)] = {numerator / denominator, denominator / numerator};
  };
  // A turn, in rad or in metres.
  Exact turn("6.28318530717958647692528676655900577");
  Exact per_turn = 1;
  if (units.metres_per_rev) {
    turn = units.metres_per_rev->numerator();
    per_turn = units.metres_per_rev->denominator();
  }
  turn_ = static_cast<double>(turn) / static_cast<double>(per_turn);
  scale(Kind::position, turn * units.units_per_rev.denominator(), per_turn * units.units_per_rev.numerator());
  constexpr std::int64_t kVelocityPerTurn = 60 * 1000;    // 0.001 rpm -> turns/s
  constexpr std::int64_t kAccelerationPerTurn = 60 * 10;  // 0.1 rpm/s -> turns/s2
  scale(Kind::velocity, turn, per_turn * kVelocityPerTurn);
  scale(Kind::acceleration, turn, per_turn * kAccelerationPerTurn);
  scale(Kind::current, 1, 100);
  scale(Kind::temperature, 1, 10);
  scale(Kind::voltage, 1, 10);
}

double DdsUnits::to_si(Quantity quantity, std::int64_t shown) const {
  const QuantityRow& what = row(quantity);
  if (shown == no_value(what.type)) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(shown * scale(what.kind).si);
}

std::optional<std::int64_t> DdsUnits::to_register(Quantity quantity, double si) const {
  const QuantityRow& what = row(quantity);
  return to_register(what.kind, what.type, si);
}

std::optional<std::int64_t> DdsUnits::to_register(Kind kind, RegisterType type, double si) const {
  if (!std::isfinite(si)) return std::nullopt;
  const Scale& by = scale(kind);
  const Range range = range_of(type);
  // First in one double: what is far outside is no whole number of 64 bits.
  constexpr double kOneMore = 2;
  const double about = si * static_cast<double>(by.registers);
  if (!(about > static_cast<double>(range.min) - kOneMore && about < static_cast<double>(range.max) + kOneMore))
    return std::nullopt;
  // A value that vanishes beside one register unit has no digits left to be exact about.
  constexpr double kNothing = 1e-6;
  if (std::fabs(about) < kNothing) return range.holds(0) ? std::optional<std::int64_t>(0) : std::nullopt;
  const std::int64_t nearest = rounded(Exact(si * by.registers));
  return range.holds(nearest) ? std::optional(nearest) : std::nullopt;
}

}  // namespace axisgate::dds
