// SPDX-License-Identifier: Apache-2.0
// CAN frames as a Lawicel adapter's text has them (CANUSB manual 1.0): "t6018" and eight bytes in hex, ended by CR.
// Promises as little work as possible. Never shares code with the gateway's reader.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tests/simulated/can_frames.hpp"

namespace axisgate::simulated {

/// Without its CR.
[[nodiscard]] std::string lawicel_text(const BusFrame& frame);
/// A line without its CR; nothing where it is no frame.
[[nodiscard]] std::optional<BusFrame> lawicel_frame(std::string_view line);

}  // namespace axisgate::simulated
