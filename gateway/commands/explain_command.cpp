// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "gateway/commands/common/profile_folders.hpp"
#include "gateway/core/nearest.hpp"
#include "gateway/core/words.hpp"
#include "gateway/image/register_map.hpp"
#include "gateway/upstream/modbus_tcp/write/refused_blocks.hpp"

namespace axisgate::commands {
namespace {

constexpr std::uint32_t kRefusedRow = modbus_tcp::kDetailRow, kRefusedRowLast = kRefusedRow + 0xFF;

std::string line(std::string_view what, std::string_view text) {
  return text.empty() ? std::string() : fmt::format("  {:<9}{}\n", std::string(what) + ":", text);
}

std::string told(const Word& word) {
  if (word.kind == WordKind::term)
    return fmt::format("{} (docs/glossary.md)\n", word.name) + line("meaning", word.meaning) +
           line("seen", word.causes) + line("to do", word.remedy);
  return fmt::format("{} ({} {}: {})\n", word.name, title(word.kind), number_text(word), place(word.kind)) +
         line("meaning", word.meaning) + line("causes", word.causes) + line("remedy", word.remedy) +
         line("enable", word.refuses_enable ? "is refused while it is set" : "");
}

/// By the number that was typed: to type it is no remedy, the texts of each drive are below.
std::string told_by_code(Word word) {
  if (word.kind == WordKind::error_code && word.remedy.starts_with("axisgate explain")) word.remedy = {};
  return told(word);
}

std::string told(const profile::Profile& profile, const model::AlarmRow& alarm) {
  std::string out = fmt::format("0x{:04X} ({}", alarm.code, profile.title);
  if (alarm.value && *alarm.value != alarm.code) out += fmt::format(", its own code 0x{:X}", *alarm.value);
  return out + ", error_code)\n" + line("meaning", alarm.text) + line("remedy", alarm.remedy);
}

std::string first_row_refused(std::uint32_t offset) {
  const RegisterRow* row = register_table(Block::axis).covering(static_cast<std::uint16_t>(offset));
  return line("meaning", fmt::format("a block write was refused; the first row refused is {} of the axis{}", offset,
                                     row == nullptr ? ": there is no such row" : ", " + std::string(row->name)));
}

std::string refused_row(std::uint32_t code) {
  if (code < kRefusedRow || code > kRefusedRowLast) return "";
  return fmt::format("0x{:08X} (command_detail with result 0)\n", code) + first_row_refused(code - kRefusedRow) +
         line("remedy", "axisgate map CONFIG prints the rows that this axis has, and their limits");
}

/// Of a block for PLCs, where the table has no word of its own for it: a row, or a result.
std::string error_of_block(std::uint32_t code, bool is_error_id) {
  if (code > kRefusedRowError && code <= kRefusedRowErrorLast) {
    const Word* word = find_word(WordKind::block_error, kRefusedRowError);
    return fmt::format("16#{:04X} (ErrorID: {})\n", code, word->name) + first_row_refused(code - kRefusedRowError) +
           line("causes", word->causes) + line("remedy", word->remedy);
  }
  const Word* result = is_error_id && code < kFirstResultOfDds ? find_word(WordKind::result, code) : nullptr;
  return result == nullptr ? "" : fmt::format("16#{:04X} (ErrorID: the result in register 25)\n", code) + told(*result);
}

std::string all_there_is() {
  std::string out;
  for (const Word& word : words())
    out += fmt::format("{:<14} {:>10}  {:<24}  {}\n", title(word.kind), number_text(word), word.name, word.meaning);
  return out;
}

}  // namespace

std::string explanation(const std::string& typed, const std::vector<std::string>& profile_folders) {
  if (constexpr std::string_view kErrorId = "ErrorID "; typed.starts_with(kErrorId))
    return explanation(typed.substr(kErrorId.size()), profile_folders);
  const auto code = typed_number(typed);
  if (code) {
    // As a controller shows it, 16#0009 is the ErrorID of a block, and no bit of an alarm.
    const std::string error = error_of_block(*code, typed.starts_with("16#"));
    if (!error.empty()) return error;
  }
  std::string out;
  for (const Word* word : look_up(typed)) out += code ? told_by_code(*word) : told(*word);
  if (!code) return out;
  out += refused_row(*code);
  constexpr std::uint32_t kLargest = 0xFFFF, kSmallest = 0x1000;
  if (out.empty() && *code >= kSmallest && *code <= kLargest)
    if (const Word* word = find_error(static_cast<std::uint16_t>(*code)); word != nullptr)
      out += fmt::format("0x{:04X} is of the class\n", *code) + told_by_code(*word);
  if (*code == 0) return out;
  for (const profile::Profile& profile : profiles_in(profile_folders))
    for (const model::AlarmRow& alarm : profile.alarms)
      if (alarm.code == *code || alarm.value == *code) out += told(profile, alarm);
  return out;
}

int run(const ExplainOptions& options) {
  if (options.page || options.glossary || options.words.empty()) {
    fmt::print("{}", options.page ? troubleshooting_page() : options.glossary ? glossary_page() : all_there_is());
    return 0;
  }
  const std::string typed = fmt::format("{}", fmt::join(options.words, " "));
  const std::string out = explanation(typed, options.profile_folders);
  fmt::print("{}", out);
  if (!out.empty()) return 0;
  std::vector<std::string> names;
  for (const Word& word : words()) names.emplace_back(word.name);
  const auto near = nearest(typed, names);
  fmt::print(stderr, "axisgate explain: nothing is called '{}'{} axisgate explain, without a word, lists all names\n",
             typed, near ? did_you_mean(typed, names) : ";");
  return 1;
}

}  // namespace axisgate::commands
