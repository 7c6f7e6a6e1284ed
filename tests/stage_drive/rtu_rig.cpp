// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/rtu_rig.hpp"

#include <algorithm>
#include <stdexcept>

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kUnderTest = 1;

simulated::RtuDriveOptions drive_of(Subject kind, std::uint8_t unit, const RtuRigOptions& options) {
  if (kind == Subject::id286pro) return simulated::Id286proOptions{.unit = unit};
  simulated::KincoRtuDrive kinco;
  kinco.drive.type = is_md(kind) ? simulated::KincoType::md : simulated::KincoType::jd;
  kinco.drive.station = unit;
  kinco.rtu = options.kinco;
  return kinco;
}

std::vector<GatewayStage::Line> lines(Subject kind, const RtuRigOptions& options) {
  std::vector<simulated::RtuDriveOptions> drives{drive_of(kind, kUnderTest, options)};
  std::uint8_t unit = kUnderTest;
  for (const Subject other : kOnRtu)
    if (options.neighbours && other != kind) drives.push_back(drive_of(other, ++unit, {}));
  GatewayStage::Line line = rtu_line_of(std::move(drives), 1);
  line.rtu_options.baud = 38400;
  line.rtu_options.journal_capacity = 10'000;
  line.timeout = options.timeout;
  return {line};
}

}  // namespace

RtuRig::RtuRig(Subject kind, const RtuRigOptions& options)
    : stage(lines(kind, options)), kind_(kind), neighbours_stay_(options.neighbours_stay) {
  RtuLinkSim& link = stage.rtu_link(0);
  for (std::size_t i = 0; i < link.line().size(); ++i)
    truths_.push_back(std::make_unique<RtuTruth>(stage.gateway(), link, static_cast<AxisNumber>(i + 1)));
  link.on_traffic = [this](bool to_drive, Bytes frame) {
    if (!to_drive) return;
    const RtuRequest request = request_in(frame);
    Instant& served = served_[request.unit];
    const Instant now = stage.runtime().now();
    if (request.unit != kUnderTest && served != Instant{}) longest_wait_ = std::max(longest_wait_, now - served);
    served = now;
    const LinkState state = axis().link_state;
    const bool speaks = state == LinkState::online || state == LinkState::setup;
    if (request.unit == kUnderTest && request.write && !speaks && !is_stop(request))
      wrong("a write of register " + std::to_string(request.start) + " to a drive that is " + std::string(text(state)));
    on_request(request);
  };
}

bool RtuRig::is_stop(const RtuRequest& request) const {
  constexpr std::uint16_t kSteppersControl = 323, kServosControlword = 0x3100;
  const std::uint16_t value = request.values.front();
  if (kind_ == Subject::id286pro) return request.start == kSteppersControl && (value == 6 || value == 7);
  constexpr std::uint16_t kHalt = 0x100, kNoQuickStop = 0x2, kEnableVoltage = 0x4;
  const bool stops = (value & kNoQuickStop) == 0 || (value & kEnableVoltage) == 0 || (value & kHalt) != 0;
  return request.start == kServosControlword && (stops || (value & 0xF) == 6 || (value & 0xF) == 7);
}

void RtuRig::wrong(const std::string& what) {
  constexpr std::size_t kEnough = 5;
  if (wrongs_.size() < kEnough && std::ranges::find(wrongs_, what) == wrongs_.end()) wrongs_.push_back(what);
}

void RtuRig::watch() {
  for (const auto& truth : truths_)
    if (const auto lie = truth->lie()) wrong(*lie);
  for (std::size_t i = 1; i < truths_.size(); ++i) {
    const auto number = static_cast<AxisNumber>(i + 1);
    if (neighbours_stay_ && !online(number))
      wrong("axis " + std::to_string(number) + " is " + std::string(text(axis(number).link_state)));
  }
}

void RtuRig::come_up_running() {
  if (!stage.come_online()) throw std::runtime_error("the axes never came online");
  const auto must = [&](const BatchResult& result) {
    if (result.outcome.code != Errc::ok) throw std::runtime_error("the axis does not run");
  };
  must(stage.command(1, Command::enable));
  must(stage.ask(1, with_command(Command::run_velocity, {{Quantity::target_velocity, 60'000}})));
  run(500ms);
  forget_waits();
}

void RtuRig::run(Duration time) {
  run_until([] { return false; }, time);
}

bool RtuRig::run_until(const std::function<bool()>& done, Duration limit) {
  const Instant end = stage.runtime().now() + limit;
  while (!done()) {
    if (stage.runtime().now() >= end) return false;
    stage.run(kStep);
    watch();
  }
  return true;
}

void RtuRig::ask_something() {
  static_cast<void>(stage.begin(1, setpoints({{Quantity::profile_velocity, next_value_ += 600}})));
  WriteBatch look;
  look.object = ObjectRequest{false, static_cast<std::uint16_t>(kind_ == Subject::id286pro ? 101 : 0x3200), 0, 2, 0};
  static_cast<void>(stage.begin(1, look));
}

}  // namespace axisgate::test
