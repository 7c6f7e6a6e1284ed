// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/node_start.hpp"

namespace axisgate::drive {

bool NodeStart::has_left(bus::NodeState state, Instant now) const {
  const bool elsewhere = state == bus::NodeState::pre_operational || state == bus::NodeState::stopped;
  return elsewhere && !left_ && now - commanded_at_ > kNmtSettles;
}

Duration NodeStart::leave(Instant now) {
  if (now - commanded_at_ > kStartHeld) backoff_.reset();
  const Duration pause = backoff_.next();
  due_ = now + pause;
  left_ = true;
  return pause;
}

}  // namespace axisgate::drive
