// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/owed_stop.hpp"

#include <algorithm>

namespace axisgate::drive {

void OwedStop::accepted(StopKind stop, std::uint64_t exchange) {
  if (!stop_ || stop != StopKind::halt) stop_ = stop;
  by_loss_ = by_loss_ || away_;
  sent_ = false;
  read_enabled_ = false;
  not_before_ = kLongAgo;
  after_ = std::max(after_, exchange);
}

OwedStop::End OwedStop::attempted(StopKind stop, bool shown, std::uint64_t exchange, Instant now) {
  if (!stop_) return End::none;
  if (shown && stop >= *stop_) return discharge(End::shown);
  read_enabled_ = false;
  after_ = std::max(after_, exchange);
  not_before_ = now + kPace;
  return End::none;
}

OwedStop::End OwedStop::state_read(model::State402 state, std::uint64_t exchange, bool turns) {
  if (!stop_ || exchange <= after_) return End::none;
  switch (state) {
    case model::State402::operation_enabled:
      read_enabled_ = true;
      return End::none;
    case model::State402::quick_stop_active:
      // It stands, or will, and holds its torque: less than a disable asks for.
      if (sent_ && !turns && *stop_ != StopKind::disable) return discharge(End::shown);
      read_enabled_ = true;
      return End::none;
    case model::State402::fault_reaction_active:
      return End::none;  // a stop of the drive's own; what comes of it the next read tells
    case model::State402::not_ready_to_switch_on:
    case model::State402::switch_on_disabled:
    case model::State402::ready_to_switch_on:
    case model::State402::switched_on:
    case model::State402::fault:
      break;
  }
  if (turns) {
    read_enabled_ = true;
    return End::none;
  }
  return discharge(End::disabled);
}

OwedStop::End OwedStop::enabled_later() { return stop_ && !gates() ? discharge(End::enabled) : End::none; }

OwedStop::End OwedStop::started_later() { return halts() ? enabled_later() : End::none; }

void OwedStop::link_lost(Instant heard, std::uint64_t exchange) {
  if (!away_) heard_ = heard;
  away_ = true;
  read_enabled_ = false;
  after_ = std::max(after_, exchange);
  by_loss_ = by_loss_ || stop_;
}

void OwedStop::link_back(Instant now) {
  if (!away_) return;
  away_ = false;
  uncertain_ = uncertain_ || (stop_ && now - heard_ > kShortLoss);
}

std::optional<StopKind> OwedStop::due(Instant now) const {
  if (!stop_ || away_ || !read_enabled_ || now < not_before_) return std::nullopt;
  return *stop_ == StopKind::halt && uncertain_ ? StopKind::quick_stop : *stop_;
}

OwedStop::End OwedStop::discharge(End how) {
  stop_.reset();
  by_loss_ = uncertain_ = sent_ = read_enabled_ = false;
  not_before_ = kLongAgo;
  return how;
}

}  // namespace axisgate::drive
