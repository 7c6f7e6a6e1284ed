// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/line_spec.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "tests/axisgate_sim/keya_words.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::size_t longest_interface = 15;

struct Mark {
  std::string_view word;
  LineKind kind;
};
constexpr std::array<Mark, 3> marks{
    {{":rtu", LineKind::rtu}, {":can", LineKind::can}, {":lawicel", LineKind::lawicel}}};

void modify(DriveOptions& drive, std::string_view word) {
  if (word == "fresh") {
    drive.factory_fresh = true;
  } else if (word == "cascade") {
    drive.cascade = true;
  } else if (!modify_mechanics(drive.mechanics, word)) {
    refuse_spec("drive option", word, "use fresh, cascade, home=FROM..TO or limits=FROM..TO");
  }
}

void modify(KincoRtuDrive& drive, std::string_view word) {
  if (word == "fresh") {
    drive.drive.factory_fresh = true;
  } else if (word == "errors=83") {
    drive.rtu.read_error_function = 0x83;
  } else if (!modify_mechanics(drive.drive.mechanics, word)) {
    refuse_spec("drive option", word, "use fresh, home=FROM..TO, limits=FROM..TO or errors=83");
  }
}

void modify(Id286proOptions& drive, std::string_view word) {
  if (word == "fresh") {
    drive.internal_pulses = false;
    return;
  }
  if (modify_mechanics(drive.mechanics, word)) return;
  const std::size_t equals = std::min(word.find('='), word.size() - 1);
  const std::int64_t row = whole_number(word.substr(0, equals)).value_or(-1);
  const std::int64_t outside = std::numeric_limits<std::int64_t>::min();
  const std::int64_t value = whole_number(word.substr(equals + 1)).value_or(outside);
  const auto known = std::ranges::find_if(id286pro_rows(), [&](const Id286proRow& it) {
    return it.number == row && it.saved != Saved::read_only && value >= it.minimum && value <= it.maximum;
  });
  if (known == id286pro_rows().end()) {
    refuse_spec("drive option", word,
                "use fresh, home=FROM..TO, limits=FROM..TO, or a stored register and its value, for example 400=11");
  }
  drive.stored[known->number] = value;
}

void modify(KincoCanDrive& drive, std::string_view word) {
  if (word == "fresh") {
    drive.drive.factory_fresh = true;
  } else if (word == "block") {
    drive.can.block = true;
  } else if (word == "short") {
    drive.can.short_frames = true;
  } else if (!modify_mechanics(drive.drive.mechanics, word)) {
    refuse_spec("drive option", word, "use fresh, block, short, home=FROM..TO or limits=FROM..TO");
  }
}

void modify(LeadshineOptions& drive, std::string_view word) {
  if (word == "block") {
    drive.block = true;
    return;
  }
  if (word == "ack") {
    drive.acknowledges_setpoints = true;
    return;
  }
  if (modify_mechanics(drive.mechanics, word)) return;
  const std::size_t equals = std::min(word.find('='), word.size() - 1);
  const auto key = object_named(word.substr(0, equals));
  const auto value = whole_number(word.substr(equals + 1));
  if (!key || !value || !LeadshineDrive(LeadshineOptions{}).peek(*key)) {
    refuse_spec("drive option", word,
                "use block, ack, home=FROM..TO, limits=FROM..TO, or a stored object in hex and its value, for example "
                "2008.00=10000");
  }
  drive.stored[*key] = *value;
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

KeyaOptions parse_keya(const Typed& it, const DriveOptions& common) {
  KeyaOptions drive;
  drive.node = it.station;
  drive.boot_time = common.boot_time;
  for (const std::string_view word : it.words) modify_keya(drive, word);
  return drive;
}

// On RS232 a drive has no number: "keya-rs232" is "keya-rs232@1".
KeyaOptions parse_keya_serial(std::string_view text, LineKind kind, const DriveOptions& common) {
  if (kind == LineKind::keya_rs485) return parse_keya(typed(text, {"keya-rs485"}, "keya-rs485", 255), common);
  std::string whole(text);
  if (whole.find('@') == std::string::npos) whole.insert(std::min(whole.find('+'), whole.size()), "@1");
  return parse_keya(typed(whole, {"keya-rs232"}, "keya-rs232", 1), common);
}

CanDriveOptions parse_can_drive(std::string_view text, const DriveOptions& common) {
  const Typed it = typed(text, {"jd", "md", "ld2", "keya-can", "keya-kydas4860-2e"},
                         "jd, md, ld2, keya-can or keya-kydas4860-2e", 127);
  if (it.type == "keya-can") return KeyaCanDrive{parse_keya(it, common)};
  if (it.type == "keya-kydas4860-2e") return KeyaCanopenDrive{parse_keya(it, common)};
  if (it.type != "ld2") {
    KincoCanDrive drive{parse_kinco(it, common), {}};
    for (const std::string_view word : it.words) modify(drive, word);
    return drive;
  }
  LeadshineOptions drive;
  drive.node = it.station;
  drive.boot_time = common.boot_time;
  drive.store_time = common.store_time;
  for (const std::string_view word : it.words) modify(drive, word);
  return drive;
}

// Some types tell their line by themselves.
LineKind kind_by_type(std::string_view drives) {
  if (drives.starts_with("keya-rs232")) return LineKind::keya_rs232;
  if (drives.starts_with("keya-rs485")) return LineKind::keya_rs485;
  if (drives.starts_with("keya-")) return LineKind::can;
  return LineKind::kinco;
}

void add_drive(LineSpec& spec, std::string_view drive, const DriveOptions& common) {
  if (spec.is_can()) {
    spec.can_drives.push_back(parse_can_drive(drive, common));
  } else if (spec.is_keya_serial()) {
    spec.keya_drives.push_back(parse_keya_serial(drive, spec.kind, common));
  } else if (spec.kind == LineKind::rtu) {
    spec.rtu_drives.push_back(parse_rtu_drive(drive, common));
  } else {
    spec.drives.push_back(parse_drive(drive, common));
  }
}

}  // namespace

std::vector<std::uint8_t> LineSpec::stations() const {
  std::vector<std::uint8_t> found;
  for (const DriveOptions& drive : drives) found.push_back(drive.station);
  for (const RtuDriveOptions& drive : rtu_drives) found.push_back(unit_of(drive));
  for (const CanDriveOptions& drive : can_drives) found.push_back(node_of(drive));
  for (const KeyaOptions& drive : keya_drives) found.push_back(drive.node);
  return found;
}

std::string LineSpec::describe() const {
  std::string text;
  const auto append = [&text](const std::string& drive) { text += (text.empty() ? "" : ",") + drive; };
  for (const DriveOptions& drive : drives) {
    append(std::string(model_of(drive.type).name) + '@' + std::to_string(drive.station));
  }
  for (const RtuDriveOptions& drive : rtu_drives) append(simulated::describe(drive));
  for (const CanDriveOptions& drive : can_drives) append(simulated::describe(drive));
  for (const KeyaOptions& drive : keya_drives) {
    append((kind == LineKind::keya_rs232 ? "keya-rs232@" : "keya-rs485@") + std::to_string(drive.node));
  }
  const auto mark = std::ranges::find(marks, kind, &Mark::kind);
  return (mark == marks.end() ? "" : std::string(mark->word.substr(1)) + ":") + text;
}

LineSpec parse_line_spec(std::string_view text, const DriveOptions& common) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size()) {
    refuse_spec(
        "line", text,
        "write PATH:DRIVES, PATH:rtu:DRIVES, IFACE:can:DRIVES or PATH:lawicel:DRIVES, for example /tmp/lift:jd@1, "
        "/tmp/table:md@1,jd@2, /tmp/axes:rtu:id286pro@1,jd@2, vcan0:can:ld2@1 or /tmp/cart:keya-rs232");
  }
  LineSpec spec;
  spec.path = text.substr(0, colon);
  for (const Mark& mark : marks) {
    if (spec.kind != LineKind::kinco || !spec.path.ends_with(mark.word)) continue;
    spec.kind = mark.kind;
    spec.path.resize(spec.path.size() - mark.word.size());
  }
  if (spec.kind == LineKind::kinco) spec.kind = kind_by_type(text.substr(colon + 1));
  spec.name = spec.path.substr(spec.path.rfind('/') + 1);
  if (spec.name.empty()) refuse_spec("line", text, "the path ends in '/': name the link itself");
  if (spec.kind == LineKind::can && (spec.name != spec.path || spec.path.size() > longest_interface)) {
    refuse_spec("line", text, "a CAN interface has a name of at most 15 characters and no '/', for example vcan0");
  }
  for (const std::string_view drive : split(text.substr(colon + 1), ',')) {
    add_drive(spec, drive, common);
    const auto stations = spec.stations();
    if (std::ranges::count(stations, stations.back()) > 1)
      refuse_spec("drive", drive, "this station is already on the line");
  }
  return spec;
}

}  // namespace axisgate::simulated
