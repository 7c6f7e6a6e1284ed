// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/http/query.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace axisgate::web {

std::optional<std::string> percent_decoded(std::string_view written, bool plus) {
  std::string out;
  for (std::size_t i = 0; i < written.size(); ++i) {
    char c = written[i];
    if (c == '+' && plus) c = ' ';
    if (c == '%') {
      constexpr int kHex = 16;
      constexpr std::size_t kDigits = 2;
      unsigned byte = 0;
      const std::string_view digits = written.substr(i + 1, kDigits);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, kHex);
      if (digits.size() != kDigits || error != std::errc() || end != digits.data() + kDigits) return std::nullopt;
      c = static_cast<char>(byte);
      i += kDigits;
    }
    if (c == '\0') return std::nullopt;
    out += c;
  }
  return out;
}

std::optional<std::uint64_t> whole_number(std::string_view digits, std::uint64_t least, std::uint64_t most) {
  std::uint64_t number = 0;
  const char* const last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, number);
  if (error != std::errc() || end != last || number < least || number > most) return std::nullopt;
  return number;
}

std::vector<std::string_view> parts_of(std::string_view whole, char separator) {
  std::vector<std::string_view> out;
  for (;;) {
    const std::size_t at = whole.find(separator);
    out.push_back(whole.substr(0, at));
    if (at == std::string_view::npos) return out;
    whole = whole.substr(at + 1);
  }
}

Query::Query(std::string_view written) {
  if (written.empty()) return;
  for (const std::string_view part : parts_of(written, '&')) {
    const std::size_t equals = part.find('=');
    const auto name = percent_decoded(part.substr(0, equals), true);
    const auto value =
        percent_decoded(equals == std::string_view::npos ? std::string_view() : part.substr(equals + 1), true);
    if (!name || !value) throw ParameterFault{"parameters: behind each % stand two hexadecimal digits, not 00"};
    if (!given_.emplace(*name, *value).second) throw ParameterFault{fmt::format("{}: given twice", *name)};
  }
}

std::optional<std::string> Query::text(std::string_view name) {
  asked_.emplace_back(name);
  const auto found = given_.find(name);
  return found == given_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::uint64_t> Query::number(std::string_view name, std::uint64_t least, std::uint64_t most) {
  const auto given = text(name);
  if (!given) return std::nullopt;
  const auto number = whole_number(*given, least, most);
  if (!number)
    throw ParameterFault{fmt::format("{}: '{}' is no whole number from {} to {}", name, *given, least, most)};
  return number;
}

std::optional<std::set<std::uint64_t>> Query::numbers(std::string_view name, std::uint64_t least, std::uint64_t most) {
  const auto given = text(name);
  if (!given) return std::nullopt;
  std::set<std::uint64_t> out;
  for (const std::string_view part : parts_of(*given, ',')) {
    const auto number = whole_number(part, least, most);
    if (!number)
      throw ParameterFault{fmt::format("{}: '{}' is no whole number from {} to {}; several have commas between", name,
                                       part, least, most)};
    out.insert(*number);
  }
  return out;
}

void Query::end() const {
  for (const auto& [name, value] : given_)
    if (std::ranges::find(asked_, name) == asked_.end())
      throw ParameterFault{
          asked_.empty() ? fmt::format("{}: there are no parameters here", name)
                         : fmt::format("{}: there is no such parameter; there are: {}", name, fmt::join(asked_, ", "))};
}

}  // namespace axisgate::web
