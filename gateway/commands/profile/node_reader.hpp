// SPDX-License-Identifier: Apache-2.0
// Reads some objects of one node on a CANopen bus, one SDO after the other.
// Promises to end: with all answers, or with the reason why there are none. Never writes, starts or resets anything.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/profile/make/node_answers.hpp"

namespace axisgate::commands {

struct NodePlace {
  std::string device;  ///< "can0", "slcan:PATH"
  std::uint8_t node = 0;
};
/// "can0:5", "slcan:/dev/ttyACM0:5"; what is wrong with it, empty: nothing.
[[nodiscard]] std::string node_place_mistake(const std::string& text);
/// Of a text without a mistake.
[[nodiscard]] NodePlace node_place(const std::string& text);

struct NodeReading {
  std::vector<profile::NodeAnswer> answers;
  std::string why;  ///< the reason why it ended before; empty: all were read
};
[[nodiscard]] NodeReading read_node(const NodePlace& place, std::uint32_t bitrate,
                                    std::vector<ObjectAddress> addresses);

}  // namespace axisgate::commands
