// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/node_presence.hpp"

#include <utility>

namespace axisgate::drive {

void NodePresence::on_link(bool up, Instant now) {
  timeouts_ = 0;
  heard_ = asked_ = false;
  state_ = bus::NodeState::unknown;
  backoff_.reset();
  look_due_ = up ? now : kNever;  // where a reply is still owed, the probe keeps silence first
}

void NodePresence::on_started() {
  heard_ = true;
  state_ = bus::NodeState::pre_operational;
  timeouts_ = 0;
}

bool NodePresence::on_present(bus::NodeState state) {
  const bool heard_before = std::exchange(heard_, true);
  return std::exchange(state_, state) != state || !heard_before;
}

void NodePresence::on_gone(bool was_there) {
  heard_ = false;
  if (!was_there) return;
  timeouts_ = 0;
  backoff_.reset();
}

NodePresence::Look NodePresence::look(bool first) {
  if (is_node_ && heard_ && state_ == bus::NodeState::stopped) return Look::wake;
  // A call that nobody has answered is a timeout as well, but it kept nobody from the wire.
  if (first && !heard_ && calls_ > 0 && ++timeouts_ >= kMaxTimeouts) return Look::give_up;
  return is_node_ && asked_ && !heard_ && calls_ < kCallsPerQuestion ? Look::call : Look::ask;
}

void NodePresence::called(Instant now) {
  ++calls_;
  look_later(now);
}

void NodePresence::asked() {
  asked_ = true;
  calls_ = 0;
}

}  // namespace axisgate::drive
