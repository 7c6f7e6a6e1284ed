// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/outgoing_wire.hpp"

#include <algorithm>

namespace axisgate::simulated {

Time byte_time(std::uint32_t baud, std::size_t bytes) {
  if (baud == 0) return Time{};
  return Time{static_cast<std::int64_t>(bytes) * 10'000'000'000 / baud};
}

Time OutgoingWire::send_behind_glitch(Time ready, Chunk chunk, const DriveFaults& faults) {
  std::vector<std::uint8_t> glitch(faults.glitch_bytes, faults.glitch_value);
  if (faults.glitch_lead == Time{}) {
    chunk.bytes.insert(chunk.bytes.begin(), glitch.begin(), glitch.end());
  } else {
    const Time length = byte_time(baud_, glitch.size());
    send(ready, {0, ByteOrigin::noise, chunk.drive, std::move(glitch)});
    ready += length + faults.glitch_lead;
  }
  send(ready, std::move(chunk));
  return ready;
}

std::optional<Time> OutgoingWire::next_event() const {
  std::optional<Time> next;
  for (const Queue* queue : {&waiting_, &arriving_}) {
    if (queue->empty()) continue;
    const Time first = queue->begin()->first.first;
    next = next ? std::min(*next, first) : first;
  }
  return next;
}

void OutgoingWire::begin() {
  auto node = waiting_.extract(waiting_.begin());
  free_at_ = std::max(free_at_, node.key().first) + byte_time(baud_, node.mapped().bytes.size());
  arriving_.emplace(std::pair{free_at_, ++chunks_}, std::move(node.mapped()));
}

void OutgoingWire::forget(std::size_t drive) {
  std::erase_if(waiting_, [drive](const auto& entry) { return entry.second.drive == drive; });
}

}  // namespace axisgate::simulated
