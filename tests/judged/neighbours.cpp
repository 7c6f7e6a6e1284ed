// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/neighbours.hpp"

#include <algorithm>

namespace axisgate::test::judged {
namespace {

/// Three timeouts of a drive that is unresponsive by then, with the silence after each, and a round of polls on a slow
/// line.
constexpr Duration kLongestGap = std::chrono::milliseconds(1000);
/// And of the time after that at most one part in so many.
constexpr int kShare = 50;

}  // namespace

Neighbours::Neighbours(obey::Plant& plant, bool neighbour, bool other_bus, Violated violated)
    : plant_(plant), violated_(std::move(violated)), other_bus_(other_bus) {
  AxisNumber axis = 0;
  for (const MotorPlace& place : motors(plant.subject, neighbour))
    if (++axis > 1) motors_.push_back({axis, place, truth(plant.stage, plant.subject, place).position});
}

void Neighbours::look(bool line_is_whole) {
  for (const Motor& motor : motors_) {
    const Truth truth = test::truth(plant_.stage, plant_.subject, motor.place);
    const std::string name = "the motor of axis " + std::to_string(motor.axis);
    if (truth.velocity != 0 || truth.position != motor.position) violated_(name + " moves, and nobody commands it");
    if (truth.enabled.value_or(false)) violated_(name + " is enabled, and nobody commands it");
  }
  if (other_bus_) look_at_other_bus();
  if (!line_is_whole || !plant_.stage.gateway_runs()) {
    well_ = false;
    return;
  }
  for (Motor& motor : motors_) {
    if (well_)
      look_at_drive(motor);
    else
      motor.mute_at = motor.looked_at = plant_.stage.runtime().now();
  }
  well_ = well_ || all_online();
}

void Neighbours::look_at_other_bus() {
  const simulated::KincoDrive& drive = plant_.stage.drive(1);
  if (drive.axis().actual_speed() != 0 || drive.state() == simulated::Cia402State::operation_enabled)
    violated_("the motor on the other bus moves or is enabled, and nobody commands it");
  if (!plant_.stage.gateway_runs()) {
    other_well_ = false;
    return;
  }
  const LinkState link = plant_.stage.axis(obey::kAxisOfOtherBus).link_state;
  if (other_well_ && link != LinkState::online)
    violated_("the axis on the other bus is " + std::string(text(link)) + ", and nothing has happened to it");
  other_well_ = link == LinkState::online;
}

bool Neighbours::all_online() {
  if (other_bus_ && plant_.stage.axis(obey::kAxisOfOtherBus).link_state != LinkState::online) return false;
  return std::ranges::all_of(motors_, [this](const Motor& motor) {
    return motor.place.drive == 0 || plant_.stage.axis(motor.axis).link_state == LinkState::online;
  });
}

void Neighbours::look_at_drive(Motor& motor) {
  if (motor.place.drive == 0) return;  // it shares the fate of axis 1
  const Instant now = plant_.stage.runtime().now();
  const LinkState link = plant_.stage.axis(motor.axis).link_state;
  const std::string name = "axis " + std::to_string(motor.axis);
  if (link != LinkState::online) violated_(name + " is " + std::string(text(link)) + ", and only axis 1 is in trouble");
  // On a slow line clients who command axis 1 all the time take the polls' time, and so does its bring-up; a drive that
  // is unresponsive costs its probes, and a stop of it its three tries.
  const LinkState first = plant_.stage.axis(1).link_state;
  if (first == LinkState::online || first == LinkState::setup) {
    motor.mute_at = now;
    motor.not_valid = {};
  } else if (!all_valid(motor)) {
    motor.not_valid += now - motor.looked_at;
  }
  motor.looked_at = now;
  if (motor.not_valid > kLongestGap + (now - motor.mute_at) / kShare)
    violated_(name + " is not valid for long, and only axis 1 is in trouble");
}

bool Neighbours::all_valid(const Motor& motor) {
  const AxisImage& image = plant_.stage.axis(motor.axis);
  for (const model::AxisModel& axis : plant_.stage.gateway().drive_of(motor.axis)->model().axes)
    for (const model::Binding& binding : axis.bindings) {
      const Sample& sample = image[binding.quantity];
      if (axis.number == motor.axis && binding.poll != model::PollClass::once && sample.received && !sample.valid)
        return false;
    }
  return true;
}

}  // namespace axisgate::test::judged
