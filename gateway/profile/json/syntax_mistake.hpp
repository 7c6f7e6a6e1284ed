// SPDX-License-Identifier: Apache-2.0
// What is wrong with a text that is no JSON, in words for whoever wrote it: a comma too many or too few, single
// quotes, YAML. Pure.
// Promises the place of what to change, and what to write there; where nobody can tell, the parser's own words. Never
// mends a text: a guess could be another machine's configuration.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::profile {

/// How far the parser came, in bytes.
struct Reached {
  std::size_t read = 0;           ///< behind what it could not take
  std::size_t accepted = 0;       ///< behind the last key, value or bracket that it took
  std::vector<std::size_t> open;  ///< brackets that are not closed, the outermost first
};

struct SyntaxMistake {
  std::size_t at = 0;  ///< of the text, in bytes
  std::string words;
};
/// `what`: as nlohmann's parse_error says it. `reached.read` is at most the text's length.
[[nodiscard]] SyntaxMistake syntax_mistake(std::string_view text, const Reached& reached, std::string_view what);

/// "[json.exception...] parse error at line 1, column 2: syntax error while parsing value - what" -> "what".
[[nodiscard]] std::string parsers_words(std::string_view what);

}  // namespace axisgate::profile
