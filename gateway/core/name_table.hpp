// SPDX-License-Identifier: Apache-2.0
// What the values of an enumeration are called: one table, read in both directions.
// Promises the name that stands beside a value, and says at compile time whether one is left out.
// Never allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace axisgate {

template <class Value>
struct Named {
  Value value;
  std::string_view name;
};

template <class Value, std::size_t N>
class NameTable {
 public:
  constexpr explicit NameTable(const std::array<Named<Value>, N>& rows) : rows_(rows) {}

  [[nodiscard]] constexpr std::string_view of(Value value, std::string_view otherwise = "?") const {
    const auto row = std::ranges::find(rows_, value, &Named<Value>::value);
    return row == rows_.end() ? otherwise : row->name;
  }
  [[nodiscard]] constexpr std::optional<Value> named(std::string_view name) const {
    const auto row = std::ranges::find(rows_, name, &Named<Value>::name);
    return row == rows_.end() ? std::nullopt : std::optional(row->value);
  }
  /// Of an enumeration that counts from 0 to `last`.
  [[nodiscard]] constexpr bool has_all_to(Value last) const {
    for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i)
      if (std::ranges::find(rows_, static_cast<Value>(i), &Named<Value>::value) == rows_.end()) return false;
    return true;
  }

 private:
  std::array<Named<Value>, N> rows_;
};

template <class Value, std::size_t N>
[[nodiscard]] constexpr NameTable<Value, N> names_of(const Named<Value> (&rows)[N]) {
  return NameTable<Value, N>(std::to_array(rows));
}

}  // namespace axisgate
