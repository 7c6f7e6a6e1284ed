// SPDX-License-Identifier: Apache-2.0
// `axisgate profile try CONFIG AXIS`: a person tries the profile of a drive, step by step, beside the motor.
// Promises that nothing is written before the object reads are over, that torque and each kind of motion wait for a
// typed consent, that Ctrl-C, a terminal that is closed and the end of the input stop and disable the axis, and a
// report of whatever was tried. Never moves anything with --dry, or without a terminal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace axisgate::commands {

struct TryOptions {
  std::string config;
  std::uint16_t axis = 0;
  std::vector<std::string> profile_folders{};
  bool dry = false;
  std::string report{};                ///< a file that is written; empty: none
  std::optional<std::int16_t> home{};  ///< homing method; none: homing is not tried
};

[[nodiscard]] int run(const TryOptions& options);

}  // namespace axisgate::commands
