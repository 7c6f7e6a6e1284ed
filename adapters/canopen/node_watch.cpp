// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/node_watch.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::canopen {

void NodeWatch::forget() {
  present_ = false;
  state_ = bus::NodeState::unknown;
  heartbeat_due_ = kNever;
  unanswered_ = false;
  misses_ = 0;
  next_toggle_.reset();
}

void NodeWatch::link_up(Instant now) {
  forget();
  called_ = false;
  if (guarded()) guard_due_ = now;
}

void NodeWatch::link_down() {
  forget();
  guard_due_ = kNever;
}

bus::UnsolicitedEvent NodeWatch::unsolicited(bus::UnsolicitedEvent::Kind kind) const {
  return {.kind = kind, .node = settings_.node, .state = state_};
}

std::optional<boost::container::static_vector<bus::UnsolicitedEvent, 1>> NodeWatch::on_error_control(
    const ErrorControl& heard, Instant now) {
  boost::container::static_vector<bus::UnsolicitedEvent, 1> told;
  if (heard.boot_up) {
    // What it was told before is gone, its heartbeat period too: the next one heard begins the watch anew.
    forget();
    present_ = true;
    called_ = false;
    state_ = heard.state;
    next_toggle_ = false;
    told.push_back(unsolicited(bus::UnsolicitedEvent::Kind::started));
    return told;
  }
  if (guarded()) {
    const bool changed = next_toggle_.value_or(heard.toggle) == heard.toggle;
    next_toggle_ = !heard.toggle;
    if (!changed) return std::nullopt;
    unanswered_ = false;
    misses_ = 0;
  }
  expect_heartbeat(now);
  const bool news = !std::exchange(present_, true) || state_ != heard.state;
  state_ = heard.state;
  const bool not_operational = state_ == bus::NodeState::stopped || state_ == bus::NodeState::pre_operational;
  if (std::exchange(called_, false) || news || not_operational)
    told.push_back(unsolicited(bus::UnsolicitedEvent::Kind::present));
  return told;
}

void NodeWatch::expect_heartbeat(Instant now) {
  if (settings_.heartbeat > Duration::zero()) heartbeat_due_ = now + settings_.heartbeat * 3 / 2 + kHeartbeatGrace;
}

void NodeWatch::on_flood(Instant now) {
  if (heartbeat_due_ != kNever) expect_heartbeat(now);
  unanswered_ = false;
  misses_ = 0;
}

NodeWatch::Due NodeWatch::on_deadline(Instant now) {
  Due due;
  bool missing = now >= heartbeat_due_;
  if (now >= guard_due_) {
    if (unanswered_) ++misses_;
    missing = missing || misses_ >= std::max<int>(1, settings_.life_factor);
    guard_due_ += settings_.guard_time;
    if (guard_due_ <= now) guard_due_ = now + settings_.guard_time;
    due.guard = true;
  }
  if (missing) {
    due.gone = present_;
    forget();
  }
  if (due.guard) unanswered_ = true;
  return due;
}

Instant NodeWatch::next_deadline() const { return std::min(heartbeat_due_, guard_due_); }

}  // namespace axisgate::canopen
