// SPDX-License-Identifier: Apache-2.0
// What an enabled drive does with its motor: hold, move to a position, run at a speed or torque, stop, home.
// Promises the ramps and limits of the dictionary, one millisecond at a time, and never a move nobody began.
// Never knows a controlword, a mode number or a state.
#pragma once

#include <optional>

#include "tests/simulated/axis.hpp"
#include "tests/simulated/homing_run.hpp"

namespace axisgate::simulated {

// Taken from the dictionary after each write.
struct MotionSettings {
  Dec profile_velocity = 0;     // 6081
  Dec acceleration = 0;         // 6083
  Dec deceleration = 0;         // 6084
  Dec limit_deceleration = 0;   // at a limit switch
  Dec maximum_speed = 0;        // 6080: of the target speed, and of the actual speed with torque (JD 4.3)
  Dec full_acceleration = 0;    // what the largest allowed current gives; the only ramp of mode -3
  Dec torque_acceleration = 0;  // what the commanded current gives
  Dec coasting = 0;             // friction
  std::optional<FinePosition> software_minimum;  // 607D:02
  std::optional<FinePosition> software_maximum;  // 607D:01
};

enum class Task : std::uint8_t { coast, hold, position, velocity, immediate_velocity, torque, stop, homing };

class Motion {
 public:
  Task task() const { return task_; }
  FinePosition target() const { return target_; }
  const std::optional<HomingRun>& homing() const { return homing_; }

  void coast() { begin(Task::coast); }
  void hold(const Axis& axis);
  // Buffered: begins when the move under way has ended (controlword bit 5 = 0).
  void move_to(FinePosition target, bool buffered, const Axis& axis);
  void run_at(Dec speed, bool immediate);
  void run_torque() { begin(Task::torque); }
  void stop(Dec deceleration);
  void home(int method, const HomingSettings& settings, const Axis& axis, std::int64_t encoder_counts);

  // The speed for the next millisecond. `limited` tells that a limit shortened it (statusword bit 11).
  Dec next_speed(const Axis& axis, const DigitalInputs& inputs, const MotionSettings& settings);
  bool limited() const { return limited_; }
  bool position_loop() const;
  bool at_rest(const Axis& axis) const;

 private:
  void begin(Task task);
  Dec wanted_speed(const Axis& axis, const DigitalInputs& inputs, const MotionSettings& settings);
  Dec within_limits(Dec speed, const Axis& axis, const DigitalInputs& inputs, const MotionSettings& settings);

  Task task_ = Task::coast;
  FinePosition target_ = 0;
  std::optional<FinePosition> buffered_;
  Dec target_speed_ = 0;
  Dec stop_deceleration_ = 0;
  bool limited_ = false;
  std::optional<HomingRun> homing_;
};

}  // namespace axisgate::simulated
