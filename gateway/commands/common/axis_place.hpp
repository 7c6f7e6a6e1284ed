// SPDX-License-Identifier: Apache-2.0
// Where one axis stands in a configuration, for the commands that speak to one drive while the gateway is off.
// Promises that a command which opens a bus has its standard input's number taken. Never opens a bus itself.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "gateway/config/config_loader.hpp"
#include "gateway/core/numbers.hpp"

namespace axisgate::commands {

/// Positions in LoadedConfig::models, and the axis's own in its drive.
struct AxisPlace {
  std::size_t bus = 0;
  std::size_t drive = 0;
  AxisSlot slot = 0;
};
/// @param called its number, or its name; where there is none, or one is called as another is numbered, stderr says so,
/// with the file
[[nodiscard]] std::optional<AxisPlace> find_axis(const config::LoadedConfig& loaded, const std::string& file,
                                                 const std::string& called);
/// "axis 1 "lift": Kinco JD, node 1 on serial (/dev/ttyUSB0)".
[[nodiscard]] std::string text(const config::LoadedConfig& loaded, const AxisPlace& place);

/// Started without a standard input: the bus must not get its number, or frames would be taken for answers. False:
/// nothing can be put in its place.
[[nodiscard]] bool keep_stdin_taken();

}  // namespace axisgate::commands
