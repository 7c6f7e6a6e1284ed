// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/float_rows.hpp"

#include "gateway/core/binary32.hpp"

namespace axisgate {
namespace {

/// Register units in a turn, an rpm or an rpm/s.
Rational per_float_unit(const RegisterRow& row, const Rational& units_per_rev) {
  if (row.kind == Kind::position) return units_per_rev;
  return Rational(row.kind == Kind::velocity ? 1000 : 10);
}

}  // namespace

bool is_float_row(const RegisterRow& row) {
  const bool motion = row.kind == Kind::position || row.kind == Kind::velocity || row.kind == Kind::acceleration;
  return motion && row.registers() == 2;
}

std::string_view float_unit(const RegisterRow& row) {
  if (row.kind == Kind::position) return "rev";
  return row.kind == Kind::velocity ? "rpm" : "rpm/s";
}

std::uint32_t float_bits(const RegisterRow& row, std::int64_t value, const Rational& units_per_rev) {
  if (value == no_value(row.type)) return kBinary32NaN;
  return to_binary32(value, per_float_unit(row, units_per_rev).inverse());
}

std::int64_t float_value(const RegisterRow& row, std::uint32_t bits, const Rational& units_per_rev) {
  if (is_nan_binary32(bits)) return no_value(row.type);
  const auto value = from_binary32(bits, per_float_unit(row, units_per_rev));
  return value && range_of(row.type).holds(*value) ? *value : kNoNumber;
}

}  // namespace axisgate
