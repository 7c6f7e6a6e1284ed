// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/spec_words.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace axisgate::simulated {

void refuse_spec(std::string_view what, std::string_view wrong, std::string_view right) {
  throw std::invalid_argument(std::string(what) + " '" + std::string(wrong) + "': " + std::string(right));
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(at, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

namespace {

std::pair<std::int64_t, std::int64_t> range(std::string_view word, std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots != std::string_view::npos) {
    const auto from = whole_number(text.substr(0, dots));
    const auto to = whole_number(text.substr(dots + 2));
    if (from && to && *from < *to) return {*from, *to};
  }
  refuse_spec("places", word, "write counts as FROM..TO, for example +home=10000..12000");
}

}  // namespace

bool modify_mechanics(Mechanics& mechanics, std::string_view word) {
  if (word.starts_with("home=")) {
    const auto [from, to] = range(word, word.substr(5));
    mechanics.home_from = from;
    mechanics.home_to = to;
    return true;
  }
  if (word.starts_with("limits=")) {
    const auto [from, to] = range(word, word.substr(7));
    mechanics.negative_limit = from;
    mechanics.positive_limit = to;
    return true;
  }
  return false;
}

std::optional<ObjectKey> object_named(std::string_view text) {
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos) return std::nullopt;
  const auto hex = [](std::string_view digits, unsigned highest) -> std::optional<unsigned> {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc() || end != digits.data() + digits.size() || value > highest) return std::nullopt;
    return value;
  };
  const auto index = hex(text.substr(0, point), 0xFFFF);
  const auto sub = hex(text.substr(point + 1), 0xFF);
  if (!index || !sub) return std::nullopt;
  return ObjectKey{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

Typed typed(std::string_view text, const std::vector<std::string_view>& types, std::string_view names,
            std::int64_t highest) {
  auto words = split(text, '+');
  const std::size_t at = words.front().find('@');
  const std::string_view type = words.front().substr(0, at);
  if (std::ranges::count(types, type) == 0) {
    refuse_spec("drive", text, "write TYPE@STATION with type " + std::string(names) + ", for example jd@1");
  }
  const auto station = at == std::string_view::npos ? std::nullopt : whole_number(words.front().substr(at + 1));
  if (!station || *station < 1 || *station > highest) {
    refuse_spec("drive", text, "the station is a number from 1 to " + std::to_string(highest));
  }
  words.erase(words.begin());
  return {type, static_cast<std::uint8_t>(*station), std::move(words)};
}

DriveOptions parse_kinco(const Typed& it, DriveOptions drive) {
  drive.type = it.type == "jd" ? KincoType::jd : KincoType::md;
  drive.station = it.station;
  return drive;
}

}  // namespace axisgate::simulated
