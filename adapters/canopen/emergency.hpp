// SPDX-License-Identifier: Apache-2.0
// EMCY frames (CiA 301 section 7.2.7), and how many of them are reported.
// Promises that "error reset" always passes, and of all else kMaxEmergencies in a second: the first ones at once, the
// last one when the second is over, with the number of those between.
// Never judges a code. Never looks at a clock.
#pragma once

#include <optional>

#include "adapters/bus/exchange.hpp"

namespace axisgate::canopen {

/// No value: not even a code. Shorter frames than the eight bytes of CiA 301 count as filled up with 00.
[[nodiscard]] std::optional<bus::UnsolicitedEvent> decode_emergency(std::uint8_t node, Bytes bytes);

/// Of one node.
class EmergencyLimit {
 public:
  static constexpr int kMaxEmergencies = 4;
  static constexpr Duration kWindow = std::chrono::seconds(1);

  /// The unsolicited event to be reported now, if it may be.
  [[nodiscard]] std::optional<bus::UnsolicitedEvent> pass(bus::UnsolicitedEvent emergency, Instant now);
  /// The last of those that were held back, once their second is over.
  [[nodiscard]] std::optional<bus::UnsolicitedEvent> take_held(Instant now);
  /// When take_held() has one.
  [[nodiscard]] Instant next_deadline() const { return held_ ? window_end_ : kNever; }

 private:
  std::optional<bus::UnsolicitedEvent> held_;
  std::uint32_t held_count_ = 0;
  int reported_ = 0;
  Instant window_end_ = kLongAgo;
};

}  // namespace axisgate::canopen
