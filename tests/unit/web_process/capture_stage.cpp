// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/web_process/capture_stage.hpp"

namespace axisgate::web {

CaptureStage::CaptureStage(CaptureSettings settings, std::uint16_t axes, std::size_t bytes, std::size_t history)
    : stores(history, std::move(settings), bytes) {
  for (std::uint16_t number = 1; number <= axes; ++number) {
    AxisSample& sample = axes_[number] = standing(number);
    sample.axis_state = static_cast<std::uint8_t>(AxisState::continuous_motion);
    velocities_[number] = 1000 * number;
  }
  greet();
  run(2 * kEach);
}

void CaptureStage::greet() {
  HelloRecord hello;
  hello.boot = 42;
  hello.started = kStarted - kSecond;
  hello.axes = static_cast<std::uint16_t>(axes_.size());
  ASSERT_TRUE(stores.take(hello, {now, kToUtc}));
  for (const auto& [number, sample] : axes_) {
    AxisInfoRecord info;
    info.axis = number;
    info.name = "axis " + std::to_string(number);
    ASSERT_TRUE(stores.take(info, {now, kToUtc}));
  }
}

void CaptureStage::run(SteadyNs span, SteadyNs each) {
  constexpr std::int64_t kTurnEach = 25;
  for (const SteadyNs end = now + span; now < end;) {
    now += each;
    sample();
    if (++steps_ % kTurnEach == 0 || each > kSecond / 4) give_turn();
  }
}

void CaptureStage::sample() {
  SamplesRecord record;
  record.at = now;
  for (auto& [number, sample] : axes_) {
    sample.values.clear();
    // A little to and fro, as a motor has it: no two values are the same.
    const auto tremble = static_cast<std::int32_t>(steps_ % 7);
    set(sample, Quantity::velocity_actual, velocities_[number] + tremble);
    set(sample, Quantity::position_actual, static_cast<std::int32_t>(steps_ * number));
    record.axes.push_back(sample);
  }
  ASSERT_TRUE(stores.take(record, {now, kToUtc}));
}

void CaptureStage::give_turn() {
  Recorder::Turn turn = stores.turn({now, kToUtc});
  completed.insert(completed.end(), turn.completed.begin(), turn.completed.end());
  gone.insert(gone.end(), turn.gone.begin(), turn.gone.end());
}

void CaptureStage::fault(std::uint16_t number, bool is) {
  AxisSample& sample = axis(number);
  sample.inputs = is ? bits_of({AxisInput::online, AxisInput::fault}) : bits_of({AxisInput::online});
  sample.axis_state = static_cast<std::uint8_t>(is ? AxisState::error_stop : AxisState::continuous_motion);
}

void CaptureStage::event(std::uint16_t number, EventKind kind, std::uint32_t code, const std::string& text) {
  const EventRecord record{++events_, now, number, static_cast<std::uint8_t>(kind), code, text};
  ASSERT_TRUE(stores.take(record, {now, kToUtc}));
}

std::vector<std::string> CaptureStage::ids() const {
  std::vector<std::string> out;
  for (const Recorder::Kept& each : captures()) out.push_back(each->id);
  return out;
}

std::vector<Point> CaptureStage::points(const Capture& capture, std::uint16_t axis, Quantity quantity) {
  std::vector<Point> out;
  capture.each({axis, static_cast<std::uint8_t>(quantity)}, capture.from, capture.to, [&](const Point& point) {
    out.push_back(point);
    return true;
  });
  return out;
}

}  // namespace axisgate::web
