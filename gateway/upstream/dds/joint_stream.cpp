// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/joint_stream.hpp"

#include <cmath>
#include <utility>

namespace axisgate::dds {

JointView joint_view(const AxisImage& axis, double position, double tolerance, ClientId client) {
  JointView view;
  const bool moves = axis.axis_state == AxisState::standstill || axis.axis_state == AxisState::discrete_motion ||
                     axis.axis_state == AxisState::continuous_motion;
  const Sample& sample = axis[Quantity::position_actual];
  const bool of_before = sample.received && axis.zero_moved != kLongAgo && sample.at <= axis.zero_moved;
  view.ready = axis.reachable() && moves && axis.has(AxisInput::enabled) && !axis.has(AxisInput::fault) &&
               !axis.has(AxisInput::stop_latched) && !of_before;
  view.position = position;
  view.tolerance = tolerance;
  view.record = axis.record;
  view.client = client;
  return view;
}

void JointStream::restart() {
  in_step_.reset();
  asked_.reset();
  waiting_.reset();
  astray_reported_ = false;
  refused_ = false;
}

void JointStream::look_for_endings(const JointView& axis) {
  if (!axis.ready || (in_step_ && axis.record.ended(since_, axis.client))) restart();
}

// A velocity leads away from the position that the stream was at, so each way of control comes into step by itself.
bool JointStream::in_step(const JointTarget& target, double position, const JointView& axis) {
  if (in_step_ == target.is_velocity) return true;
  if (!axis.ready) return false;
  const bool there =
      target.is_velocity ? target.value == 0 : std::fabs(position - axis.position) <= axis.tolerance;  // NaN: no
  if (!there) {
    leaving_ = in_step_.has_value();
    if (leaving_) restart();
    astray_ = !std::exchange(astray_reported_, true);
    return false;
  }
  in_step_ = target.is_velocity;
  since_ = axis.record.now();
  asked_.reset();
  waiting_.reset();
  astray_reported_ = false;
  return true;
}

JointTarget JointStream::ask(const JointTarget& target) {
  busy_ = true;
  refused_ = false;
  asked_ = target;
  waiting_.reset();
  return target;
}

std::optional<JointTarget> JointStream::on_sample(const Guid& writer, const JointTarget& target, double position,
                                                  const JointView& axis) {
  astray_ = leaving_ = false;
  if (writer != writer_) restart();
  writer_ = writer;
  look_for_endings(axis);
  if (!in_step(target, position, axis)) return std::nullopt;
  if (busy_) {
    waiting_ = target;
    return std::nullopt;
  }
  if (asked_ == target) return std::nullopt;
  return ask(target);
}

std::optional<JointTarget> JointStream::on_result(Errc code, const JointView& axis) {
  busy_ = false;
  refused_ = code != Errc::ok;
  // What the axis cannot do is not asked again and again; what had no room or no answer may be, by a newer sample.
  if (code != Errc::ok && code != Errc::bad_value) asked_.reset();
  if (code == Errc::not_owner) restart();
  look_for_endings(axis);
  const auto next = std::exchange(waiting_, std::nullopt);
  if (!next || next == asked_) return std::nullopt;
  return ask(*next);
}

bool JointStream::take_astray() { return std::exchange(astray_, false); }

bool JointStream::take_leaving() { return std::exchange(leaving_, false); }

}  // namespace axisgate::dds
