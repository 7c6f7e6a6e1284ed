// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/stepper_rig.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

GatewayStage::Line line(const StepperOptions& options) {
  GatewayStage::Line out = rtu_line_of({options.drive}, 1);
  profile::ResolveAxis& axis = out.rtu_drives.front().axis;
  const profile::ResolveAxis standard = std::exchange(axis, options.axis);
  axis.number = standard.number;
  axis.name = standard.name;
  out.rtu_options.journal_capacity = 100'000;
  return out;
}

BatchResult object(GatewayStage& stage, bool write, std::uint16_t address, std::uint8_t size, std::uint32_t data) {
  WriteBatch batch;
  batch.object = ObjectRequest{write, address, 0, size, data};
  return stage.ask(1, batch);
}

}  // namespace

StepperRig::StepperRig(const StepperOptions& options) : DriveRig(Subject::id286pro, line(options)) {}

void StepperRig::run_at(std::int64_t velocity) {
  const BatchResult result = ask(with_command(Command::run_velocity, {{Quantity::target_velocity, velocity}}));
  expect(code(result) == Errc::ok, "does not run");
  const auto there = [&] { return std::abs(axis()[Quantity::velocity_actual].value - velocity) < 2'000; };
  expect(stage.run_until(there), "never at its velocity");
}

BatchResult StepperRig::move_to(std::int64_t position) {
  return ask(with_command(Command::move_absolute, {{Quantity::target_position, position}}));
}

BatchResult StepperRig::mailbox_write(std::uint16_t address, std::uint8_t size, std::uint32_t data) {
  return object(stage, true, address, size, data);
}

BatchResult StepperRig::mailbox_read(std::uint16_t address, std::uint8_t size) {
  return object(stage, false, address, size, 0);
}

bool StepperRig::motion_ends() {
  return stage.run_until([&] { return axis().motion_state != MotionState::active; }, 60s);
}

bool StepperRig::stands() {
  return stage.run_until(
      [&] { return motor().run_state() != simulated::Id286pro::RunState::running && !axis().has(AxisInput::moving); },
      5s);
}

std::size_t StepperRig::writes() {
  const auto& sent = stage.rtu_link(0).sent;
  return static_cast<std::size_t>(std::count_if(sent.begin() + static_cast<std::ptrdiff_t>(marked()), sent.end(),
                                                [](const RtuLinkSim::Sent& s) { return s.bytes.at(1) != 3; }));
}

std::size_t StepperRig::reads_of(std::uint16_t address, std::uint16_t registers) {
  const auto& sent = stage.rtu_link(0).sent;
  return static_cast<std::size_t>(
      std::count_if(sent.begin() + static_cast<std::ptrdiff_t>(marked()), sent.end(), [&](const RtuLinkSim::Sent& s) {
        return s.bytes.at(1) == 3 && load_be16(s.bytes, 2) == address && load_be16(s.bytes, 4) == registers;
      }));
}

}  // namespace axisgate::test
