#include "tests/simulated/journal.hpp"

#include <utility>

namespace axisgate::simulated {

void Journal::mix(std::uint64_t value) {
  for (int i = 0; i < 8; ++i) {
    hash_ ^= (value >> (8 * i)) & 0xFFU;
    hash_ *= 0x100000001B3U;
  }
}

void Journal::record(Exchange exchange) {
  ++recorded_;
  mix(exchange.tag);
  mix(static_cast<std::uint64_t>(exchange.received.count()));
  mix(exchange.station);
  for (const std::uint8_t byte : exchange.request) mix(byte);
  mix(static_cast<std::uint64_t>(exchange.reply_ready.count()));
  mix(exchange.sent.size());
  for (const std::uint8_t byte : exchange.sent) mix(byte);
  if (capacity_ == 0) return;
  if (entries_.size() == capacity_) entries_.pop_front();
  entries_.push_back(std::move(exchange));
}

}  // namespace axisgate::simulated
