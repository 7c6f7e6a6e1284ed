// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_can_client.hpp"

#include <cassert>
#include <utility>

namespace axisgate::keya {

CanMessage CanClient::begin(const bus::Exchange& exchange) {
  assert(!outstanding_);
  outstanding_ = exchange;
  return request_of(exchange);
}

CanClient::Heard CanClient::take(std::uint8_t node, Bytes bytes, Instant now) {
  const auto message = decode(bytes);
  if (!message || message->command != CanMessage::Command::reply) return {Heard::What::bad};
  Drive& drive = drives_.at(node);
  if (!outstanding_ || outstanding_->node != node || !answers(*message, *outstanding_))
    return not_mine(drive, *message, now);
  const bus::Exchange exchange = *std::exchange(outstanding_, std::nullopt);
  drive.finished = Finished{exchange, now};
  return {Heard::What::mine, result_of(*message, exchange)};
}

// One more than was asked for; but where an earlier request was given up, the first one may have been its answer.
CanClient::Heard CanClient::not_mine(Drive& drive, const CanMessage& message, Instant now) const {
  const bool again =
      drive.finished && now - drive.finished->at <= duplicate_window_ && answers(message, drive.finished->exchange);
  if (again && drive.owed == 0) return {Heard::What::second_reply};
  if (drive.owed > 0) --drive.owed;
  return {Heard::What::late};
}

void CanClient::abandon() {
  if (!outstanding_) return;
  Drive& drive = drives_.at(outstanding_->node);
  if (drive.owed < UINT8_MAX) ++drive.owed;
  outstanding_.reset();
}

void CanClient::reset() {
  outstanding_.reset();
  drives_.fill({});
}

}  // namespace axisgate::keya
