// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/drive_table_rig.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::KeyaMotorName;
using simulated::KeyaWiring;

constexpr std::uint16_t kOriginSignal = 11;  // function of an iD286pro's input (5)
constexpr int kModeOfA = 20, kModeOfB = 50;  // parameters of a Keya (7)

simulated::KeyaOptions keya_options(Subject subject) {
  simulated::KeyaOptions options;
  const auto mode = positions_alone(subject) ? simulated::KeyaMode::absolute : simulated::KeyaMode::speed;
  options.parameters = {{kModeOfA, static_cast<std::int64_t>(mode)}, {kModeOfB, static_cast<std::int64_t>(mode)}};
  return options;
}

simulated::Id286proOptions id286pro_options() {
  simulated::Id286proOptions options;
  options.stored = {{400, kOriginSignal}};
  return options;
}

bool is_md(Subject subject) {
  return subject == Subject::md_rtu || subject == Subject::md_can || subject == Subject::md_serial;
}

simulated::DriveOptions kinco_options(Subject subject) {
  simulated::DriveOptions options;
  options.type = is_md(subject) ? KincoType::md : KincoType::jd;
  return options;
}

GatewayStage::Line plain_line_of(Subject subject) {
  switch (subject) {
    case Subject::id286pro:
      return rtu_line_of({id286pro_options()}, 1);
    case Subject::jd_rtu:
    case Subject::md_rtu:
      return rtu_line_of({simulated::KincoRtuDrive{kinco_options(subject), {}}}, 1);
    case Subject::leadshine:
      return can_line_of({simulated::LeadshineOptions{}}, 1);
    case Subject::jd_can:
    case Subject::md_can:
      return can_line_of({simulated::KincoCanDrive{kinco_options(subject), {}}}, 1);
    case Subject::jd_serial:
    case Subject::md_serial: {
      GatewayStage::Line line = line_of(is_md(subject) ? KincoType::md : KincoType::jd, 1);
      line.options.reply_delay = 2ms;
      return line;
    }
    case Subject::keya_can_speed:
    case Subject::keya_can_position:
      return can_line_of({simulated::KeyaCanDrive{keya_options(subject)}}, 1);
    case Subject::keya_canopen_speed:
    case Subject::keya_canopen_position:
      return can_line_of({simulated::KeyaCanopenDrive{keya_options(subject)}}, 1);
    case Subject::keya_rs232_speed:
    case Subject::keya_rs232_position:
      return keya_line_of(KeyaWiring::rs232, {keya_options(subject)}, 1);
    case Subject::keya_rs485_speed:
    case Subject::keya_rs485_position:
      return keya_line_of(KeyaWiring::rs485, {keya_options(subject)}, 1);
  }
  throw std::invalid_argument("no such subject");
}

/// With what torque needs to be known of a Kinco.
std::vector<GatewayStage::Line> lines(Subject subject, const std::optional<LeaseRules>& lease) {
  GatewayStage::Line line = plain_line_of(subject);
  line.lease = lease;
  const auto name_torque = [&](auto& staged) {
    staged.constants["rated_current_a"] = Rational(5);
    if (is_md(subject)) staged.constants["rated_speed_rpm"] = Rational(3000);
  };
  if (subject == Subject::jd_rtu || subject == Subject::md_rtu) name_torque(line.rtu_drives.front());
  if (subject == Subject::jd_can || subject == Subject::md_can) name_torque(line.can_drives.front());
  if (subject == Subject::jd_serial || subject == Subject::md_serial) name_torque(line.drives.front());
  std::vector<GatewayStage::Line> out;
  out.push_back(std::move(line));
  return out;
}

bool on_rtu(Subject s) { return s == Subject::id286pro || s == Subject::jd_rtu || s == Subject::md_rtu; }
bool on_kinco_serial(Subject s) { return s == Subject::jd_serial || s == Subject::md_serial; }
bool on_keya_serial(Subject s) {
  return s == Subject::keya_rs232_speed || s == Subject::keya_rs485_speed || s == Subject::keya_rs232_position ||
         s == Subject::keya_rs485_position;
}
bool on_keya_can(Subject s) { return s == Subject::keya_can_speed || s == Subject::keya_can_position; }

/// CiA 301 7.2.4.3: an expedited download of an object that commands.
bool commands_by_sdo(const can::CanFrame& frame, bool keya) {
  if ((frame.id & ~0x7FU) != 0x600 || frame.size != 8 || (frame.data[0] & 0xE0) != 0x20) return false;
  static const std::set<std::uint16_t> codes_and_data{0x607A, 0x6081, 0x6083, 0x6084};  // Keya 6.2
  const std::uint16_t index = load_le16(frame.data, 1);
  return keya ? codes_and_data.contains(index) : index == kControlword;
}

}  // namespace

std::string name(LeaseAction action) { return std::string(text(command_of(action))); }

std::string name(Subject subject) {
  static const std::vector<std::string> names{
      "Id286proRtu",     "KincoJdRtu",        "KincoMdRtu",        "LeadshineCan",
      "KincoJdCan",      "KincoMdCan",        "KincoJdSerial",     "KincoMdSerial",
      "KeyaCanSpeed",    "KeyaRs232Speed",    "KeyaRs485Speed",    "KeyaCanopenSpeed",
      "KeyaCanPosition", "KeyaRs232Position", "KeyaRs485Position", "KeyaCanopenPosition"};
  return names.at(static_cast<std::size_t>(subject));
}

TableRig::TableRig(Subject subject, std::optional<LeaseRules> lease)
    : stage(lines(subject, lease)), subject_(subject) {}

void TableRig::online() { expect(stage.come_online(), "the axis never came online"); }

WriteBatch TableRig::far_move() const {
  // A Keya moves at its rated 1500 rpm; the others are told to be slower.
  if (is_keya(subject_)) return with_command(Command::move_absolute, {{Quantity::target_position, 5'000'000}});
  return with_command(Command::move_absolute,
                      {{Quantity::target_position, 1'000'000}, {Quantity::profile_velocity, 300'000}});
}

WriteBatch TableRig::motion() const {
  if (positions_alone(subject_)) return far_move();
  return with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}});
}

void TableRig::bring_to(Situation situation) {
  online();
  const auto done = [&](const BatchResult& r) {
    expect(r.outcome.code == Errc::ok, "the way to the situation failed");
  };
  const bool starts_enabled = situation != Situation::disabled;
  if (starts_enabled) done(command(Command::enable));
  const bool moves = situation == Situation::moving || (situation == Situation::halted && positions_alone(subject_));
  const bool runs = situation == Situation::running || (situation == Situation::halted && !moves);
  if (moves) done(ask(far_move()));
  if (runs) done(ask(motion()));
  if (moves || runs) stage.run(600ms);
  if (situation == Situation::halted) {
    done(command(Command::halt));
    expect(stage.run_until([&] { return !turns() && !axis().has(AxisInput::moving); }), "never stood");
  }
  if (situation == Situation::latched) done(command(Command::quick_stop));
  if (situation == Situation::faulted) fail_the_drive();
  if (situation == Situation::offline) {
    silence_the_drive();
    expect(stage.run_until([&] { return axis().link_state == LinkState::offline; }), "never offline");
  }
  stage.run(700ms);
  mark();
}

void TableRig::fail_the_drive() {
  constexpr std::uint16_t kInJd = 0x0020, kInLeadshine = 0x2211, kInId286pro = 14, kInKeya = 0x0040;
  const auto seen = [&] {
    expect(stage.run_until([&] { return axis().has(AxisInput::fault); }), "no fault");
    stage.run(200ms);
  };
  if (is_keya(subject_)) {
    stage.keya(0).inject_fault(KeyaMotorName::a, kInKeya);
    seen();
    stage.keya(0).clear_fault_cause(KeyaMotorName::a, kInKeya);
  } else if (subject_ == Subject::id286pro) {
    stage.id286pro(0).inject_fault(kInId286pro);
    seen();
    stage.id286pro(0).clear_fault_cause();
  } else if (subject_ == Subject::leadshine) {
    stage.leadshine(0).inject_fault(kInLeadshine);
    seen();
    stage.leadshine(0).clear_fault_cause();
  } else {
    stage.drive(0).inject_fault(1, kInJd);
    seen();
    stage.drive(0).clear_fault_cause(1, kInJd);
  }
}

void TableRig::hush(double rate) {
  using simulated::DriveFault;
  if (on_rtu(subject_)) {
    stage.rtu_link(0).line().faults(0).set_rate(DriveFault::unresponsive, rate);
  } else if (on_keya_serial(subject_)) {
    stage.keya_link(0).line().faults(0).set_rate(DriveFault::unresponsive, rate);
  } else if (on_kinco_serial(subject_)) {
    stage.link(0).line().faults(0).set_rate(DriveFault::unresponsive, rate);
  } else {
    stage.can_link(0).line().connect(0, rate == 0);
  }
}

void TableRig::silence_the_drive() { hush(1); }

void TableRig::unplug() {
  if (on_rtu(subject_)) {
    stage.rtu_link(0).unplug();
  } else if (on_keya_serial(subject_)) {
    stage.keya_link(0).unplug();
  } else if (on_kinco_serial(subject_)) {
    stage.link(0).unplug();
  } else {
    stage.can_link(0).unplug();
  }
}

void TableRig::mend() {
  hush(0);
  if (on_rtu(subject_)) {
    stage.rtu_link(0).plug();
  } else if (on_keya_serial(subject_)) {
    stage.keya_link(0).plug();
  } else if (on_kinco_serial(subject_)) {
    stage.link(0).plug();
  } else {
    stage.can_link(0).plug();
  }
}

void TableRig::restart_the_drive() {
  const Instant now = stage.runtime().now();
  if (on_rtu(subject_)) {
    stage.rtu_link(0).line().restart(0, stage.rtu_link(0).time_of(now));
  } else if (on_keya_serial(subject_)) {
    stage.keya_link(0).line().restart(0, stage.keya_link(0).time_of(now));
  } else if (on_kinco_serial(subject_)) {
    stage.link(0).line().restart(0, stage.link(0).time_of(now));
  } else {
    stage.can_link(0).line().restart(0, stage.can_link(0).time_of(now));
  }
}

std::int64_t TableRig::position() {
  if (is_keya(subject_)) return stage.keya(0).at(KeyaMotorName::a).count();
  if (subject_ == Subject::id286pro) return stage.id286pro(0).position();
  if (subject_ == Subject::leadshine) return stage.leadshine(0).position();
  return stage.drive(0).position();
}

bool TableRig::turns() {
  const std::int64_t before = position();
  stage.run(100ms);
  return std::abs(position() - before) > 1;
}

bool TableRig::powered() {
  using simulated::Cia402State;
  if (is_keya(subject_)) return stage.keya(0).enabled(KeyaMotorName::a);
  if (subject_ == Subject::id286pro) return axis().has(AxisInput::enabled);
  if (subject_ == Subject::leadshine) return stage.leadshine(0).state() == Cia402State::operation_enabled;
  return stage.drive(0).state() == Cia402State::operation_enabled;
}

bool TableRig::neighbour_powered() { return is_keya(subject_) && stage.keya(0).enabled(KeyaMotorName::b); }

std::uint64_t TableRig::stores() {
  return subject_ == Subject::leadshine ? stage.leadshine(0).stores() : stage.drive(0).stores();
}

std::size_t TableRig::frames() {
  if (on_rtu(subject_)) return stage.rtu_link(0).sent.size();
  if (on_keya_serial(subject_)) return stage.keya_link(0).sent.size();
  if (on_kinco_serial(subject_)) return stage.link(0).sent.size();
  return stage.can_link(0).sent.size();
}

Instant TableRig::sent_at(std::size_t frame) {
  if (on_rtu(subject_)) return stage.rtu_link(0).sent[frame].at;
  if (on_keya_serial(subject_)) return stage.keya_link(0).sent[frame].at;
  if (on_kinco_serial(subject_)) return stage.link(0).sent[frame].at;
  return stage.can_link(0).sent[frame].at;
}

std::string TableRig::commanding(std::size_t frame) {
  constexpr std::uint16_t kId286proCommand = 323, kKincoControlword = 0x3100;
  constexpr Byte kReadRegisters = 3, kKeyaControl = 0xE0, kKeyaWrite = 0x23;
  if (on_rtu(subject_)) {
    const auto& bytes = stage.rtu_link(0).sent[frame].bytes;
    const std::uint16_t commands = subject_ == Subject::id286pro ? kId286proCommand : kKincoControlword;
    const bool is = bytes.at(1) != kReadRegisters && load_be16(bytes, 2) == commands;
    return is ? hex_text(bytes) : "";
  }
  if (on_keya_serial(subject_)) {
    const auto& bytes = stage.keya_link(0).sent[frame].bytes;
    return bytes.front() == kKeyaControl ? hex_text(bytes) : "";
  }
  if (on_kinco_serial(subject_)) {
    const auto& sent = stage.link(0).sent[frame];
    const WireRequest request = decoded(sent.at, sent.bytes);
    return request.write && request.index == kControlword ? hex_text(sent.bytes) : "";
  }
  const can::CanFrame& sent = stage.can_link(0).sent[frame].frame;
  const bool is = on_keya_can(subject_) ? sent.data[0] == kKeyaWrite : commands_by_sdo(sent, is_keya(subject_));
  return is ? hex_text(sent.bytes()) : "";
}

void TableRig::mark() {
  marked_ = frames();
  known_.clear();
  const Instant since = stage.runtime().now() - 700ms;
  for (std::size_t frame = marked_; frame > 0 && sent_at(frame - 1) >= since; --frame)
    known_.insert(commanding(frame - 1));
}

std::vector<std::string> TableRig::commanding() {
  std::vector<std::string> out;
  for (std::size_t frame = marked_; frame < frames(); ++frame) {
    const std::string text = commanding(frame);
    if (!text.empty() && !known_.contains(text)) out.push_back(text);
  }
  return out;
}

}  // namespace axisgate::test
