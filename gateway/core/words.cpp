// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace axisgate {
namespace {

using enum WordKind;

/// As people type it: small letters, and one blank for any of "_-".
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += c == '_' || c == '-' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// ", detail 0x06010002 read only"; of a state that was not reached ", step 3"; empty: there is none.
std::string detail_text(const Outcome& outcome) {
  if (outcome.code == Errc::not_reached) return fmt::format(", step {}", outcome.detail);
  if (outcome.detail == 0) return {};
  const Word* word = find_word(abort_code, outcome.detail);
  return fmt::format(", detail 0x{:08X}{}{}", outcome.detail, word == nullptr ? "" : " ",
                     word == nullptr ? "" : word->name);
}

std::string result_text(std::uint32_t number) { return fmt::format("result {} {}", number, name_of(result, number)); }

}  // namespace

std::string modbus_text(const Outcome& outcome) {
  const auto exception_number = static_cast<std::uint32_t>(modbus_exception(outcome.code));
  const auto result_number = static_cast<std::uint32_t>(command_result(outcome.code));
  std::string out(text(outcome.code));
  if (exception_number == 0) return out;
  out += fmt::format(" (exception 0x{:02X} {}", exception_number, name_of(exception, exception_number));
  if (result_number != 0) out += ", " + result_text(result_number);
  return out + detail_text(outcome) + ")";
}

std::string dds_text(const Outcome& outcome) {
  return fmt::format("{} ({}{})", text(outcome.code), result_text(dds_result(outcome.code)), detail_text(outcome));
}

const Word* find_word(WordKind kind, std::uint32_t number) {
  const auto found = std::ranges::find_if(words(), [&](const Word& w) { return w.kind == kind && w.number == number; });
  return found == words().end() ? nullptr : &*found;
}

const Word* find_error(std::uint16_t code) {
  for (const std::uint32_t mask : {0xFFFFU, 0xFF00U, 0xF000U})
    if (const Word* word = find_word(error_code, code & mask); word != nullptr) return word;
  return nullptr;
}

std::string_view name_of(WordKind kind, std::uint32_t number) {
  const Word* word = find_word(kind, number);
  return word == nullptr ? "?" : word->name;
}

std::string names_of_bits(WordKind kind, std::uint32_t bits) {
  std::string out;
  constexpr unsigned kBits = 32;
  for (unsigned bit = 0; bit < kBits; ++bit) {
    if ((bits >> bit & 1U) == 0) continue;
    const Word* word = find_word(kind, bit);
    if (!out.empty()) out += ", ";
    out += word == nullptr ? "bit " + std::to_string(bit) : std::string(word->name);
  }
  return out;
}

std::string list_of(WordKind kind) {
  std::string out;
  for (const Word& word : words()) {
    if (word.kind != kind || (kind == result && word.number >= kFirstResultOfDds)) continue;
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", number_text(word), word.name);
  }
  return kind == axis_alarm || kind == gateway_alarm ? "bit " + out : out;
}

std::string number_text(const Word& word) {
  if (word.kind == abort_code) return fmt::format("0x{:08X}", word.number);
  if (word.kind == block_error) return fmt::format("16#{:04X}", word.number);
  if (word.kind == term) return {};
  return word.kind == error_code ? fmt::format("0x{:04X}", word.number) : fmt::format("{}", word.number);
}

std::string remedy_for(const Word& word, unsigned axis) {
  std::string remedy(word.remedy);
  constexpr std::string_view kAxis = "CONFIG AXIS";
  if (const std::size_t at = remedy.find(kAxis); at != std::string::npos)
    remedy.replace(at, kAxis.size(), "CONFIG " + std::to_string(axis));
  return remedy;
}

std::string against_enable(std::uint32_t axis_alarms, unsigned axis) {
  std::string out;
  for (const Word& word : words()) {
    if (word.kind != axis_alarm || !word.refuses_enable || (axis_alarms >> word.number & 1U) == 0) continue;
    out += (out.empty() ? "" : "; ") + ("alarm " + std::string(word.name)) + ": " + std::string(word.meaning) + "; " +
           remedy_for(word, axis);
  }
  return out;
}

std::string_view axis_state_text(std::uint32_t state, bool latched_and_stands) {
  constexpr std::uint32_t kStopping = 5;
  return state == kStopping && latched_and_stands ? "latched" : name_of(axis_state, state);
}

std::string_view title(WordKind kind) {
  static constexpr std::array<std::string_view, kWordKinds> kTitles{
      "axis state", "motion state", "link state", "mode",       "axis alarm", "gateway state", "gateway alarm",
      "result",     "exception",    "abort code", "error code", "ErrorID",    "term"};
  return kTitles[static_cast<std::size_t>(kind)];
}

std::string_view place(WordKind kind) {
  static constexpr std::array<std::string_view, kWordKinds> kPlaces{"register 31 of the axis",
                                                                    "register 32 of the axis",
                                                                    "register 18 of the axis",
                                                                    "registers 1 and 41 of the axis",
                                                                    "bits of registers 34 and 35 of the axis",
                                                                    "register 2 of the gateway block",
                                                                    "bits of register 6 of the gateway block",
                                                                    "register 25 of the axis, `result` of DDS replies",
                                                                    "the answer to a Modbus request",
                                                                    "registers 26 and 27 of the axis after result 3",
                                                                    "register 10 of the axis",
                                                                    "output of the blocks for PLCs",
                                                                    ""};
  return kPlaces[static_cast<std::size_t>(kind)];
}

std::optional<std::uint32_t> typed_number(std::string_view typed) {
  const bool iec = typed.starts_with("16#");
  const bool hex = iec || typed.starts_with("0x") || typed.starts_with("0X");
  if (hex) typed.remove_prefix(iec ? 3 : 2);
  constexpr int kHex = 16, kDecimal = 10;
  std::uint32_t number = 0;
  const char* const last = typed.data() + typed.size();
  const auto [end, error] = std::from_chars(typed.data(), last, number, hex ? kHex : kDecimal);
  if (error != std::errc() || end != last) return std::nullopt;
  return number;
}

std::vector<const Word*> look_up(std::string_view typed) {
  std::vector<const Word*> out;
  const auto take = [&](const auto& which) {
    for (const Word& word : words())
      if (which(word)) out.push_back(&word);
  };
  if (const auto number = typed_number(typed)) {
    take([&](const Word& word) { return word.number == *number && word.kind != term; });
    return out;
  }
  const std::string wanted = plain(typed);
  const std::size_t blank = wanted.rfind(' ');
  const auto number = blank == std::string::npos ? std::nullopt : typed_number(wanted.substr(blank + 1));
  // "alarm 7" is of the axes and of the gateway.
  if (number)
    take([&](const Word& word) {
      return word.number == *number && word.kind != term &&
             plain(title(word.kind)).find(wanted.substr(0, blank)) != std::string::npos;
    });
  if (!out.empty()) return out;
  const Word* const latched = wanted == "latched" ? find_word(axis_state, 5) : nullptr;
  if (latched != nullptr) out.push_back(latched);
  take([&](const Word& word) { return plain(word.name) == wanted; });
  if (latched != nullptr) out.push_back(find_word(axis_alarm, 7));
  if (out.empty() && !wanted.empty())
    take([&](const Word& word) { return plain(word.name).find(wanted) != std::string::npos; });
  return out;
}

std::string troubleshooting_page() {
  std::string out = R"(# Troubleshooting

What axisgate shows, what it means, what usually causes it and what to do. `axisgate explain` prints the same for one word or
number, and for the fault codes of the drives: `axisgate explain stop_latched`, `axisgate explain result 9`,
`axisgate explain 0x3130`. This page is made from the table that the program itself uses.

Words such as *lease*, *latch* or *owed* are in the [glossary](glossary.md). What the blocks for PLCs put into ErrorID is at the end.

What happened just before a fault, a lost link or a stop that nobody asked for: the page has it as a capture, with nothing armed (docs/web.md,
"Captures").

Where somebody else helps: `axisgate support /etc/axisgate/gateway.json`, as root, writes one archive for them with the configuration, what *check*
says of it, the log, the unit's state, devices, versions, and what a running gateway and its page show. It lists what is in it before it writes it,
and what was taken out: comments, values of unknown keys, names of browsers' hosts, files of DDS-Security. It sends nothing anywhere.
)";
  const auto cell = [](std::string_view text) { return " " + std::string(text) + " |"; };
  for (int k = 0; k < kWordKinds; ++k) {
    const auto kind = static_cast<WordKind>(k);
    if (kind == term) continue;  // they have a page of their own
    out += "\n## " + std::string(title(kind)) + ": " + std::string(place(kind)) +
           "\n\n| number | name | meaning | usual causes | remedy |\n|---|---|---|---|---|\n";
    for (const Word& word : words()) {
      if (word.kind != kind) continue;
      out += "|" + cell(number_text(word)) + cell(word.name) + cell(word.meaning) + cell(word.causes) +
             cell(word.remedy) + "\n";
    }
  }
  return out;
}

std::string glossary_page() {
  std::string out = R"(# Glossary

The words that one must know before the first enable. `axisgate explain latch` prints the same, for each of them; this page is made from
the table that the program itself uses. Registers are those of an axis, counted from 0, so that register 28 of axis 1 is at 128
([register map](../schemas/register-map.md)); alarms, results and exceptions are in [troubleshooting.md](troubleshooting.md).
)";
  for (const Word& word : words())
    if (word.kind == term)
      out += fmt::format("\n## {0}\n\n*{0}* is {1}.\n\n- **What is seen of it**: {2}.\n- **What to do**: {3}.\n",
                         word.name, word.meaning, word.causes, word.remedy);
  return out;
}

}  // namespace axisgate
