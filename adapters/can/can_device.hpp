// SPDX-License-Identifier: Apache-2.0
// The "device" of a CAN bus in a configuration: an interface of SocketCAN, or "slcan:PATH" for a Lawicel adapter.
// Promises to say in words what is wrong with one, before anything is opened.
// Never looks whether the device exists.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate::can {

/// IFNAMSIZ of <linux/if.h> without its closing 0.
inline constexpr std::size_t kMaxInterfaceName = 15;
/// Most USB adapters ignore the rate of their serial port. One that does not is given as slcan:PATH@BAUD.
inline constexpr std::uint32_t kDefaultLawicelBaud = 115200;

struct CanDevice {
  bool lawicel = false;
  std::string path;  ///< of the serial port, or the interface's name
  std::uint32_t baud = kDefaultLawicelBaud;
  friend bool operator==(const CanDevice&, const CanDevice&) = default;
};

[[nodiscard]] CanDevice parse_can_device(std::string_view device);

/// Empty: all is well. Else one sentence, for the reader of the configuration.
[[nodiscard]] std::string can_device_mistake(std::string_view device, std::uint32_t bitrate);

}  // namespace axisgate::can
