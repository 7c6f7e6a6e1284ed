// SPDX-License-Identifier: Apache-2.0
// A rig with a Kinco on its own serial protocol, whose single objects tests look at and put something into. Promises
// what every rig does. Never decides what is right: the tests do.
#pragma once

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {

using simulated::KincoType;
[[nodiscard]] std::string name(KincoType type);

struct RigOptions {
  simulated::DriveOptions drive{};
  profile::ResolveAxis axis{};
  simulated::Time reply_delay = std::chrono::milliseconds(2);
  std::optional<LeaseRules> lease{};  ///< none: leases are off
};

/// So many MDs on one RS485 line, with stations and axes from 1 on.
[[nodiscard]] GatewayStage::Line line_of_mds(std::uint8_t count, simulated::Time reply_delay);

class Rig : public DriveRig {
 public:
  explicit Rig(KincoType type, const RigOptions& options = {});

  [[nodiscard]] simulated::KincoDrive& motor() { return stage.drive(0); }
  [[nodiscard]] bool motor_enabled() { return powered(); }
  [[nodiscard]] std::int64_t object(std::uint16_t index, std::uint8_t sub = 0) { return *motor().peek({index, sub}); }
};

}  // namespace axisgate::test
