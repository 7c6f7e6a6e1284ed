// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/can_bus_off_plan.hpp"

#include <algorithm>

#include "gateway/core/name_table.hpp"

namespace axisgate::can {

void BusOffPlan::on_errors(const CanErrors& errors, Instant now, CanTrouble& trouble) {
  ++trouble.error_frames;
  if (errors.receive_overflow) ++trouble.lost_in;
  if (errors.no_ack) ++trouble.no_ack;
  if (errors.error_passive && !passive_) ++trouble.error_passive;
  if (errors.bus_off) {
    ++trouble.bus_offs;
    on_bus_off(now);
  }
  // Drivers that restart by themselves may tell the new state alone.
  if (errors.restarted || errors.error_active) bus_off_ = false;
  const bool recovered = errors.error_active || errors.restarted || errors.error_warning;
  if (errors.error_passive) {
    passive_ = true;
  } else if (recovered) {
    passive_ = false;
  }
  if (errors.no_ack) last_no_ack_ = now;
  judge_acknowledgement(now);
}

void BusOffPlan::on_bus_off(Instant now) {
  const Instant oldest = bus_offs_.front();
  std::rotate(bus_offs_.begin(), bus_offs_.begin() + 1, bus_offs_.end());
  bus_offs_.back() = now;
  bus_off_ = true;
  const bool too_many = oldest != kLongAgo && now - oldest <= kWindow;
  if (too_many || now < given_up_until_) given_up_until_ = now + kWindow;
}

void BusOffPlan::judge_acknowledgement(Instant now) {
  const bool missing = last_no_ack_ != kLongAgo && now - last_no_ack_ <= kNoAckQuiet;
  if (!passive_ || !missing) {
    no_ack_since_ = kNever;
    queue_full_ = false;
  } else if (no_ack_since_ == kNever) {
    no_ack_since_ = now;
  }
}

void BusOffPlan::on_frame() {
  last_no_ack_ = kLongAgo;
  no_ack_since_ = kNever;
  queue_full_ = false;
}

void BusOffPlan::on_restart() {
  bus_off_ = false;
  passive_ = false;
  on_frame();
}

BusOffPlan::Health BusOffPlan::health(Instant now) const {
  if (now < given_up_until_) return Health::given_up;
  if (bus_off_) return Health::bus_off;
  if (no_ack_since_ == kNever || now - last_no_ack_ > kNoAckQuiet) return Health::usable;
  return queue_full_ || now - no_ack_since_ >= kNoAckPersists ? Health::no_ack : Health::usable;
}

Instant BusOffPlan::due(Instant now) const {
  Instant next = kNever;
  const auto consider = [&next, now](Instant at) {
    if (at > now) next = std::min(next, at);
  };
  consider(given_up_until_);
  if (no_ack_since_ != kNever) {
    consider(no_ack_since_ + kNoAckPersists);
    consider(last_no_ack_ + kNoAckQuiet + Duration(1));
  }
  return next;
}

std::string text(BusOffPlan::Health health) {
  using enum BusOffPlan::Health;
  static constexpr auto kTexts = names_of<BusOffPlan::Health>({
      {usable, "usable"},
      {no_ack, "nobody acknowledges: check the cable, the power of the drives and the bit rate"},
      {bus_off, "bus-off: check bit rate, termination and wiring; back when the controller is restarted"},
      {given_up,
       "bus-off more than 5 times in a minute: check bit rate, termination and wiring; tried again after a minute "
       "without bus-off, or when the interface is taken down and up"},
  });
  static_assert(kTexts.has_all_to(given_up));
  return std::string(kTexts.of(health));
}

}  // namespace axisgate::can
