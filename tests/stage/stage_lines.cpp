// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/stage_lines.hpp"

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <tuple>

#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "gateway/config/adapter_names.hpp"
#include "gateway/config/config_sections.hpp"
#include "tests/places.hpp"
#include "tests/simulated/keya_drive.hpp"
#include "tests/stage/profile_once.hpp"

namespace axisgate::test {
namespace {

/// What the profile and the configuration say of a drive: the profile by its name, found where it is shipped.
struct Entry {
  std::string profile;
  std::string protocol;
  std::uint8_t node = 1;
  std::vector<profile::ResolveAxis> axes;
  std::map<std::string, Rational> constants;
  std::array<std::optional<std::uint32_t>, 4> identity{};
};

bool same(const profile::ResolveInput& a, const profile::ResolveInput& b) {
  const auto& [protocol, node, constants, identity, poll, axes] = a;
  return std::tie(protocol, node, constants, identity, poll, axes) ==
         std::tie(b.protocol, b.node, b.constants, b.identity, b.poll, b.axes);
}

model::DriveModel resolved(const profile::LoadedProfile& loaded, const profile::ResolveInput& input) {
  auto model = profile::resolve(loaded, input);
  if (auto* faults = std::get_if<std::vector<profile::Fault>>(&model)) throw std::runtime_error(text(faults->front()));
  return std::get<model::DriveModel>(std::move(model));
}

/// The same, of a profile that is never another one: thousands of rigs have the same few drives.
model::DriveModel resolved_once(const profile::LoadedProfile& loaded, const profile::ResolveInput& input) {
  constexpr std::size_t kKept = 64;
  struct Made {
    const profile::LoadedProfile* of;
    profile::ResolveInput input;
    model::DriveModel model;
  };
  static std::deque<Made> made;
  const auto known =
      std::ranges::find_if(made, [&](const Made& each) { return each.of == &loaded && same(each.input, input); });
  if (known != made.end()) return known->model;
  if (made.size() == kKept) made.pop_front();
  return made.emplace_back(Made{&loaded, input, resolved(loaded, input)}).model;
}

model::DriveModel resolved(Entry entry, const GatewayStage::Line& line) {
  // A test's own file, outside the source folder, may be another one the next time.
  std::optional<profile::LoadedProfile> own;
  if (entry.profile.starts_with('/')) own = profile::load_profile(entry.profile, {source_path("schemas/drives")});
  const bool in_source = entry.profile.ends_with(".json");
  const profile::LoadedProfile& loaded = own         ? *own
                                         : in_source ? profile_once(source_path(entry.profile))
                                                     : shipped_profile(entry.profile);
  if (!loaded.faults.empty()) throw std::runtime_error(text(loaded.faults.front()));
  profile::ResolveInput input;
  input.protocol = entry.protocol;
  input.node = entry.node;
  input.constants = std::move(entry.constants);
  input.identity = entry.identity;
  if (line.poll) input.poll = *line.poll;
  input.axes = std::move(entry.axes);
  LeaseRules off;
  off.on = false;
  for (profile::ResolveAxis& axis : input.axes) axis.lease = line.lease.value_or(off);
  return own ? resolved(loaded, input) : resolved_once(loaded, input);
}

void name_kinco(Entry& entry, simulated::KincoType type) {
  const bool jd = type == simulated::KincoType::jd;
  entry.profile = jd ? "kinco-jd" : "kinco-md";
  entry.constants.emplace("peak_current_a", jd ? Rational(275, 10) : Rational(36));
}

/// What the drive's parameters say is what its configuration says.
void name_keya(Entry& entry, std::string protocol, const simulated::KeyaOptions& options,
               const std::optional<profile::ResolveAxis>& axis_b) {
  entry.profile = "keya-kydas4860-2e";
  entry.protocol = std::move(protocol);
  if (axis_b) entry.axes.push_back(*axis_b);
  const simulated::KeyaParameters parameters(options, simulated::KeyaInterface::can);
  const auto say = [&](const char* constant, simulated::KeyaMotorName motor, int parameter, std::int64_t times) {
    entry.constants.emplace(constant, Rational(times * parameters.of(motor, parameter)));
  };
  constexpr int kRatedSpeed = 2, kEncoderLines = 4, kControlMode = 20, kEdges = 4;
  for (const auto motor : simulated::keya_motors) {
    const bool a = motor == simulated::KeyaMotorName::a;
    say(a ? "rated_speed_a_rpm" : "rated_speed_b_rpm", motor, kRatedSpeed, 1);
    say(a ? "counts_per_rev_a" : "counts_per_rev_b", motor, kEncoderLines, kEdges);
    say(a ? "control_mode_a" : "control_mode_b", motor, kControlMode, 1);
  }
}

Entry entry_of(const StageDrive& staged) {
  Entry entry{{}, "kinco-serial", staged.options.station, {staged.axis}, staged.constants, {}};
  name_kinco(entry, staged.options.type);
  return entry;
}

Entry entry_of(const RtuStageDrive& staged) {
  Entry entry{"id286pro", "modbus-rtu", unit_of(staged.options), {staged.axis}, staged.constants, {}};
  const auto* kinco = std::get_if<simulated::KincoRtuDrive>(&staged.options);
  if (kinco != nullptr) name_kinco(entry, kinco->drive.type);
  if (const auto* em2rs = std::get_if<simulated::Em2rsOptions>(&staged.options))
    entry.profile = em2rs->closed_loop ? "leadshine-cs2rs" : "leadshine-em2rs";
  if (std::holds_alternative<simulated::ZlacOptions>(staged.options)) entry.profile = "zlac8015d";
  if (staged.axis_b) entry.axes.push_back(*staged.axis_b);
  if (!staged.profile.empty()) entry.profile = staged.profile;
  return entry;
}

Entry entry_of(const CanStageDrive& staged) {
  Entry entry{"leadshine-ld2-can", "canopen",        node_of(staged.options),
              {staged.axis},       staged.constants, staged.identity};
  if (const auto* own = std::get_if<simulated::KeyaCanDrive>(&staged.options)) {
    name_keya(entry, "keya-can", own->drive, staged.axis_b);
  }
  if (const auto* open = std::get_if<simulated::KeyaCanopenDrive>(&staged.options)) {
    name_keya(entry, "canopen", open->drive, staged.axis_b);
  }
  const auto* kinco = std::get_if<simulated::KincoCanDrive>(&staged.options);
  if (kinco != nullptr) name_kinco(entry, kinco->drive.type);
  if (const auto* eds = std::get_if<simulated::EdsDriveOptions>(&staged.options)) {
    entry.profile = eds->type->name;
    if (!eds->type->tells_counts)
      entry.constants.emplace("position_units_per_rev", Rational(eds->type->encoder_counts));
  }
  if (!staged.profile.empty()) entry.profile = staged.profile;
  if (staged.configured_node) entry.node = *staged.configured_node;
  return entry;
}

profile::ResolveAxis axis_named(AxisNumber number) {
  profile::ResolveAxis axis;
  axis.number = number;
  axis.name = "axis " + std::to_string(number);
  return axis;
}

std::string keya_protocol(const GatewayStage::Line& line) {
  return line.keya_options.wiring == simulated::KeyaWiring::rs232 ? "keya-rs232" : "keya-rs485";
}

Entry entry_of(const KeyaStageDrive& staged, const GatewayStage::Line& line) {
  Entry entry{{}, {}, staged.options.node, {staged.axis}, staged.constants, {}};
  name_keya(entry, keya_protocol(line), staged.options, staged.axis_b);
  return entry;
}

std::string adapter_of(const GatewayStage::Line& line) {
  const auto own = [](const CanStageDrive& staged) {
    return std::holds_alternative<simulated::KeyaCanDrive>(staged.options);
  };
  if (std::ranges::any_of(line.can_drives, own)) return "keya-can";
  if (!line.can_drives.empty()) return "canopen";
  if (!line.keya_drives.empty()) return keya_protocol(line);
  return line.rtu_drives.empty() ? "kinco-serial" : "modbus-rtu";
}

}  // namespace

model::DriveModel model_on(const StageDrive& staged, const GatewayStage::Line& line) {
  return resolved(entry_of(staged), line);
}
model::DriveModel model_on(const RtuStageDrive& staged, const GatewayStage::Line& line) {
  return resolved(entry_of(staged), line);
}
model::DriveModel model_on(const CanStageDrive& staged, const GatewayStage::Line& line) {
  return resolved(entry_of(staged), line);
}
model::DriveModel model_on(const KeyaStageDrive& staged, const GatewayStage::Line& line) {
  return resolved(entry_of(staged, line), line);
}

config::BusConfig bus_on(const GatewayStage::Line& line) {
  config::BusConfig bus;
  bus.name = line.name;
  bus.adapter = adapter_of(line);
  const bool rtu = bus.adapter == "modbus-rtu";
  const bool keya = config::adapter::keya(bus.adapter);
  bus.timeout = line.timeout.value_or(rtu || keya ? Duration{} : std::chrono::milliseconds(100));
  bus.settle = line.drives.size() + line.rtu_drives.size() + line.keya_drives.size() > 1 ? std::chrono::milliseconds(20)
                                                                                         : Duration{};
  // One kind of them.
  bus.drives.resize(line.can_drives.size() + line.keya_drives.size() +
                    (rtu ? line.rtu_drives.size() : line.drives.size()));
  if (keya) {
    config::default_keya_bus(bus);
    if (line.keya_options.baud != 0) bus.baud = line.keya_options.baud;
    if (bus.adapter == "keya-can" && line.can_options.bit_rate != 0) bus.bitrate = line.can_options.bit_rate;
    if (bus.adapter != "keya-can") bus.min_gap = config::keya_gap(bus.baud);
    bus.poll_given = line.poll.has_value();
    if (line.poll) bus.poll = *line.poll;
  }
  if (bus.adapter == "canopen" && line.poll) bus.poll = *line.poll;
  if (rtu) {
    constexpr std::uint32_t kUsualBaud = 19200;
    bus.baud = line.rtu_options.baud != 0 ? line.rtu_options.baud : kUsualBaud;
    bus.min_gap = modbus_rtu::gap_time(bus.baud);
    bus.poll_given = line.poll.has_value();
    if (line.poll) bus.poll = *line.poll;
  }
  return bus;
}

GatewayStage::Line line_of(simulated::KincoType type, AxisNumber axis) {
  StageDrive staged;
  staged.options.type = type;
  staged.axis = axis_named(axis);
  GatewayStage::Line line;
  line.name = "line" + std::to_string(axis);
  line.drives = {staged};
  return line;
}

GatewayStage::Line rtu_line_of(std::vector<simulated::RtuDriveOptions> drives, AxisNumber first) {
  GatewayStage::Line line;
  line.name = "rtu" + std::to_string(first);
  for (simulated::RtuDriveOptions& options : drives) {
    const bool two = std::holds_alternative<simulated::ZlacOptions>(options);
    line.rtu_drives.push_back({std::move(options), axis_named(first++), {}, {}, {}});
    if (two) line.rtu_drives.back().axis_b = axis_named(first++);
  }
  return line;
}

GatewayStage::Line can_line_of(std::vector<simulated::CanDriveOptions> drives, AxisNumber first) {
  GatewayStage::Line line;
  line.name = "can" + std::to_string(first);
  for (simulated::CanDriveOptions& options : drives) {
    const bool two = std::holds_alternative<simulated::KeyaCanDrive>(options) ||
                     std::holds_alternative<simulated::KeyaCanopenDrive>(options);
    line.can_drives.push_back({std::move(options), axis_named(first++), {}, {}, {}});
    if (two) line.can_drives.back().axis_b = axis_named(first++);
  }
  return line;
}

GatewayStage::Line keya_line_of(simulated::KeyaWiring wiring, std::vector<simulated::KeyaOptions> drives,
                                AxisNumber first) {
  GatewayStage::Line line;
  line.name = "keya" + std::to_string(first);
  line.keya_options.wiring = wiring;
  for (simulated::KeyaOptions& options : drives) {
    line.keya_drives.push_back(
        {std::move(options), axis_named(first), {}, axis_named(static_cast<AxisNumber>(first + 1))});
    first = static_cast<AxisNumber>(first + 2);
  }
  return line;
}

}  // namespace axisgate::test
