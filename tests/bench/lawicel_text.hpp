// SPDX-License-Identifier: Apache-2.0
// CAN frames as a Lawicel adapter's text has them (CANUSB manual 1.0): "t6018" and eight bytes in hex, ended by CR.
// Promises standard frames alone, with as little work as possible. Never shares code with the gateway's reader.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "tests/simulated/can_frames.hpp"

namespace axisgate::bench {

[[nodiscard]] std::string lawicel_text(const simulated::BusFrame& frame);
/// A line without its CR; nothing where it is no standard frame.
[[nodiscard]] std::optional<simulated::BusFrame> lawicel_frame(std::string_view line);

/// Lines as they become whole, without their CR; BELL ends one as well.
class LawicelLines {
 public:
  static constexpr std::size_t kLongest = 64;
  [[nodiscard]] std::optional<std::string> take(std::uint8_t byte);

 private:
  std::string begun_;
};

}  // namespace axisgate::bench
