// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/words_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace axisgate::web {
namespace {

using WordJson = nlohmann::ordered_json;

WordJson word_json(const Word& word) {
  WordJson out;
  out["kind"] = title(word.kind);
  out["number"] = word.number;
  out["name"] = word.name;
  out["meaning"] = word.meaning;
  out["causes"] = word.causes;
  out["remedy"] = word.remedy;
  return out;
}

WordJson fault_word_json(const FaultWordRecord& row) {
  WordJson out;
  out["kind"] = "fault of " + row.profile;
  out["number"] = row.error_code;
  out["name"] = row.whole && row.value != row.error_code
                    ? fmt::format("0x{:04X} (its own code 0x{:X})", row.error_code, row.value)
                    : fmt::format("0x{:04X}", row.error_code);
  out["meaning"] = row.text;
  const Word* of_class = find_error(row.error_code);
  out["causes"] = of_class == nullptr ? "" : of_class->meaning;
  out["remedy"] = row.remedy;
  return out;
}

}  // namespace

WordJson alarms_json(WordKind kind, std::uint32_t bits, unsigned axis) {
  WordJson out = WordJson::array();
  constexpr unsigned kBits = 32;
  for (unsigned bit = 0; bit < kBits; ++bit) {
    if ((bits >> bit & 1U) == 0) continue;
    const Word* word = find_word(kind, bit);
    WordJson each;
    each["word"] = word == nullptr ? "bit " + std::to_string(bit) : std::string(word->name);
    each["meaning"] = word == nullptr ? std::string_view() : word->meaning;
    // Of the gateway's alarms some have a cause alone, which says where to look.
    each["remedy"] = word == nullptr        ? std::string()
                     : word->remedy.empty() ? std::string(word->causes)
                     : axis == 0            ? std::string(word->remedy)
                                            : remedy_for(*word, axis);
    out.push_back(std::move(each));
  }
  return out;
}

WordJson words_json() {
  WordJson out;
  out["words"] = WordJson::array();
  for (const Word& word : words()) out["words"].push_back(word_json(word));
  return out;
}

WordJson explain_json(const std::string& typed, const Picture& picture) {
  WordJson found = WordJson::array();
  for (const Word* word : look_up(typed)) found.push_back(word_json(*word));
  constexpr std::uint32_t kLargest = 0xFFFF, kSmallest = 0x1000;
  const auto code = typed_number(typed);
  if (found.empty() && code && *code >= kSmallest && *code <= kLargest)
    if (const Word* word = find_error(static_cast<std::uint16_t>(*code)); word != nullptr)
      found.push_back(word_json(*word));
  if (code && *code != 0)
    for (const FaultWordRecord& row : picture.fault_words())
      if (row.error_code == *code || (row.whole && row.value == *code)) found.push_back(fault_word_json(row));
  WordJson out;
  out["q"] = typed;
  out["found"] = std::move(found);
  return out;
}

}  // namespace axisgate::web
