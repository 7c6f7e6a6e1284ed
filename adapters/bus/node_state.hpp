// SPDX-License-Identifier: Apache-2.0
// The NMT states of CiA 301 as people read them, in the log of frames and in events.
// Promises one word for each state. Never used to decide anything.
#pragma once

#include <string_view>

#include "adapters/bus/exchange.hpp"

namespace axisgate::bus {

[[nodiscard]] constexpr std::string_view text(NodeState state) {
  switch (state) {
    case NodeState::stopped:
      return "stopped";
    case NodeState::pre_operational:
      return "pre-operational";
    case NodeState::operational:
      return "operational";
    case NodeState::unknown:
      break;
  }
  return "passing state";
}

}  // namespace axisgate::bus
