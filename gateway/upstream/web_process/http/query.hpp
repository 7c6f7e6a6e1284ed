// SPDX-License-Identifier: Apache-2.0
// What a request's target says: a path, decoded, and parameters by name.
// Promises that a parameter that nobody asked for is found, and that what is no number of a range is named with that
// range. Never touches a file: a path is a name to compare.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::web {

/// What is wrong with a parameter: the text names it, and says what it may be.
struct ParameterFault {
  std::string text;
};

class Query {
 public:
  /// @param written behind the '?'. Throws ParameterFault where it cannot be decoded or a name comes twice.
  explicit Query(std::string_view written);

  /// Not given: none.
  [[nodiscard]] std::optional<std::string> text(std::string_view name);
  /// Throws ParameterFault where it is no whole number from `least` to `most`.
  [[nodiscard]] std::optional<std::uint64_t> number(std::string_view name, std::uint64_t least, std::uint64_t most);
  /// Numbers with commas between, each once. Throws as number() does.
  [[nodiscard]] std::optional<std::set<std::uint64_t>> numbers(std::string_view name, std::uint64_t least,
                                                               std::uint64_t most);
  /// Throws ParameterFault where something was given that was not asked for by one of the above.
  void end() const;

 private:
  std::map<std::string, std::string, std::less<>> given_;
  std::vector<std::string> asked_;
};

/// "%20" and the like; none: no two hexadecimal digits behind a '%', or a byte 0. `plus`: '+' is a blank.
[[nodiscard]] std::optional<std::string> percent_decoded(std::string_view written, bool plus);
/// A whole number within bounds, in digits alone.
[[nodiscard]] std::optional<std::uint64_t> whole_number(std::string_view digits, std::uint64_t least,
                                                        std::uint64_t most);
/// The parts between the separators; at least one.
[[nodiscard]] std::vector<std::string_view> parts_of(std::string_view whole, char separator);

}  // namespace axisgate::web
