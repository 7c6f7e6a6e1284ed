// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/resync.hpp"

#include <algorithm>

namespace axisgate::drive {
namespace {

std::uint8_t registers_of(std::uint8_t bytes) { return bytes > 2 ? 2 : 1; }

// A reply names what was asked for; which of the values in it was meant (Keya: by their bytes) it does not tell.
bus::ObjectAddress named_by_reply(bus::ObjectAddress object) {
  object.byte = 0;
  return object;
}

}  // namespace

std::uint8_t registers_of(const bus::Exchange& exchange) {
  if (exchange.more.empty()) return registers_of(exchange.size);
  const bus::Neighbour& last = exchange.more.back();
  return static_cast<std::uint8_t>(last.object.index - exchange.object.index + registers_of(last.size));
}

Resync::Likeness Resync::of(const bus::Exchange& exchange) const {
  if (!facts_.by_length) return {named_by_reply(exchange.object), 0};
  // The reply to a write has a function code of its own: no read's reply is like it.
  return {{}, exchange.access == bus::Access::write ? std::uint8_t{0} : registers_of(exchange)};
}

Resync::Likeness Resync::of(const ResyncRead& read) const {
  const ObjectDef& object = objects_[read.object];
  if (!facts_.by_length) return {named_by_reply(object.address), 0};
  return {{}, read.registers != 0 ? read.registers : registers_of(object.size)};
}

void Resync::lost(const bus::Exchange& exchange, Instant now) {
  suspect_ = true;
  last_lost_ = now;
  const Likeness like = of(exchange);
  if (std::find(lost_.begin(), lost_.end(), like) == lost_.end() && lost_.size() < kMaxLost) lost_.push_back(like);
}

std::optional<ResyncRead> Resync::candidate() const {
  for (const ResyncRead& read : facts_.candidates)
    if (std::find(lost_.begin(), lost_.end(), of(read)) == lost_.end()) return read;
  return std::nullopt;
}

}  // namespace axisgate::drive
