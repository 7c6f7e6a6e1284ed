// SPDX-License-Identifier: Apache-2.0
// The known word that a wrong one was probably meant to be: of commands, options, keys, values and names.
// Promises a word only where it is near enough that no other reading is likely. Pure. Never corrects anything.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

/// Longer words are none that somebody mistyped: nothing is near them, and nobody waits for the comparison.
inline constexpr std::size_t kLongestTypedWord = 128;

/// Of several that are equally near, the first.
[[nodiscard]] std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& known);

/// `; did you mean "enable"?`, or nothing: the end of a message about `word`.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace axisgate
