// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/events.hpp"

#include <utility>

namespace axisgate {

std::string_view text(EventKind kind) {
  switch (kind) {
    case EventKind::fault:
      return "fault";
    case EventKind::warning:
      return "warning";
    case EventKind::link:
      return "link";
    case EventKind::lease:
      return "lease";
    case EventKind::homed:
      return "homed";
    case EventKind::boot:
      return "boot";
    case EventKind::command:
      return "command";
    case EventKind::position_wrapped:
      return "position_wrapped";
  }
  return "?";
}

void EventRing::add(Instant at, AxisNumber axis, EventKind kind, std::uint32_t code, std::string text, bool asked_for) {
  events_.push_back(Event{++added_, at, axis, kind, code, std::move(text), asked_for});
  if (on_event_) on_event_(events_.back());
}

}  // namespace axisgate
