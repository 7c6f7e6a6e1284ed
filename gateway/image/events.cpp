// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/events.hpp"

#include <utility>

#include "gateway/core/name_table.hpp"

namespace axisgate {

std::string_view text(EventKind kind) {
  using enum EventKind;
  static constexpr auto kNames = names_of<EventKind>({
      {fault, "fault"},
      {warning, "warning"},
      {link, "link"},
      {lease, "lease"},
      {homed, "homed"},
      {boot, "boot"},
      {command, "command"},
      {position_wrapped, "position_wrapped"},
  });
  static_assert(kNames.has_all_to(position_wrapped));
  return kNames.of(kind);
}

void EventRing::add(Instant at, AxisNumber axis, EventKind kind, std::uint32_t code, std::string text, bool asked_for) {
  ++added_by_kind_[static_cast<std::size_t>(kind)];
  events_.push_back(Event{++added_, at, axis, kind, code, std::move(text), asked_for});
  if (on_event_) on_event_(events_.back());
}

}  // namespace axisgate
