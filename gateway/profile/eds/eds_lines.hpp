// SPDX-License-Identifier: Apache-2.0
// The lines of an EDS or DCF, put into sections: whatever the encoding, the line ends and the odd lines.
// Promises every section and key that can be made out, and a remark with its line for each oddity and what was taken.
// Never knows what a section means.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/profile/eds/eds.hpp"

namespace axisgate::profile {

struct EdsValue {
  std::string text;
  std::size_t line = 0;
  std::string other;  ///< a further line says this of the same key; empty: none says anything else
};

struct EdsSection {
  std::string name;  ///< as written
  std::size_t line = 0;
  std::map<std::string, EdsValue> keys;  ///< in small letters
};

/// By name in small letters; "[0x6041]" is "6041".
using EdsSections = std::map<std::string, EdsSection>;
[[nodiscard]] EdsSections eds_sections(std::string_view text, Eds& out);

/// A number as people write them: "47", "0x2F", "057", "-1", and with a remark "2Fh", "\"47\"", "08", "+47".
struct EdsNumber {
  std::int64_t value = 0;
  bool odd = false;
};
[[nodiscard]] std::optional<EdsNumber> eds_number(std::string_view text);

/// What may be printed in a message: a damaged file's bytes would spoil a terminal.
[[nodiscard]] std::string eds_shown(std::string_view text);
[[nodiscard]] std::string eds_lower(std::string_view text);
/// Without blanks around it, and without the "; comment" or "// comment" behind it.
[[nodiscard]] std::string_view eds_bare(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> eds_digits(std::string_view text, int base);

}  // namespace axisgate::profile
