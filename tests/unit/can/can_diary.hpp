// SPDX-License-Identifier: Apache-2.0
// What a CAN link told, in order and in words.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "adapters/can/can_link.hpp"

namespace axisgate::test {

class CanDiary final : public can::CanLinkEvents {
 public:
  void on_link_up() override {
    told.emplace_back("up");
    if (on_up) on_up();
  }
  void on_link_down(std::string_view why) override {
    told.push_back("down: " + std::string(why));
    if (on_down) on_down();
  }
  void on_frame(const can::CanFrame& frame, Instant received) override {
    frames.push_back(frame);
    instants.push_back(received);
    if (on_received) on_received();
  }
  [[nodiscard]] bool up() const { return !told.empty() && told.back() == "up"; }
  [[nodiscard]] bool down() const { return !told.empty() && told.back().starts_with("down"); }

  std::vector<std::string> told;
  std::vector<can::CanFrame> frames;
  std::vector<Instant> instants;
  std::function<void()> on_up, on_down, on_received;
};

/// Standard frames, one byte of data each.
inline can::CanFrame frame_of(std::uint32_t id, Byte value = 0) {
  return can::data_frame(id, std::vector<Byte>{value});
}

inline const std::vector<can::CanFilter> kEverything{{.id = 0, .mask = 0}, {.id = 0, .mask = 0, .extended = true}};

}  // namespace axisgate::test
