// SPDX-License-Identifier: Apache-2.0
// The one table of words on the web: all of it, what somebody typed, and the alarms that are set.
// Promises the names, meanings and remedies that the log and the command line have. Never adds a word of its own.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gateway/core/words.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

/// [{word, meaning, remedy}] of the bits that are set. @param axis whose they are; 0: the gateway's
[[nodiscard]] nlohmann::ordered_json alarms_json(WordKind kind, std::uint32_t bits, unsigned axis);
/// {words: [...]}
[[nodiscard]] nlohmann::ordered_json words_json();
/// {q, found: [...]}: as `axisgate explain` finds it, and the fault codes of the drives of this gateway.
[[nodiscard]] nlohmann::ordered_json explain_json(const std::string& typed, const Picture& picture);

}  // namespace axisgate::web
