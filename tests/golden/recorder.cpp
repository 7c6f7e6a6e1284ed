// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/recorder.hpp"

#include <regex>
#include <sstream>
#include <stdexcept>

#include "tests/stage/transcript.hpp"

namespace axisgate::test {
namespace {

GatewayStage::Line staged(simulated::KincoType type) {
  GatewayStage::Line line = line_of(type, 1);
  line.options.baud = 38400;
  line.options.reply_delay = std::chrono::milliseconds(2);
  line.poll = {std::chrono::milliseconds(100), std::chrono::hours(1), std::chrono::hours(1)};
  return line;
}

GatewayStage::Line staged(const simulated::RtuDriveOptions& drive) {
  GatewayStage::Line line = rtu_line_of({drive}, 1);
  line.poll = {std::chrono::milliseconds(100), std::chrono::hours(1), std::chrono::hours(1)};
  return line;
}

GatewayStage::Line staged(const simulated::CanDriveOptions& drive) {
  GatewayStage::Line line = can_line_of({drive}, 1);
  line.poll = {std::chrono::milliseconds(100), std::chrono::hours(1), std::chrono::hours(1)};
  return line;
}

std::optional<simulated::KincoType> kinco_named(const std::string& profile) {
  if (profile == "kinco-jd") return simulated::KincoType::jd;
  return profile == "kinco-md" ? std::optional(simulated::KincoType::md) : std::nullopt;
}

GatewayStage::Line staged(const std::string& profile, const std::string& adapter, std::uint8_t address) {
  simulated::DriveOptions kinco;
  const auto type = kinco_named(profile);
  kinco.type = type.value_or(kinco.type);
  kinco.station = address;
  if (adapter == "kinco-serial" && type) {
    GatewayStage::Line line = staged(*type);
    line.drives[0].options.station = address;
    return line;
  }
  if (adapter == "modbus-rtu" && type) return staged(simulated::RtuDriveOptions(simulated::KincoRtuDrive{kinco, {}}));
  if (adapter == "modbus-rtu" && profile == "id286pro")
    return staged(simulated::RtuDriveOptions(simulated::Id286proOptions{.unit = address}));
  if (adapter == "canopen" && type) return staged(simulated::CanDriveOptions(simulated::KincoCanDrive{kinco, {}}));
  if (adapter != "canopen") throw std::runtime_error("no drive is simulated for " + profile + " on " + adapter);
  GatewayStage::Line line = staged(simulated::CanDriveOptions(simulated::LeadshineOptions{.node = address}));
  line.can_drives[0].profile = profile;
  return line;
}

}  // namespace

struct Recorder::Subject {
  GatewayStage::Line line;
  bool bring_up = false;
  explicit Subject(const std::string& first_line) {
    static const std::regex kForm(R"(# (\S+) on (\S+) at address (\d+)(, from its bring-up)?)");
    std::smatch found;
    if (!std::regex_match(first_line, found, kForm)) throw std::runtime_error("names no drive: " + first_line);
    line = staged(found[1], found[2], static_cast<std::uint8_t>(std::stoi(found[3])));
    bring_up = found[4].matched;
  }
};

Recorder::Recorder(const std::string& first_line) : Recorder(Subject(first_line)) { text_ = first_line + "\n" + text_; }

Recorder::Recorder(const Subject& subject) : Recorder(subject.line, subject.bring_up) {}

Recorder::Recorder(simulated::KincoType type, bool bring_up) : Recorder(staged(type), bring_up) {}

Recorder::Recorder(const simulated::RtuDriveOptions& drive, bool bring_up) : Recorder(staged(drive), bring_up) {}

Recorder::Recorder(const simulated::CanDriveOptions& drive, bool bring_up) : Recorder(staged(drive), bring_up) {}

Recorder::Recorder(const GatewayStage::Line& staged_line, bool bring_up)
    : rtu_(!staged_line.rtu_drives.empty()),
      stage_({staged_line}),
      began_(stage_.runtime().now()),
      recording_(bring_up) {
  const modbus_tcp::SessionContext context{settings_, stage_.gateway().image(), stage_.gateway(), registry_,
                                           quiet_,    &stage_.runtime()};
  modbus_tcp::Peer peer;
  peer.role = Role::engineer;
  session_ = std::make_unique<modbus_tcp::Session>(context, peer, stage_.runtime().now(), [] {});
  listen(stage_, 0, [this](const CableFrame& frame) {
    if (recording_) text_ += transcript_line(stage_.runtime().now() - began_, frame) + "\n";
  });
  while (stage_.axis(1).link_state != LinkState::online) step();
  began_ = stage_.runtime().now();
  if (!recording_) show_image();  // remembers, without a word
  recording_ = true;
}

void Recorder::restart() {
  CanLinkSim& link = stage_.can_link(0);
  link.line().restart(0, link.time_of(stage_.runtime().now()));
}

void Recorder::line(const std::string& who, const std::string& what) {
  if (!recording_) return;
  text_ += transcript_line(stage_.runtime().now() - began_, who, what) + "\n";
}

void Recorder::say(const std::string& text) { text_ += "# " + text + "\n"; }

// What a client would notice of the axis, by name; only what has changed is told.
void Recorder::show_image() {
  const AxisImage& axis = stage_.axis(1);
  std::map<std::string, std::string> now;
  now["link_state"] = axisgate::text(axis.link_state);
  now["axis_state"] = axisgate::text(axis.axis_state);
  now["motion_state"] = number_text("%lld", static_cast<int>(axis.motion_state));
  now["alarms"] = number_text("0x%llX", axis.alarms);
  now["inputs"] = number_text("0x%04llX", axis.inputs);
  for (const QuantityRow& row : quantity_table()) {
    const Sample& sample = axis[row.quantity];
    if (!sample.received) continue;
    const bool word = row.quantity == Quantity::statusword || row.quantity == Quantity::controlword;
    now[std::string(row.name)] =
        number_text(word ? "0x%04llX" : "%lld", sample.value) + (sample.valid ? "" : " (not valid)");
  }
  for (const auto& [name, value] : now) {
    if (shown_[name] == value) continue;
    line("image    ", name + " = " + value);
    shown_[name] = value;
  }
}

void Recorder::step() {
  stage_.runtime().advance_by(std::chrono::microseconds(100));
  if (recording_) show_image();
}

void Recorder::take_output() {
  while (!session_->output().empty()) {
    const Bytes out = session_->output();
    const std::vector<Byte> reply(out.begin(), out.end());
    session_->take_output(reply.size(), stage_.runtime().now());
    line("modbus <-", hex_text(reply));
    ++replies_;
  }
}

void Recorder::send(std::vector<Byte> pdu, const std::string& meaning) {
  say(meaning);
  std::vector<Byte> adu(7);
  store_be16(adu, 0, ++transaction_);
  store_be16(adu, 4, static_cast<std::uint16_t>(pdu.size() + 1));
  adu[6] = 1;
  adu.insert(adu.end(), pdu.begin(), pdu.end());
  line("modbus ->", hex_text(adu));
  const std::size_t before = replies_;
  session_->on_bytes(adu, stage_.runtime().now());
  take_output();
  while (replies_ == before) {
    step();
    take_output();
  }
}

void Recorder::write(std::uint16_t offset, const std::vector<std::uint16_t>& registers) {
  std::vector<Byte> pdu(6 + 2 * registers.size());
  pdu[0] = 16;
  store_be16(pdu, 1, static_cast<std::uint16_t>(100 + offset));
  store_be16(pdu, 3, static_cast<std::uint16_t>(registers.size()));
  pdu[5] = static_cast<Byte>(2 * registers.size());
  std::string values;
  for (std::size_t i = 0; i < registers.size(); ++i) {
    store_be16(pdu, 6 + 2 * i, registers[i]);
    values += " " + std::to_string(registers[i]);
  }
  send(std::move(pdu), "the PLC writes registers from " + std::to_string(100 + offset) + ":" + values);
}

void Recorder::coil(std::uint16_t number, bool on) {
  std::vector<Byte> pdu{5, 0, static_cast<Byte>(100 + number), static_cast<Byte>(on ? 0xFF : 0), 0};
  send(std::move(pdu), "the panel sets coil " + std::to_string(100 + number) + (on ? " to 1" : " to 0"));
}

void Recorder::read(std::uint16_t offset, std::uint16_t count) {
  std::vector<Byte> pdu(5);
  pdu[0] = 3;
  store_be16(pdu, 1, static_cast<std::uint16_t>(100 + offset));
  store_be16(pdu, 3, count);
  send(std::move(pdu), "the PLC reads " + std::to_string(count) + " registers from " + std::to_string(100 + offset));
}

void Recorder::tell(const std::string& remark) {
  static const std::regex kWrites(R"(the PLC writes registers from (\d+):((?: \d+)+))");
  static const std::regex kReads(R"(the PLC reads (\d+) registers from (\d+))");
  static const std::regex kSets(R"(the panel sets coil (\d+) to ([01]))");
  static const std::regex kPass(R"((\d+) ms pass)");
  std::smatch found;
  const auto number = [&found](std::size_t at) { return static_cast<std::uint16_t>(std::stoi(found[at])); };
  const auto offset = [&](std::size_t at) { return static_cast<std::uint16_t>(number(at) - 100); };
  if (std::regex_match(remark, found, kWrites)) {
    std::istringstream values(found[2]);
    std::vector<std::uint16_t> registers;
    for (std::uint16_t each = 0; values >> each;) registers.push_back(each);
    write(offset(1), registers);
  } else if (std::regex_match(remark, found, kReads)) {
    read(offset(2), number(1));
  } else if (std::regex_match(remark, found, kSets)) {
    coil(offset(1), found[2] == "1");
  } else {
    say(remark);
    if (std::regex_match(remark, found, kPass)) run(std::chrono::milliseconds(number(1)));
  }
}

void Recorder::run(Duration time) {
  const Instant end = stage_.runtime().now() + time;
  while (stage_.runtime().now() < end) step();
}

}  // namespace axisgate::test
