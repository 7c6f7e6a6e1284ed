// SPDX-License-Identifier: Apache-2.0
// A CAN bus behind a SocketCAN interface: frames as `struct can_frame` of <linux/can.h>, 16 bytes each.
// Promises the layout of that header and error frames of <linux/can/error.h>. Never opens a socket.
#pragma once

#include "tests/simulated/can_port_line.hpp"

namespace axisgate::simulated {

inline constexpr std::size_t socket_frame_bytes = 16;

std::array<std::uint8_t, socket_frame_bytes> socket_frame_of(const BusFrame& frame);
// Nothing for an error frame, or for less than 16 bytes.
std::optional<BusFrame> frame_of_socket(CanView bytes);

class SocketCanLine final : public CanPortLine {
 public:
  using CanPortLine::CanPortLine;

  void from_host(std::span<const std::uint8_t> bytes, Time now) override;
  void set_bus_off(bool off, Time now) override;
  void miss_acknowledge(Time now) override;

 protected:
  void to_host(const CanToHost& frame) override;

 private:
  void tell_error(std::uint32_t classes, std::uint8_t controller, Time now);
};

}  // namespace axisgate::simulated
