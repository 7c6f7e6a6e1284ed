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

// REGISTER=VALUE, decimal or 0x...
struct StoredRegister {
  std::uint16_t number = 0;
  std::int64_t value = 0;
};
std::optional<StoredRegister> stored_register(std::string_view word) {
  const std::size_t equals = std::min(word.find('='), word.size() - 1);
  const std::int64_t row = whole_number(word.substr(0, equals)).value_or(-1);
  const auto value = whole_number(word.substr(equals + 1));
  if (row < 0 || row > 0xFFFF || !value) return std::nullopt;
  return StoredRegister{static_cast<std::uint16_t>(row), *value};
}

void modify(Id286proOptions& drive, std::string_view word) {
  if (word == "fresh") {
    drive.internal_pulses = false;
    return;
  }
  if (modify_mechanics(drive.mechanics, word)) return;
  const auto wanted = stored_register(word);
  const auto known = std::ranges::find_if(id286pro_rows(), [&](const Id286proRow& it) {
    return wanted && it.number == wanted->number && it.saved != Saved::read_only && wanted->value >= it.minimum &&
           wanted->value <= it.maximum;
  });
  if (known == id286pro_rows().end()) {
    refuse_spec("drive option", word,
                "use fresh, home=FROM..TO, limits=FROM..TO, or a stored register and its value, for example 400=11");
  }
  drive.stored[known->number] = wanted->value;
}

// Of a drive that is a table of registers.
template <class Drive, class Options>
void store_register(Options& options, std::string_view word, std::string_view right) {
  const auto wanted = stored_register(word);
  const Drive plain{Options{}};
  const auto row = wanted ? plain.rows().find(wanted->number) : plain.rows().end();
  if (row == plain.rows().end() || !row->second.writable || wanted->value < row->second.minimum ||
      wanted->value > row->second.maximum)
    refuse_spec("drive option", word, right);
  options.stored[wanted->number] = wanted->value;
}

void modify(Em2rsOptions& drive, std::string_view word) {
  if (word == "fresh") {
    drive.input_enables = true;
  } else if (!modify_mechanics(drive.mechanics, word)) {
    store_register<Em2rs>(drive, word,
                          "use fresh, home=FROM..TO, limits=FROM..TO, or a stored register and its value, for example "
                          "0x0147=0x27");
  }
}

void modify(ZlacOptions& drive, std::string_view word) {
  store_register<Zlac8015d>(drive, word, "use a stored register and its value, for example 0x2030=4096");
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

// home=, limits= or a stored object. `as_delivered` has the objects that there are.
template <class Options>
void modify_or_store(Options& drive, const Cia402Drive& as_delivered, std::string_view word, std::string_view right) {
  if (modify_mechanics(drive.mechanics, word)) return;
  const std::size_t equals = std::min(word.find('='), word.size() - 1);
  const auto key = object_named(word.substr(0, equals));
  const auto value = whole_number(word.substr(equals + 1));
  if (!key || !value || !as_delivered.peek(*key)) refuse_spec("drive option", word, right);
  drive.stored[*key] = *value;
}

void modify(LeadshineOptions& drive, std::string_view word) {
  if (word == "block") {
    drive.block = true;
  } else if (word == "ack") {
    drive.acknowledges_setpoints = true;
  } else {
    modify_or_store(drive, LeadshineDrive(LeadshineOptions{}), word,
                    "use block, ack, home=FROM..TO, limits=FROM..TO, or a stored object in hex and its value, for "
                    "example 2008.00=10000");
  }
}

void modify(EdsDriveOptions& drive, std::string_view word) {
  modify_or_store(drive, EdsDrive(EdsDriveOptions{.type = drive.type}), word,
                  "use home=FROM..TO, limits=FROM..TO, or a stored object in hex and its value, for example "
                  "605A.00=2");
}

DriveOptions parse_drive(std::string_view text, const DriveOptions& common) {
  const Typed it = typed(text, {"jd", "md"}, "jd or md", 127);
  DriveOptions drive = parse_kinco(it, common);
  for (const std::string_view word : it.words) modify(drive, word);
  return drive;
}

template <class Options>
RtuDriveOptions registers_of(const Typed& it, const DriveOptions& common, Options drive) {
  drive.unit = it.station;
  drive.boot_time = common.boot_time;
  for (const std::string_view word : it.words) modify(drive, word);
  return drive;
}

RtuDriveOptions parse_rtu_drive(std::string_view text, const DriveOptions& common) {
  const Typed it = typed(text, {"jd", "md", "id286pro", "em2rs", "cs2rs", "zlac8015d"},
                         "jd, md, id286pro, em2rs, cs2rs or zlac8015d", text.starts_with("id286pro") ? 254 : 127);
  if (it.type == "em2rs" || it.type == "cs2rs")
    return registers_of(it, common,
                        Em2rsOptions{.closed_loop = it.type == "cs2rs", .input_enables = common.factory_fresh});
  if (it.type == "zlac8015d") return registers_of(it, common, ZlacOptions{});
  if (it.type == "id286pro") return registers_of(it, common, Id286proOptions{.internal_pulses = !common.factory_fresh});
  KincoRtuDrive drive{parse_kinco(it, common), {}};
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
  std::vector<std::string_view> types{"jd", "md", "ld2", "keya-can", "keya-kydas4860-2e"};
  std::string names = "jd, md, ld2, keya-can, keya-kydas4860-2e";
  for (const EdsDriveType* type : eds_drive_types()) {
    types.push_back(type->name);
    (names += type == eds_drive_types().back() ? " or " : ", ") += type->name;
  }
  const Typed it = typed(text, types, names, 127);
  if (it.type == "keya-can") return KeyaCanDrive{parse_keya(it, common)};
  if (it.type == "keya-kydas4860-2e") return KeyaCanopenDrive{parse_keya(it, common)};
  if (const EdsDriveType* type = eds_drive_type(it.type)) {
    EdsDriveOptions drive{
        .type = type, .node = it.station, .boot_time = common.boot_time, .store_time = common.store_time};
    for (const std::string_view word : it.words) modify(drive, word);
    return drive;
  }
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
