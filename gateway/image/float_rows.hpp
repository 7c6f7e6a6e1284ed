// SPDX-License-Identifier: Apache-2.0
// The rows that a listener with "numbers": "float" shows as IEEE 754 binary32, in turns, rpm and rpm/s: 32-bit
// positions, velocities and accelerations, at the same offsets (design 3.1 Panels). Promises that a number goes to the
// units of the register map and back through exact fractions, rounded once. Never says what a listener shows: its
// settings do.
#pragma once

#include <cstdint>
#include <string_view>

#include "gateway/core/rational.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate {

[[nodiscard]] bool is_float_row(const RegisterRow& row);
/// "rev", "rpm", "rpm/s", of such rows.
[[nodiscard]] std::string_view float_unit(const RegisterRow& row);

/// What is written as a number that no register of its row can hold: infinite, too large, of the wrong sign. Outside
/// every range, and no "no value" either.
inline constexpr std::int64_t kNoNumber = INT64_MIN;

/// The bits of a value in register units; NaN for the one that means "no value".
[[nodiscard]] std::uint32_t float_bits(const RegisterRow& row, std::int64_t value, const Rational& units_per_rev);
/// In register units, half away from zero; NaN is the number that means "no value", and what does not fit kNoNumber.
[[nodiscard]] std::int64_t float_value(const RegisterRow& row, std::uint32_t bits, const Rational& units_per_rev);

}  // namespace axisgate
