// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/eds/eds_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/locale/encoding_utf.hpp>
#include <charconv>

#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::profile {
namespace {

constexpr std::size_t kMaxLine = 4096;  // CiA 306 allows 255

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

/// UTF-16 by its mark, or by the zero beside the first character; anything else is left as it is.
std::optional<std::string> from_utf16(std::string_view text) {
  if (!is_utf16(text)) return std::nullopt;
  const bool low_first = text[0] == '\xFF' || text[1] == '\0';
  std::u16string units;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    const auto first = static_cast<unsigned char>(text[i]), second = static_cast<unsigned char>(text[i + 1]);
    units += static_cast<char16_t>(low_first ? second << 8U | first : first << 8U | second);
  }
  return boost::locale::conv::utf_to_utf<char>(units);
}

/// "0x6041" -> "6041": some write the index of a section as a number.
std::string_view without_prefix(std::string_view name) {
  constexpr std::size_t kIndex = 4;
  const bool prefixed = name.starts_with("0x") && name.size() >= kIndex + 2 && eds_digits(name.substr(2, kIndex), 16);
  return prefixed ? name.substr(2) : name;
}

/// Takes one line after the other.
class Reader {
 public:
  explicit Reader(Eds& out) : out_(out) {}

  void read(std::string_view text) {
    std::size_t line = 0;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      take(trimmed(text.substr(0, end)), ++line);
      text.remove_prefix(end);
      if (text.starts_with("\r\n")) text.remove_prefix(1);
      if (!text.empty()) text.remove_prefix(1);
    }
  }

  EdsSections sections;

 private:
  void take(std::string_view line, std::size_t number) {
    if (line.empty() || line.front() == ';' || line.front() == '#') return;
    if (line.starts_with("//")) return out_.remark(number, "\"" + eds_shown(line) + "\" is taken for a comment");
    if (line.size() > kMaxLine) {
      out_.remark(number, fmt::format("is longer than {} characters: its beginning is taken", kMaxLine));
      line = line.substr(0, kMaxLine);
    }
    if (line.find('\0') != std::string_view::npos) return out_.remark(number, "has bytes that are no text: left out");
    if (line.front() == '[') return open(line, number);
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos)
      return out_.remark(number, "\"" + eds_shown(line) + "\" is neither [section] nor key=value: left out");
    if (current_ == nullptr)
      return out_.remark(number, "\"" + eds_shown(line) + "\" stands before the first [section]: left out");
    put(eds_lower(trimmed(line.substr(0, equals))), std::string(trimmed(line.substr(equals + 1))), number);
  }

  void put(const std::string& key, std::string text, std::size_t number) {
    const auto at = current_->keys.find(key);
    if (at == current_->keys.end()) {
      current_->keys.emplace(key, EdsValue{std::move(text), number, ""});
      return;
    }
    EdsValue& known = at->second;
    if (eds_lower(eds_bare(text)) != eds_lower(eds_bare(known.text))) known.other = std::move(text);
    out_.remark(number, fmt::format("key {} is given twice in [{}]: that of line {} is taken", eds_shown(key),
                                    eds_shown(current_->name), known.line));
  }

  void open(std::string_view line, std::size_t number) {
    const std::size_t end = std::min(line.find(']'), line.size());
    if (end == line.size()) out_.remark(number, "\"" + eds_shown(line) + "\" is a section without its ]");
    const std::string_view name = trimmed(line.substr(1, end - 1));
    const std::string lowered = eds_lower(name);
    const std::string key(without_prefix(lowered));
    if (key != lowered) out_.remark(number, fmt::format("[{}] is taken for [{}]", eds_shown(name), key));
    const auto [at, first] = sections.emplace(key, EdsSection{std::string(name), number, {}});
    if (!first)
      out_.remark(number, fmt::format("section [{}] is there already, in line {}: both are taken together",
                                      eds_shown(name), at->second.line));
    current_ = &at->second;
  }

  Eds& out_;
  EdsSection* current_ = nullptr;
};

}  // namespace

void Eds::remark(std::size_t line, std::string message) {
  ++remarks_in_all;
  if (remarks.size() < kMaxEdsRemarks) remarks.push_back({line, std::move(message)});
}

EdsSections eds_sections(std::string_view text, Eds& out) {
  Reader reader(out);
  const std::optional<std::string> converted = from_utf16(text);
  if (converted) {
    out.remark(0, "is UTF-16");
    text = *converted;
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  reader.read(text);
  return std::move(reader.sections);
}

std::optional<std::int64_t> eds_digits(std::string_view text, int base) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size() || value > INT64_MAX) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

std::optional<EdsNumber> eds_number(std::string_view text) {
  EdsNumber out;
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.front() == text.back()) {
    text = trimmed(text.substr(1, text.size() - 2));
    out.odd = true;
  }
  const bool negative = text.starts_with('-');
  out.odd = out.odd || text.starts_with('+');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  std::optional<std::int64_t> value;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    value = eds_digits(text.substr(2), 16);
  } else if (text.ends_with('h') || text.ends_with('H')) {
    value = eds_digits(text.substr(0, text.size() - 1), 16);
    out.odd = true;
  } else {
    const bool octal = text.size() > 1 && text.front() == '0';
    if (octal) value = eds_digits(text, 8);
    out.odd = out.odd || (octal && !value);  // 08
    if (!value) value = eds_digits(text, 10);
  }
  if (!value) return std::nullopt;
  out.value = negative ? -*value : *value;
  return out;
}

std::string eds_shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out;
  for (const char c : text.substr(0, kMost)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > kMost ? out + "..." : out;
}

std::string eds_lower(std::string_view text) { return boost::to_lower_copy(std::string(text)); }

std::string_view eds_bare(std::string_view text) {
  text = text.substr(0, text.find(';'));
  return trimmed(text.substr(0, text.find("//")));
}

}  // namespace axisgate::profile
