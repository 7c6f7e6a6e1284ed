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
  return fmt::format("{} ({} {}: {})\n", word.name, title(word.kind), number_text(word), place(word.kind)) +
         line("meaning", word.meaning) + line("causes", word.causes) + line("remedy", word.remedy) +
         line("enable", word.refuses_enable ? "is refused while it is set" : "");
}

std::string told(const profile::Profile& profile, const model::AlarmRow& alarm) {
  std::string out = fmt::format("0x{:04X} ({}", alarm.code, profile.title);
  if (alarm.value && *alarm.value != alarm.code) out += fmt::format(", its own code 0x{:X}", *alarm.value);
  return out + ", error_code)\n" + line("meaning", alarm.text) + line("remedy", alarm.remedy);
}

std::string refused_row(std::uint32_t code) {
  if (code < kRefusedRow || code > kRefusedRowLast) return "";
  const auto offset = static_cast<std::uint16_t>(code - kRefusedRow);
  const RegisterRow* row = register_table(Block::axis).covering(offset);
  return fmt::format("0x{:08X} (command_detail with result 0)\n", code) +
         line("meaning", fmt::format("a block write was refused; the first row refused is {} of the axis{}", offset,
                                     row == nullptr ? ": there is no such row" : ", " + std::string(row->name))) +
         line("remedy", "axisgate map CONFIG prints the rows that this axis has, and their limits");
}

std::string all_there_is() {
  std::string out;
  for (const Word& word : words())
    out += fmt::format("{:<14} {:>10}  {:<24}  {}\n", title(word.kind), number_text(word), word.name, word.meaning);
  return out;
}

}  // namespace

std::string explanation(const std::string& typed, const std::vector<std::string>& profile_folders) {
  std::string out;
  for (const Word* word : look_up(typed)) out += told(*word);
  const auto code = typed_number(typed);
  if (!code) return out;
  out += refused_row(*code);
  constexpr std::uint32_t kLargest = 0xFFFF, kSmallest = 0x1000;
  if (out.empty() && *code >= kSmallest && *code <= kLargest)
    if (const Word* word = find_error(static_cast<std::uint16_t>(*code)); word != nullptr)
      out += fmt::format("0x{:04X} is of the class\n", *code) + told(*word);
  if (*code == 0) return out;
  for (const profile::Profile& profile : profiles_in(profile_folders))
    for (const model::AlarmRow& alarm : profile.alarms)
      if (alarm.code == *code || alarm.value == *code) out += told(profile, alarm);
  return out;
}

int run(const ExplainOptions& options) {
  if (options.page || options.words.empty()) {
    fmt::print("{}", options.page ? troubleshooting_page() : all_there_is());
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
