// SPDX-License-Identifier: Apache-2.0
// Servos on one CANopen bus behind the shipped core. Promises what every rig does. Never decides what is right: the
// tests do.
#pragma once

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {

inline constexpr std::array kCanopenServos{Subject::leadshine, Subject::jd_can, Subject::md_can};
[[nodiscard]] simulated::CanDriveOptions options_of(Subject servo, std::uint8_t node);

class CanRig : public DriveRig {
 public:
  /// One drive of each, nodes and axes from 1 on.
  explicit CanRig(const std::vector<Subject>& servos);
  /// The first of it is a Leadshine.
  explicit CanRig(GatewayStage::Line line);

  [[nodiscard]] simulated::CanLine& line() { return stage.can_link(0).line(); }
  [[nodiscard]] simulated::CanopenNode& node(std::size_t position = 0) { return stage.can_node(0, position); }
  /// The drive at this position has become operational, which it does by itself after it was told to.
  [[nodiscard]] bool becomes_operational(std::size_t position = 0);
  void enable(AxisNumber axis = 1);
  [[nodiscard]] bool settles(const std::function<bool()>& done) { return stage.run_until(done); }
  /// NMT commands since the mark: "80 01".
  [[nodiscard]] std::vector<std::string> nmt();
};

}  // namespace axisgate::test
