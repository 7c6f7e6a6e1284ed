// SPDX-License-Identifier: Apache-2.0
// Where `axisgate support` looks, by a configuration that may be wrong: devices, the page, a listener, profiles. Pure.
// Promises what can be read of a file that is only nearly right, and defaults where it has none, as the gateway takes
// them. Never takes a place for right because it is written down.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/commands/client/host_port.hpp"

namespace axisgate::commands::support {

/// As many buses as a configuration may have.
inline constexpr std::size_t kMostDevices = 100;
/// Own profiles whose sums are taken.
inline constexpr std::size_t kMostProfiles = 100;

struct Device {
  std::string bus;           ///< its name
  std::string path;          ///< "/dev/ttyUSB0"; empty: it is an interface
  std::string interface {};  ///< "can0"
};

struct Places {
  std::vector<Device> devices{};
  std::optional<HostPort> page{};       ///< none: no page is configured
  std::optional<HostPort> listener{};   ///< the first of Modbus-TCP that has a numeric address
  std::vector<std::string> profiles{};  ///< as written, each once
};
/// @param configuration as Redaction::json has it; empty or no object: nothing is found
[[nodiscard]] Places places_of(std::string_view configuration);

/// "slcan:/dev/ttyACM0@921600" is /dev/ttyACM0, "can0" is an interface.
[[nodiscard]] Device device_of(std::string bus, std::string_view device);

}  // namespace axisgate::commands::support
