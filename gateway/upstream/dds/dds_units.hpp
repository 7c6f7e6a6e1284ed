// SPDX-License-Identifier: Apache-2.0
// One axis's units: registers on one side, SI on the other (design 2).
// Promises that a double is the one nearest to the exact value, that a register value is the nearest, half away from
// zero, and that what is shown and written back is the same register value again. Never wraps: what does not fit is no
// value.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdint>
#include <optional>

#include "gateway/image/quantity.hpp"
#include "gateway/upstream/dds/dds_settings.hpp"

namespace axisgate::dds {

class DdsUnits {
 public:
  explicit DdsUnits(const AxisUnits& units = {});

  /// `shown` as registers show it; NaN where that is the number that stands for no value.
  [[nodiscard]] double to_si(Quantity quantity, std::int64_t shown) const;
  /// No value: NaN, infinite, or outside what a register of this kind can hold.
  [[nodiscard]] std::optional<std::int64_t> to_register(Quantity quantity, double si) const;
  /// The same for rows that are no quantities (jog_velocity, set_position_value).
  [[nodiscard]] std::optional<std::int64_t> to_register(Kind kind, RegisterType type, double si) const;
  /// A turn of the motor, in rad or in metres.
  [[nodiscard]] double turn() const { return turn_; }

 private:
  /// 113 bits: what is scaled by a rational and by pi becomes the double nearest to the exact result.
  using Exact = boost::multiprecision::cpp_bin_float_quad;
  struct Scale {
    Exact si = 1;         ///< of one register unit
    Exact registers = 1;  ///< of one SI unit
  };
  [[nodiscard]] const Scale& scale(Kind kind) const { return scales_[static_cast<std::size_t>(kind)]; }

  double turn_ = 0;
  std::array<Scale, static_cast<std::size_t>(Kind::voltage) + 1> scales_{};
};

}  // namespace axisgate::dds
