// SPDX-License-Identifier: Apache-2.0
// What of a configuration may leave the plant. Pure: text in, text out.
// Promises that comments, values of keys that no configuration has, the names of browsers' hosts and the files of
// DDS-Security are in nothing that is given away, and that a text that is no JSON is left out as a whole: what of it is
// a secret, nobody can tell. Keeps the plant's network addresses: without them nobody can help, and the log has them as
// well. Never changes what is given away to look like something else.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace axisgate::commands::support {

/// What stands where something was.
inline constexpr std::string_view kLeftOut = "(left out)";
/// So many places are named; of more, their number.
inline constexpr std::size_t kMostNamed = 50;

struct Redaction {
  std::string json;                     ///< without comments, keys in the order of the alphabet; empty: it is no JSON
  std::string why_none;                 ///< then: in words that hold nothing of the text
  std::vector<std::string> left_out{};  ///< places, as JSON pointers, each with the reason
  std::vector<std::string> words{};     ///< what was there: it must be nowhere else either; the longest first
};
[[nodiscard]] Redaction redact(std::string_view configuration);

/// A text that goes along, without what was taken out of the configuration, without users' names in paths of their
/// homes, and without what a message about wrong JSON shows of it.
[[nodiscard]] std::string scrubbed(std::string text, const Redaction& redaction);

}  // namespace axisgate::commands::support
