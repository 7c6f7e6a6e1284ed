// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/drive_rig.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::KeyaMotorName;

bool on_rtu(Subject s) { return s == Subject::id286pro || s == Subject::jd_rtu || s == Subject::md_rtu; }
bool on_kinco_serial(Subject s) { return s == Subject::jd_serial || s == Subject::md_serial; }
bool on_keya_serial(Subject s) {
  return s == Subject::keya_rs232_speed || s == Subject::keya_rs485_speed || s == Subject::keya_rs232_position ||
         s == Subject::keya_rs485_position;
}
bool on_keya_can(Subject s) { return s == Subject::keya_can_speed || s == Subject::keya_can_position; }

GatewayStage::Line line_of_rig(Subject subject, std::optional<LeaseRules> lease) {
  GatewayStage::Line line = line_with(subject, lease);
  line.options.reply_delay = 2ms;
  return line;
}

std::vector<GatewayStage::Line> alone(GatewayStage::Line line) {
  std::vector<GatewayStage::Line> out;
  out.push_back(std::move(line));
  return out;
}

/// None: it is none.
std::optional<WireRequest> decoded(Instant at, const can::CanFrame& frame) {
  const std::uint8_t specifier = frame.data[0] & 0xE0;
  if ((frame.id & ~0x7FU) != 0x600 || frame.size != 8 || (specifier != 0x20 && specifier != 0x40)) return {};
  return WireRequest{.at = at,
                     .write = specifier == 0x20,
                     .index = load_le16(frame.data, 1),
                     .sub = frame.data[3],
                     .data = load_le(frame.data, 4, 4),
                     .node = static_cast<std::uint8_t>(frame.id & 0x7F)};
}

/// An SDO download of an object that commands.
bool commands_by_sdo(const can::CanFrame& frame, bool keya) {
  static const std::set<std::uint16_t> codes_and_data{0x607A, 0x6081, 0x6083, 0x6084};  // Keya 6.2
  const auto request = decoded({}, frame);
  if (!request || !request->write) return false;
  return keya ? codes_and_data.contains(request->index) : request->index == kControlword;
}

}  // namespace

WireRequest decoded(Instant at, Bytes frame) {
  simulated::TenByteFrame f{};
  std::copy_n(frame.begin(), f.size(), f.begin());
  WireRequest out{
      .at = at, .index = simulated::index_of(f), .sub = simulated::sub_of(f), .data = simulated::data_of(f)};
  const auto command = simulated::command_of(f);
  out.write = command != simulated::FrameCommand::read;
  out.size = command == simulated::FrameCommand::write_4 ? 4 : command == simulated::FrameCommand::write_2 ? 2 : 1;
  return out;
}

std::string name(LeaseAction action) { return std::string(text(command_of(action))); }

std::string name(Situation situation) {
  static const std::vector<std::string> names{"disabled", "enabled", "moving",   "running", "homing",  "halted",
                                              "latched",  "faulted", "in_setup", "suspect", "offline", "link_down"};
  return names[static_cast<std::size_t>(situation)];
}

DriveRig::DriveRig(Subject subject, std::optional<LeaseRules> lease) : DriveRig(subject, line_of_rig(subject, lease)) {}

DriveRig::DriveRig(Subject subject, GatewayStage::Line line) : stage(alone(std::move(line))), subject_(subject) {}

void DriveRig::online() { expect(stage.come_online(), "an axis never came online"); }

WriteBatch DriveRig::far_move() const {
  // A Keya moves at its rated 1500 rpm; the others are told to be slower.
  if (is_keya(subject_)) return with_command(Command::move_absolute, {{Quantity::target_position, 5'000'000}});
  return with_command(Command::move_absolute,
                      {{Quantity::target_position, 1'000'000}, {Quantity::profile_velocity, 300'000}});
}

WriteBatch DriveRig::motion() const {
  if (!has_speeds(subject_)) return far_move();
  return with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}});
}

void DriveRig::bring_to(Situation situation, Duration stays) {
  const auto becomes = [&](LinkState link) {
    expect(stage.run_until([&] { return axis().link_state == link; }), "the link never came to that state");
  };
  const auto done = [&](const BatchResult& r) {
    expect(r.outcome.code == Errc::ok, "the way to the situation failed");
  };
  if (situation == Situation::in_setup) return becomes(LinkState::setup);
  online();
  if (situation != Situation::disabled) done(command(Command::enable));
  switch (situation) {
    case Situation::disabled:
    case Situation::enabled:
    case Situation::in_setup:
      break;
    case Situation::moving:
      done(ask(far_move()));
      stage.run(600ms);
      break;
    case Situation::running:
      done(ask(motion()));
      stage.run(600ms);
      break;
    case Situation::homing:
      done(ask(with_command(Command::home, {{Quantity::homing_method, 19}})));
      stage.run(600ms);
      break;
    case Situation::halted:
      done(ask(motion()));
      stage.run(600ms);
      done(command(Command::halt));
      expect(stage.run_until([&] { return !turns() && !axis().has(AxisInput::moving); }), "never stood");
      stage.run(400ms);
      break;
    case Situation::latched:
      done(command(Command::quick_stop));
      stage.run(400ms);
      break;
    case Situation::faulted:
      fail_the_drive();
      break;
    case Situation::suspect:
      faults().next(simulated::DriveFault::unresponsive, 2);  // the first resynchronisation read as well
      becomes(LinkState::suspect);
      break;
    case Situation::offline:
      silence_the_drive();
      becomes(LinkState::offline);
      break;
    case Situation::link_down:
      unplug();
      becomes(LinkState::link_down);
      break;
  }
  stage.run(stays);
  mark();
}

void DriveRig::fail_the_drive() {
  break_down(stage, subject_);
  expect(stage.run_until([&] { return axis().has(AxisInput::fault); }), "no fault");
  stage.run(200ms);
  end_cause(stage, subject_);
}

void DriveRig::hush(bool silent) {
  stage.at_link(0, [silent](auto& link) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(link)>, CanLinkSim>)
      link.line().connect(0, !silent);
    else
      link.line().faults(0).set_rate(simulated::DriveFault::unresponsive, silent ? 1 : 0);
  });
}

void DriveRig::unplug() {
  stage.at_link(0, [](auto& link) { link.unplug(); });
}

void DriveRig::mend() {
  hush(false);
  stage.at_link(0, [](auto& link) { link.plug(); });
}

void DriveRig::restart_the_drive() {
  const Instant now = stage.runtime().now();
  stage.at_link(0, [now](auto& link) { link.line().restart(0, link.time_of(now)); });
}

std::int64_t DriveRig::position() { return truth(stage, subject_).position; }

bool DriveRig::turns() {
  const std::int64_t before = position();
  stage.run(100ms);
  return std::abs(position() - before) > 1;
}

bool DriveRig::powered() { return truth(stage, subject_).enabled.value_or(axis().has(AxisInput::enabled)); }

bool DriveRig::neighbour_powered() { return is_keya(subject_) && stage.keya(0).enabled(KeyaMotorName::b); }

std::uint64_t DriveRig::stores() {
  if (is_eds(subject_)) return stage.eds_drive(0).stores();
  return subject_ == Subject::leadshine ? stage.leadshine(0).stores() : stage.drive(0).stores();
}

std::size_t DriveRig::frames() {
  return stage.at_link(0, [](auto& link) { return link.sent.size(); });
}

Instant DriveRig::sent_at(std::size_t frame) {
  return stage.at_link(0, [frame](auto& link) { return link.sent[frame].at; });
}

std::string DriveRig::commanding(std::size_t frame) {
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

void DriveRig::mark() {
  marked_ = frames();
  known_.clear();
  const Instant since = stage.runtime().now() - 700ms;
  for (std::size_t frame = marked_; frame > 0 && sent_at(frame - 1) >= since; --frame)
    known_.insert(commanding(frame - 1));
}

std::vector<std::string> DriveRig::commanding() {
  std::vector<std::string> out;
  for (std::size_t frame = marked_; frame < frames(); ++frame) {
    const std::string text = commanding(frame);
    if (!text.empty() && !known_.contains(text)) out.push_back(text);
  }
  return out;
}

std::vector<WireRequest> DriveRig::requests() {
  std::vector<WireRequest> out;
  if (on_kinco_serial(subject_)) {
    const auto& sent = stage.link(0).sent;
    for (std::size_t i = marked_; i < sent.size(); ++i) out.push_back(decoded(sent[i].at, sent[i].bytes));
    return out;
  }
  const auto& sent = stage.can_link(0).sent;
  for (std::size_t i = marked_; i < sent.size(); ++i)
    if (const auto request = decoded(sent[i].at, sent[i].frame)) out.push_back(*request);
  return out;
}

std::vector<WireRequest> DriveRig::writes() {
  auto all = requests();
  std::erase_if(all, [](const WireRequest& r) { return !r.write; });
  return all;
}

std::vector<WireRequest> DriveRig::writes_of(std::uint32_t index, std::uint8_t sub) {
  auto all = writes();
  std::erase_if(all, [&](const WireRequest& r) { return r.index != index || r.sub != sub; });
  return all;
}

std::size_t DriveRig::count(std::uint32_t index, std::uint32_t data) {
  const auto all = writes_of(index);
  return static_cast<std::size_t>(std::ranges::count(all, data, &WireRequest::data));
}

BatchResult DriveRig::mailbox_write(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t data) {
  WriteBatch batch;
  batch.object = ObjectRequest{true, index, sub, size, data};
  return ask(batch);
}

bool DriveRig::has_event(EventKind kind, const std::string& part) {
  return std::ranges::any_of(stage.gateway().events().events(),
                             [&](const Event& e) { return e.kind == kind && e.text.find(part) != std::string::npos; });
}

std::size_t DriveRig::times_told(std::string_view part) {
  return static_cast<std::size_t>(
      std::ranges::count_if(stage.log(), [&](const std::string& line) { return line.find(part) != line.npos; }));
}

WriteBatch setpoints(std::initializer_list<Setpoint> list) { return with_command(Command::none, list); }

WriteBatch with_command(Command command, std::initializer_list<Setpoint> list) {
  WriteBatch batch;
  batch.client = 7;
  for (const Setpoint& sp : list) batch.setpoints.push_back(sp);
  batch.command = command;
  return batch;
}

WriteBatch with_controlword(std::uint16_t word, bool single) {
  WriteBatch batch;
  batch.client = 7;
  batch.controlword = word;
  batch.single_controlword = single;
  return batch;
}

}  // namespace axisgate::test
