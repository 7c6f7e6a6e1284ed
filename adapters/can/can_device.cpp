// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/can_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "adapters/can/lawicel.hpp"

namespace axisgate::can {
namespace {

constexpr std::string_view kLawicelPrefix = "slcan:";
constexpr std::uint32_t kHighestBitrate = 1'000'000;  // ISO 11898-2, classical CAN
constexpr std::uint32_t kLowestBitrate = 10'000;      // CiA 301

/// The number after the last '@'; 0 where there is none.
std::uint32_t baud_of(std::string_view digits) {
  std::uint32_t baud = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), baud);
  return error == std::errc() && end == digits.data() + digits.size() ? baud : 0;
}

std::string interface_mistake(std::string_view name) {
  if (name.empty()) return "the name of a CAN interface is missing, such as can0";
  if (name.size() > kMaxInterfaceName) {
    return fmt::format("{} is no interface name: those have {} characters at most", name, kMaxInterfaceName);
  }
  const auto odd = [](char c) { return c <= ' ' || c == '/' || c == ':' || c > '~'; };
  if (std::ranges::any_of(name, odd) || name == "." || name == "..") {
    return fmt::format("{} is no interface name; a serial CAN adapter is given as slcan:PATH", name);
  }
  return {};
}

}  // namespace

CanDevice parse_can_device(std::string_view device) {
  CanDevice parsed;
  if (!device.starts_with(kLawicelPrefix)) {
    parsed.path = device;
    return parsed;
  }
  parsed.lawicel = true;
  device.remove_prefix(kLawicelPrefix.size());
  const std::size_t at = device.rfind('@');
  const std::uint32_t baud = at == std::string_view::npos ? 0 : baud_of(device.substr(at + 1));
  if (baud != 0) {
    parsed.baud = baud;
    device = device.substr(0, at);
  }
  parsed.path = device;
  return parsed;
}

std::string can_device_mistake(std::string_view device, std::uint32_t bitrate) {
  const CanDevice parsed = parse_can_device(device);
  if (bitrate < kLowestBitrate || bitrate > kHighestBitrate) {
    return fmt::format("{} bit/s is no bit rate of CAN: those are {} to {}", bitrate, kLowestBitrate, kHighestBitrate);
  }
  if (!parsed.lawicel) return interface_mistake(parsed.path);
  if (parsed.path.empty()) return "slcan: must be followed by the path of a serial port, such as slcan:/dev/ttyACM0";
  if (!lawicel_rate(bitrate)) {
    return fmt::format(
        "serial CAN adapters offer 10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000 and "
        "1000000 bit/s, not {}",
        bitrate);
  }
  return {};
}

}  // namespace axisgate::can
