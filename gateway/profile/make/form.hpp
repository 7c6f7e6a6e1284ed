// SPDX-License-Identifier: Apache-2.0
// A drive's table of registers or objects as a CSV: what a manual's table copies into. The columns are name, address,
// type, access, unit and range; a first line with these words gives their order. Comma, semicolon or tab between them.
// Promises every mistake with its line. Never guesses a type: of a register without one nobody knows its width.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/profile/eds/eds.hpp"

namespace axisgate::profile {

inline constexpr std::size_t kMaxFormBytes = std::size_t{1} << 20U;
inline constexpr std::size_t kMaxFormRows = 1000;

struct FormRow {
  std::size_t line = 0;
  std::string name;       ///< an object's: small letters, digits and '_'
  ObjectAddress address;  ///< canopen; modbus: the register is its index
  EdsWidth width;
  bool reads = true, writes = false;
  std::string unit;  ///< "0.1 rpm"; empty: a code
  std::optional<std::int64_t> low, high;
  [[nodiscard]] std::string type() const;  ///< "i32"
  [[nodiscard]] int registers() const { return width.size > 2 ? 2 : 1; }
};

struct Form {
  std::vector<FormRow> rows;     ///< in the order of their addresses
  std::vector<EdsFault> faults;  ///< empty: the table is good
};

enum class FormOf : std::uint8_t { modbus, canopen };
[[nodiscard]] Form parse_form(std::string_view csv, FormOf what);

/// "Actual Speed (rpm)" -> "actual_speed": the name of an object.
[[nodiscard]] std::string object_name(std::string_view text);

}  // namespace axisgate::profile
