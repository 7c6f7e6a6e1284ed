// SPDX-License-Identifier: Apache-2.0
// `axisgate parameters save|compare|restore CONFIG AXIS FILE`: the settings of a drive as a file, what differs between
// the file and a drive, and back into the drive that takes the place of the first.
// Promises that save and compare only read; that restore writes what it has shown, after a yes, while no motor of the
// drive has torque, reads back each value, and says of each object what became of it. Never enables or moves an axis,
// and never writes over a file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace axisgate::commands {

struct ParametersOptions {
  enum class Action : std::uint8_t { save, compare, restore };
  Action action = Action::save;
  std::string config;
  std::string axis;  ///< number or name
  std::string file;
  std::string eds;  ///< empty: none
  std::vector<std::string> profile_folders{};
};

/// 1: something differs, was not written, or could not be asked for.
[[nodiscard]] int run(const ParametersOptions& options);

}  // namespace axisgate::commands
