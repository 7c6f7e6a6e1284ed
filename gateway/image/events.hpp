// SPDX-License-Identifier: Apache-2.0
// The ring of events and alarms: the newest 1,000, which log, DDS and web read.
// Promises that nothing waits for a reader and that a reader can tell how many it has missed.
// Never decides anything.
#pragma once

#include <array>
#include <boost/circular_buffer.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "gateway/core/clock.hpp"
#include "gateway/core/log.hpp"
#include "gateway/image/axis_image.hpp"

namespace axisgate {

enum class EventKind : std::uint8_t { fault, warning, link, lease, homed, boot, command, position_wrapped };
inline constexpr std::size_t kEventKinds = static_cast<std::size_t>(EventKind::position_wrapped) + 1;
[[nodiscard]] std::string_view text(EventKind kind);

/// In the text of a command event: a stop by somebody who does not own the axis, while somebody does.
inline constexpr std::string_view kByAnother = ", which does not own the axis";

struct Event {
  std::uint64_t number = 0;  ///< counts from 1
  Instant at = kLongAgo;
  AxisNumber axis = 0;  ///< 0: the gateway or a bus
  EventKind kind = EventKind::link;
  std::uint32_t code = 0;
  std::string text;
  bool asked_for = false;  ///< by a person, of this process itself: no line of it is left out of the log
};

inline constexpr std::size_t kMaxEvents = 1000;

class EventRing {
 public:
  /// `on_event` sees each event once, as it is added (the log).
  explicit EventRing(std::function<void(const Event&)> on_event = {}) : on_event_(std::move(on_event)) {}
  void add(Instant at, AxisNumber axis, EventKind kind, std::uint32_t code, std::string text, bool asked_for = false);
  [[nodiscard]] const boost::circular_buffer<Event>& events() const { return events_; }
  [[nodiscard]] std::uint64_t added() const { return added_; }
  /// The same by kind.
  using ByKind = std::array<std::uint64_t, kEventKinds>;
  [[nodiscard]] const ByKind& added_by_kind() const { return added_by_kind_; }

 private:
  boost::circular_buffer<Event> events_{kMaxEvents};
  std::uint64_t added_ = 0;
  ByKind added_by_kind_{};
  std::function<void(const Event&)> on_event_;
};

}  // namespace axisgate
