// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/emergency.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::canopen {

std::optional<bus::UnsolicitedEvent> decode_emergency(std::uint8_t node, Bytes bytes) {
  if (bytes.size() < 2) return std::nullopt;
  bus::UnsolicitedEvent unsolicited{.kind = bus::UnsolicitedEvent::Kind::emergency, .node = node};
  unsolicited.code = load_le16(bytes, 0);
  if (bytes.size() > 2) {
    unsolicited.error_register = bytes[2];
    std::copy(bytes.begin() + 3, bytes.end(), unsolicited.vendor.begin());
  }
  return unsolicited;
}

std::optional<bus::UnsolicitedEvent> EmergencyLimit::pass(bus::UnsolicitedEvent emergency, Instant now) {
  if (now >= window_end_) {
    reported_ = 0;
    window_end_ = now + kWindow;
  }
  const bool reset = emergency.code == 0;
  if (!reset && reported_ >= kMaxEmergencies) {
    held_ = emergency;
    ++held_count_;
    return std::nullopt;
  }
  ++reported_;
  // What was held back came before this one.
  emergency.repeats = std::exchange(held_count_, 0);
  held_.reset();
  return emergency;
}

std::optional<bus::UnsolicitedEvent> EmergencyLimit::take_held(Instant now) {
  if (!held_ || now < window_end_) return std::nullopt;
  bus::UnsolicitedEvent last = *std::exchange(held_, std::nullopt);
  last.repeats = std::exchange(held_count_, 0) - 1;
  reported_ = 1;
  window_end_ = now + kWindow;
  return last;
}

}  // namespace axisgate::canopen
