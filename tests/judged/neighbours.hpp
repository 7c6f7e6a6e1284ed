// SPDX-License-Identifier: Apache-2.0
// The motors that nobody commands. Watches that none of them moves or is enabled; that a drive beside axis 1's stays
// online, with values that are valid again and again, whatever becomes of that one; that one on another bus does
// whatever becomes of the line. Promises to ask the simulated motors. Never changes anything it looks at.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/obey/plant.hpp"

namespace axisgate::test::judged {

class Neighbours {
 public:
  using Violated = std::function<void(std::string)>;
  Neighbours(obey::Plant& plant, bool neighbour, bool other_bus, Violated violated);

  /// After each step. `line_is_whole`: nothing is wrong but with axis 1's drive.
  void look(bool line_is_whole);
  [[nodiscard]] bool all_online();

 private:
  struct Motor {
    AxisNumber axis;
    MotorPlace place;
    std::int64_t position;
    Instant looked_at{};
    Instant mute_at{};     ///< until then axis 1's drive was heard
    Duration not_valid{};  ///< since then
  };
  void look_at_drive(Motor& motor);
  void look_at_other_bus();
  [[nodiscard]] bool all_valid(const Motor& motor);

  obey::Plant& plant_;
  Violated violated_;
  std::vector<Motor> motors_;  ///< but axis 1
  bool well_ = false;          ///< each drive beside has been online since the line was troubled
  bool other_bus_;
  bool other_well_ = false;  ///< its drive has been online since the gateway began
};

}  // namespace axisgate::test::judged
