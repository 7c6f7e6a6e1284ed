// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/shown_words.hpp"

#include <fmt/format.h>

#include "gateway/core/words.hpp"

namespace axisgate {

std::string shown_mode(std::int16_t mode) {
  if (mode < 0) return fmt::format("own {}", mode);
  const Word* word = find_word(WordKind::mode, static_cast<std::uint32_t>(mode));
  return word == nullptr ? fmt::format("mode {}", mode) : std::string(word->name);
}

std::string shown_error(std::uint16_t code, std::uint32_t vendor, bool faulted) {
  constexpr std::uint16_t kNotKnown = 0xFFFF;
  const Word* word = find_error(code);
  if (code == kNotKnown) return faulted ? std::string(word->name) : "?";
  std::string shown = code == 0 ? "none" : fmt::format("0x{:04X}", code);
  if (word != nullptr) shown += fmt::format(" {}", word->name);
  return vendor == 0 ? shown : fmt::format("{} (0x{:X})", shown, vendor);
}

}  // namespace axisgate
