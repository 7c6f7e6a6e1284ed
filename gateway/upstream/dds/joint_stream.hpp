// SPDX-License-Identifier: Apache-2.0
// One axis under ROS 2's joint_commands: which of a stream's targets are asked of it, and when. Pure.
// Promises that the newest target wins and at most one waits; that after an enable, a stop, a fault, a loss, another
// client's command or a new writer nothing acts before the stream was where the axis is (position), or at 0
// (velocity): hardware of ros2_control that has just been started asks for 0.0. Never enables, and never interpolates.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/image/axis_image.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

struct JointTarget {
  bool is_velocity = false;
  std::int64_t value = 0;  ///< in register units
  friend bool operator==(const JointTarget&, const JointTarget&) = default;
};

/// What a stream must know of its axis. Positions in the axis's DDS unit, NaN where there is none that is good.
struct JointView {
  /// Enabled, in reach, no fault, no stop latch, not homing, and its position was sampled after its zero has moved.
  bool ready = false;
  double position = 0;
  double tolerance = 0;
  AxisRecord record{};
  ClientId client = 0;  ///< who asks for this stream
};
[[nodiscard]] JointView joint_view(const AxisImage& axis, double position, double tolerance, ClientId client);

class JointStream {
 public:
  /// `position`: of a position target, in the axis's DDS unit. The target to be asked of the axis now, if any.
  [[nodiscard]] std::optional<JointTarget> on_sample(const Guid& writer, const JointTarget& target, double position,
                                                     const JointView& axis);
  /// What was asked has this result. The next one, if one waits.
  [[nodiscard]] std::optional<JointTarget> on_result(Errc code, const JointView& axis);
  /// The axis was enabled or sent to its home: from now on the stream must be seen where it is.
  void restart();
  /// It has just turned out, for the first time since the stream last acted, that it is not where the enabled axis is.
  [[nodiscard]] bool take_astray();
  /// What was sampled last is what is asked of the axis, or waits to be: neither out of step nor refused.
  [[nodiscard]] bool follows() const { return in_step_.has_value() && !refused_; }
  /// The stream that was in step asks for something else than before, and not from where the axis is: it does not ask
  /// for its motion any more.
  [[nodiscard]] bool take_leaving();
  /// What was asked last has no result yet.
  [[nodiscard]] bool busy() const { return busy_; }

 private:
  [[nodiscard]] bool in_step(const JointTarget& target, double position, const JointView& axis);
  void look_for_endings(const JointView& axis);
  [[nodiscard]] JointTarget ask(const JointTarget& target);

  Guid writer_{};
  std::optional<bool> in_step_;  ///< with velocities, or with positions; none: with neither
  AxisRecord::Point since_ = 0;  ///< when it came into step
  std::optional<JointTarget> asked_{};
  std::optional<JointTarget> waiting_{};
  bool busy_ = false;
  bool refused_ = false;  ///< what was asked last
  bool leaving_ = false;
  bool astray_reported_ = false;
  bool astray_ = false;
};

}  // namespace axisgate::dds
