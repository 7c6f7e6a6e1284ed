// SPDX-License-Identifier: Apache-2.0
// The iD286pro's built-in trapezoidal controller (iD286pro 6): move, run, stop, home, one millisecond at a time.
// Promises that a move ends exactly on its target, that nothing passes a soft limit, and that a limit switch stops at
// once. Never knows a register, a command number or a fault.
#pragma once

#include "tests/simulated/axis.hpp"

namespace axisgate::simulated {

struct Id286proProfile {
  Dec start = 0;  // 0301: the speed it begins with
  Dec stop = 0;   // 0302: the speed from which a stop is at once
  Dec acceleration = 1;
  Dec deceleration = 1;
  Dec speed = 0;
};

struct Id286proSignals {
  bool positive_limit = false;
  bool negative_limit = false;
  bool origin = false;
};

// 0305. Positive is clockwise.
enum class Id286proHoming : std::uint8_t {
  clockwise_to_origin,
  counter_to_origin,
  to_positive_limit,
  to_negative_limit
};

class Id286proMotion {
 public:
  enum class Task : std::uint8_t { none, absolute, relative, speed, stop, homing };

  Task task() const { return task_; }
  bool running() const { return task_ != Task::none; }

  void move(Task absolute_or_relative, FinePosition target, const Id286proProfile& profile);
  void retarget(FinePosition target) { target_ = target; }
  void run(Dec speed, const Id286proProfile& profile);  // signed
  void stop(const Id286proProfile& profile);
  void home(Id286proHoming mode, Dec creep, const Id286proProfile& profile);
  void end() { task_ = Task::none; }

  // The speed for the next millisecond. Ends the task when it is done.
  Dec next_speed(const Axis& axis, const Id286proSignals& signals, FinePosition lowest, FinePosition highest);
  // Once after a homing that found its signal: here is 0.
  bool take_reference();

 private:
  enum class Stage : std::uint8_t { search, slow_down, return_to_edge };

  Dec towards(Dec speed, Dec target) const;
  Dec over(Dec speed, FinePosition remaining, Dec highest) const;
  Dec task_speed(const Axis& axis, FinePosition lowest, FinePosition highest);
  Dec homing_speed(const Axis& axis, const Id286proSignals& signals);
  int homing_direction() const;

  Task task_ = Task::none;
  Id286proProfile profile_;
  FinePosition target_ = 0;
  Dec target_speed_ = 0;
  Id286proHoming homing_ = Id286proHoming::clockwise_to_origin;
  Stage stage_ = Stage::search;
  Dec creep_ = 0;
  FinePosition edge_ = 0;
  bool reference_ = false;
};

}  // namespace axisgate::simulated
