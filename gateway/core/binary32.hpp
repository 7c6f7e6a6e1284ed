// SPDX-License-Identifier: Apache-2.0
// IEEE 754 binary32 numbers, as panels write them into two registers, and exact numbers: the way between the two.
// Promises one rounding each way: to a binary32 the nearest one, ties to even; from one to whole units half away from
// zero. Never computes in floating point.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/core/rational.hpp"

namespace axisgate {

/// A quiet NaN: there is no value.
inline constexpr std::uint32_t kBinary32NaN = 0x7FC0'0000;

[[nodiscard]] bool is_nan_binary32(std::uint32_t bits);
/// The bits of value * scale.
[[nodiscard]] std::uint32_t to_binary32(std::int64_t value, const Rational& scale);
/// What the bits stand for, times scale. No value: NaN, infinite, or more than 62 bits can hold.
[[nodiscard]] std::optional<std::int64_t> from_binary32(std::uint32_t bits, const Rational& scale);

}  // namespace axisgate
