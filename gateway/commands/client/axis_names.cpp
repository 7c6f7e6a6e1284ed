// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/client/axis_names.hpp"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "gateway/core/nearest.hpp"

namespace axisgate::commands {
namespace {

constexpr std::string_view kUnnamed = "axis ";  // "axis 3": what one is called that has no name of its own

std::optional<unsigned> digits_in(std::string_view text) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// The number that a name seems to say: "2", "axis 2".
std::optional<AxisNumber> number_said(std::string_view name) {
  return axis_number_in(name.starts_with(kUnnamed) ? name.substr(kUnnamed.size()) : name);
}

std::string listed(const AxisNames& names) {
  constexpr std::size_t kMost = 12;
  std::string out;
  std::size_t count = 0;
  for (const auto& [number, name] : names) {
    if (count++ == kMost) return out + ", ...";
    out += fmt::format("{}{} \"{}\"", out.empty() ? "" : ", ", number, name);
  }
  return out;
}

std::string name_in(const AxisNames& names, AxisNumber number) {
  const auto found = names.find(number);
  return found == names.end() ? "no axis of this number" : fmt::format("\"{}\"", found->second);
}

std::vector<AxisNumber> called(const AxisNames& names, const std::string& name) {
  std::vector<AxisNumber> out;
  for (const auto& [number, each] : names)
    if (each == name) out.push_back(number);
  return out;
}

std::string unknown(const std::string& typed, const AxisNames& reported) {
  std::vector<std::string> known;
  for (const auto& [number, name] : reported) known.push_back(name);
  return fmt::format("no axis of this gateway is called '{}'{} it has {}", typed,
                     nearest(typed, known) ? did_you_mean(typed, known) : ";", listed(reported));
}

}  // namespace

std::optional<AxisNumber> axis_number_in(std::string_view typed) {
  const auto number = digits_in(typed);
  if (!number || *number == 0 || *number > kMaxAxisNumber) return std::nullopt;
  return static_cast<AxisNumber>(*number);
}

std::string axis_mistake(const std::string& typed) {
  const std::size_t sign = typed.starts_with('-') ? 1 : 0;
  const bool digits = typed.find_first_not_of("0123456789", sign) == std::string::npos;
  if (digits && !axis_number_in(typed))
    return fmt::format("AXIS: '{}' is no axis: write its number, 1 to {}, or its name", typed, kMaxAxisNumber);
  return {};
}

void add_names(AxisNames& names, std::string_view object) {
  while (!object.empty()) {
    const std::size_t end = object.find('\n');
    const std::string_view line = object.substr(0, end);
    const std::size_t blank = line.find(' ');
    const auto number = blank == std::string_view::npos ? std::nullopt : axis_number_in(line.substr(0, blank));
    if (number) names[*number] = line.substr(blank + 1);
    object.remove_prefix(end == std::string_view::npos ? object.size() : end + 1);
  }
}

std::variant<AxisNumber, std::string> axis_meant(const std::string& typed, const AxisNames& reported,
                                                 const ConfiguredNames* configured) {
  if (reported.empty())
    return "this gateway does not tell what its axes are called: write HOST:PORT and the number of the axis";
  const std::vector<AxisNumber> named = called(reported, typed);
  const std::optional<AxisNumber> said = number_said(typed);
  if (named.size() > 1)
    return fmt::format("axes {} and {} are both called '{}': write HOST:PORT and the number of the axis", named[0],
                       named[1], typed);
  if (!named.empty() && said && named[0] != *said)
    return fmt::format(
        "'{}' could be axis {}, which is called so, or axis {}: write HOST:PORT and the number of the axis", typed,
        named[0], *said);
  const std::optional<AxisNumber> number = named.empty() ? axis_number_in(typed) : std::optional(named[0]);
  if (!number || !reported.contains(*number)) return unknown(typed, reported);
  if (configured == nullptr) return *number;
  const auto& here = configured->names;
  const auto same = here.find(*number);
  if (same == here.end() || same->second != reported.at(*number))
    return fmt::format(
        "axis {} of the running gateway is {}, and in {} {}: which is meant? axisgate reload it, or write HOST:PORT "
        "and "
        "the number of the axis",
        *number, name_in(reported, *number), configured->file, name_in(here, *number));
  return *number;
}

}  // namespace axisgate::commands
