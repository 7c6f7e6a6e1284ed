#include "tests/axisgate_sim/line_spec.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>

namespace axisgate::simulated {
namespace {

[[noreturn]] void refuse(std::string_view what, std::string_view wrong, std::string_view right) {
  throw std::invalid_argument(std::string(what) + " '" + std::string(wrong) + "': " + std::string(right));
}

std::optional<std::int64_t> number(std::string_view text) {
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

std::pair<std::int64_t, std::int64_t> range(std::string_view word, std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots != std::string_view::npos) {
    const auto from = number(text.substr(0, dots));
    const auto to = number(text.substr(dots + 2));
    if (from && to && *from < *to) return {*from, *to};
  }
  refuse("places", word, "write counts as FROM..TO, for example +home=10000..12000");
}

void modify(DriveOptions& drive, std::string_view word) {
  if (word == "fresh") {
    drive.factory_fresh = true;
  } else if (word == "cascade") {
    drive.cascade = true;
  } else if (word.starts_with("home=")) {
    const auto [from, to] = range(word, word.substr(5));
    drive.mechanics.home_from = from;
    drive.mechanics.home_to = to;
  } else if (word.starts_with("limits=")) {
    const auto [from, to] = range(word, word.substr(7));
    drive.mechanics.negative_limit = from;
    drive.mechanics.positive_limit = to;
  } else {
    refuse("drive option", word, "use fresh, cascade, home=FROM..TO or limits=FROM..TO");
  }
}

DriveOptions parse_drive(std::string_view text, DriveOptions drive) {
  const auto words = split(text, '+');
  const std::size_t at = words.front().find('@');
  const std::string_view type = words.front().substr(0, at);
  const auto written = at == std::string_view::npos ? std::nullopt : number(words.front().substr(at + 1));
  const auto station = written.value_or(0);
  if (type == "jd") {
    drive.type = KincoType::jd;
  } else if (type == "md") {
    drive.type = KincoType::md;
  } else {
    refuse("drive", text, "write TYPE@STATION with type jd or md, for example jd@1");
  }
  if (station < 1 || station > 127) refuse("drive", text, "the station is a number from 1 to 127");
  drive.station = static_cast<std::uint8_t>(station);
  for (std::size_t i = 1; i < words.size(); ++i) modify(drive, words[i]);
  return drive;
}

}  // namespace

LineSpec parse_line_spec(std::string_view text, const DriveOptions& common) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size()) {
    refuse("line", text, "write PATH:DRIVES, for example /tmp/lift:jd@1 or /tmp/table:md@1,jd@2");
  }
  LineSpec spec;
  spec.path = text.substr(0, colon);
  spec.name = spec.path.substr(spec.path.rfind('/') + 1);
  if (spec.name.empty()) refuse("line", text, "the path ends in '/': name the link itself");
  for (const std::string_view drive : split(text.substr(colon + 1), ',')) {
    spec.drives.push_back(parse_drive(drive, common));
    const auto& newest = spec.drives.back();
    if (std::count_if(spec.drives.begin(), spec.drives.end(),
                      [&](const DriveOptions& other) { return other.station == newest.station; }) > 1) {
      refuse("drive", drive, "this station is already on the line");
    }
  }
  return spec;
}

std::string describe(const std::vector<DriveOptions>& drives) {
  std::string text;
  for (const DriveOptions& drive : drives) {
    if (!text.empty()) text += ',';
    text += std::string(model_of(drive.type).name) + '@' + std::to_string(drive.station);
  }
  return text;
}

}  // namespace axisgate::simulated
