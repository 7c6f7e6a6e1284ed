// SPDX-License-Identifier: Apache-2.0
// A profile's JSON as a person would have written it: the order of keys that schemas/README.md explains them in, and
// what fits on one line on one line. And what one profile says differently from another.
// Promises that the text read again is the same document, and that a difference laid over its base is the other one.
// Never looks at what a profile means.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace axisgate::profile {

/// Ends with a line end. Bytes that are no UTF-8 are taken for Latin-1.
[[nodiscard]] std::string profile_text(const nlohmann::json& document);

/// What a profile that extends `base` has to say to be `wanted`: objects key by key, all else as a whole, null for what
/// `wanted` does not have.
[[nodiscard]] nlohmann::json difference(const nlohmann::json& base, const nlohmann::json& wanted);

/// As UTF-8, without control characters and blanks around it, at most `most` bytes: for titles from a file of anybody.
[[nodiscard]] std::string plain_text(std::string_view text, std::size_t most = 120);

/// "maxon motor / EPOS4 70/15" -> "maxon-motor-epos4-70-15": a profile's name; "drive" where nothing is left.
[[nodiscard]] std::string profile_name(std::string_view text);

}  // namespace axisgate::profile
