// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/feed/axis_feed.hpp"

#include <algorithm>

namespace axisgate::feed {

void AxisFeed::place(Place& place, Instant at) {
  queue_.erase(place.turn);
  place.turn.at = at;
  place.turn.order = ++order_;
  queue_.insert(place.turn);
}

void AxisFeed::add(AxisNumber axis, Instant now) {
  Place& added = places_[axis];
  added.turn.axis = axis;
  place(added, now);
}

void AxisFeed::remove(AxisNumber axis) {
  const auto found = places_.find(axis);
  if (found == places_.end()) return;
  queue_.erase(found->second.turn);
  places_.erase(found);
}

void AxisFeed::changed(AxisNumber axis, Instant now) {
  const auto found = places_.find(axis);
  if (found == places_.end()) return;
  const Instant due = std::max(now, found->second.sent + min_period_);
  // It keeps a turn that it has already.
  if (due < found->second.turn.at) place(found->second, due);
}

void AxisFeed::all_due(Instant now) {
  for (auto& [axis, each] : places_) place(each, now);
}

std::optional<AxisNumber> AxisFeed::next(Instant now) {
  if (due() > now) return std::nullopt;
  const AxisNumber axis = queue_.begin()->axis;
  Place& sent = places_.at(axis);
  sent.sent = now;
  place(sent, now + max_period_);
  return axis;
}

std::size_t AxisFeed::waiting(Instant now) const {
  const auto later = std::ranges::find_if(queue_, [now](const Turn& turn) { return turn.at > now; });
  return static_cast<std::size_t>(std::distance(queue_.begin(), later));
}

}  // namespace axisgate::feed
