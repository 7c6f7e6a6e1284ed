// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/rig.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

std::vector<GatewayStage::Line> lines(KincoType type, const RigOptions& options) {
  StageDrive staged;
  staged.options = options.drive;
  staged.options.type = type;
  staged.axis = options.axis;
  staged.axis.number = 1;
  staged.axis.name = "axis";
  staged.constants["rated_current_a"] = Rational(5);
  if (type == KincoType::md) staged.constants["rated_speed_rpm"] = Rational(3000);
  GatewayStage::Line line;
  line.name = "line";
  line.drives = {staged};
  line.lease = options.lease;
  line.options.reply_delay = options.reply_delay;
  line.options.journal_capacity = 100'000;
  std::vector<GatewayStage::Line> out;
  out.push_back(std::move(line));
  return out;
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

std::string name(KincoType type) { return type == KincoType::jd ? "JD" : "MD"; }

std::string name(Situation situation) {
  static const std::vector<std::string> names{"disabled", "enabled", "moving",   "running", "homing",  "halted",
                                              "latched",  "faulted", "in setup", "suspect", "offline", "link down"};
  return names[static_cast<std::size_t>(situation)];
}

Rig::Rig(KincoType type, RigOptions options) : stage(lines(type, options)), type_(type) {}

void Rig::online() { expect(stage.come_online(), "the axis never came online"); }

void Rig::bring_to(Situation situation) {
  if (situation == Situation::in_setup) {
    expect(stage.run_until([&] { return axis().link_state == LinkState::setup; }), "no setup");
    return;
  }
  online();
  const auto done = [&](const BatchResult& r) {
    expect(r.outcome.code == Errc::ok, "the way to the situation failed");
  };
  const auto enable = [&] { done(command(Command::enable)); };
  switch (situation) {
    case Situation::disabled:
    case Situation::in_setup:
      break;
    case Situation::enabled:
      enable();
      break;
    case Situation::moving:
      enable();
      done(ask(with_command(Command::move_absolute,
                            {{Quantity::target_position, 1'000'000}, {Quantity::profile_velocity, 300'000}})));
      stage.run(600ms);
      break;
    case Situation::running:
      enable();
      done(ask(with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}})));
      stage.run(600ms);
      break;
    case Situation::homing:
      enable();
      done(ask(with_command(Command::home, {{Quantity::homing_method, 19}})));
      stage.run(600ms);
      break;
    case Situation::halted:
      bring_to(type_ == KincoType::jd ? Situation::running : Situation::moving);
      done(command(Command::halt));
      expect(stage.run_until([&] { return !axis().has(AxisInput::moving); }), "never stood");
      stage.run(400ms);
      break;
    case Situation::latched:
      enable();
      done(command(Command::quick_stop));
      stage.run(400ms);
      break;
    case Situation::faulted:
      motor().inject_fault(1, 0x0020);
      expect(stage.run_until([&] { return axis().has(AxisInput::fault); }), "no fault");
      stage.run(200ms);
      motor().clear_fault_cause(1, 0x0020);
      break;
    case Situation::suspect:
      enable();
      faults().next(simulated::DriveFault::unresponsive, 2);  // the first resynchronisation read as well
      expect(stage.run_until([&] { return axis().link_state == LinkState::suspect; }), "never suspect");
      break;
    case Situation::offline:
      enable();
      faults().set_rate(simulated::DriveFault::unresponsive, 1);
      expect(stage.run_until([&] { return axis().link_state == LinkState::offline; }), "never offline");
      break;
    case Situation::link_down:
      enable();
      stage.link(0).unplug();
      expect(stage.run_until([&] { return axis().link_state == LinkState::link_down; }), "never down");
      break;
  }
  mark();
}

BatchResult Rig::mailbox_write(std::uint16_t index, std::uint8_t sub, std::uint8_t size, std::uint32_t data) {
  WriteBatch batch;
  batch.object = ObjectRequest{true, index, sub, size, data};
  return ask(batch);
}

std::vector<WireRequest> Rig::requests() {
  std::vector<WireRequest> out;
  const auto& sent = stage.link(0).sent;
  for (std::size_t i = marked_; i < sent.size(); ++i) out.push_back(decoded(sent[i].at, sent[i].bytes));
  return out;
}

std::vector<WireRequest> Rig::writes() {
  auto all = requests();
  std::erase_if(all, [](const WireRequest& r) { return !r.write; });
  return all;
}

std::vector<WireRequest> Rig::writes_of(std::uint32_t index, std::uint8_t sub) {
  auto all = writes();
  std::erase_if(all, [&](const WireRequest& r) { return r.index != index || r.sub != sub; });
  return all;
}

std::size_t Rig::count(std::uint32_t index, std::uint32_t data) {
  const auto all = writes_of(index);
  return static_cast<std::size_t>(std::ranges::count(all, data, &WireRequest::data));
}

bool Rig::turns() {
  const std::int64_t before = motor().position();
  stage.run(100ms);
  return std::abs(motor().position() - before) > 1;
}

bool Rig::has_event(EventKind kind, const std::string& part) {
  const auto& ring = stage.gateway().events().events();
  return std::any_of(ring.begin(), ring.end(),
                     [&](const Event& e) { return e.kind == kind && e.text.find(part) != std::string::npos; });
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
