#include "tests/axisgate_sim/line_spec.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
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

// The words that every kind of drive takes.
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

void modify(DriveOptions& drive, std::string_view word) {
  if (word == "fresh") {
    drive.factory_fresh = true;
  } else if (word == "cascade") {
    drive.cascade = true;
  } else if (!modify_mechanics(drive.mechanics, word)) {
    refuse("drive option", word, "use fresh, cascade, home=FROM..TO or limits=FROM..TO");
  }
}

void modify(KincoRtuDrive& drive, std::string_view word) {
  if (word == "fresh") {
    drive.drive.factory_fresh = true;
  } else if (word == "errors=83") {
    drive.rtu.read_error_function = 0x83;
  } else if (!modify_mechanics(drive.drive.mechanics, word)) {
    refuse("drive option", word, "use fresh, home=FROM..TO, limits=FROM..TO or errors=83");
  }
}

void modify(Id286proOptions& drive, std::string_view word) {
  if (word == "fresh") {
    drive.internal_pulses = false;
    return;
  }
  if (modify_mechanics(drive.mechanics, word)) return;
  const std::size_t equals = std::min(word.find('='), word.size() - 1);
  const std::int64_t row = number(word.substr(0, equals)).value_or(-1);
  const std::int64_t outside = std::numeric_limits<std::int64_t>::min();
  const std::int64_t value = number(word.substr(equals + 1)).value_or(outside);
  const auto known = std::ranges::find_if(id286pro_rows(), [&](const Id286proRow& it) {
    return it.number == row && it.saved != Saved::read_only && value >= it.minimum && value <= it.maximum;
  });
  if (known == id286pro_rows().end()) {
    refuse("drive option", word,
           "use fresh, home=FROM..TO, limits=FROM..TO, or a stored register and its value, for example 400=11");
  }
  drive.stored[known->number] = value;
}

struct Typed {
  std::string_view type;
  std::uint8_t station;
  std::vector<std::string_view> words;
};

Typed typed(std::string_view text, const std::vector<std::string_view>& types, std::string_view names,
            std::int64_t highest) {
  auto words = split(text, '+');
  const std::size_t at = words.front().find('@');
  const std::string_view type = words.front().substr(0, at);
  if (std::ranges::count(types, type) == 0) {
    refuse("drive", text, "write TYPE@STATION with type " + std::string(names) + ", for example jd@1");
  }
  const auto station = at == std::string_view::npos ? std::nullopt : number(words.front().substr(at + 1));
  if (!station || *station < 1 || *station > highest) {
    refuse("drive", text, "the station is a number from 1 to " + std::to_string(highest));
  }
  words.erase(words.begin());
  return {type, static_cast<std::uint8_t>(*station), std::move(words)};
}

DriveOptions parse_kinco(const Typed& it, DriveOptions drive) {
  drive.type = it.type == "jd" ? KincoType::jd : KincoType::md;
  drive.station = it.station;
  return drive;
}

DriveOptions parse_drive(std::string_view text, const DriveOptions& common) {
  const Typed it = typed(text, {"jd", "md"}, "jd or md", 127);
  DriveOptions drive = parse_kinco(it, common);
  for (const std::string_view word : it.words) modify(drive, word);
  return drive;
}

RtuDriveOptions parse_rtu_drive(std::string_view text, const DriveOptions& common) {
  if (!text.starts_with("id286pro")) {
    const Typed it = typed(text, {"jd", "md"}, "jd, md or id286pro", 127);
    KincoRtuDrive drive{parse_kinco(it, common), {}};
    for (const std::string_view word : it.words) modify(drive, word);
    return drive;
  }
  const Typed it = typed(text, {"id286pro"}, "jd, md or id286pro", 254);
  Id286proOptions drive;
  drive.unit = it.station;
  drive.internal_pulses = !common.factory_fresh;
  drive.boot_time = common.boot_time;
  for (const std::string_view word : it.words) modify(drive, word);
  return drive;
}

}  // namespace

std::vector<std::uint8_t> LineSpec::stations() const {
  std::vector<std::uint8_t> found;
  for (const DriveOptions& drive : drives) found.push_back(drive.station);
  for (const RtuDriveOptions& drive : rtu_drives) found.push_back(unit_of(drive));
  return found;
}

std::string LineSpec::describe() const {
  std::string text;
  const auto append = [&text](const std::string& drive) { text += (text.empty() ? "" : ",") + drive; };
  for (const DriveOptions& drive : drives) {
    append(std::string(model_of(drive.type).name) + '@' + std::to_string(drive.station));
  }
  for (const RtuDriveOptions& drive : rtu_drives) append(simulated::describe(drive));
  return (rtu ? "rtu:" : "") + text;
}

LineSpec parse_line_spec(std::string_view text, const DriveOptions& common) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size()) {
    refuse("line", text,
           "write PATH:DRIVES or PATH:rtu:DRIVES, for example /tmp/lift:jd@1, /tmp/table:md@1,jd@2 or "
           "/tmp/axes:rtu:id286pro@1,jd@2");
  }
  LineSpec spec;
  constexpr std::string_view rtu_mark = ":rtu";
  spec.path = text.substr(0, colon);
  spec.rtu = spec.path.ends_with(rtu_mark);
  if (spec.rtu) spec.path.resize(spec.path.size() - rtu_mark.size());
  spec.name = spec.path.substr(spec.path.rfind('/') + 1);
  if (spec.name.empty()) refuse("line", text, "the path ends in '/': name the link itself");
  for (const std::string_view drive : split(text.substr(colon + 1), ',')) {
    if (spec.rtu) {
      spec.rtu_drives.push_back(parse_rtu_drive(drive, common));
    } else {
      spec.drives.push_back(parse_drive(drive, common));
    }
    const auto stations = spec.stations();
    if (std::ranges::count(stations, stations.back()) > 1)
      refuse("drive", drive, "this station is already on the line");
  }
  return spec;
}

}  // namespace axisgate::simulated
