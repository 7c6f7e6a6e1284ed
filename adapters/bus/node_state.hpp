// SPDX-License-Identifier: Apache-2.0
// The NMT states of CiA 301 as people read them, in the log of frames and in events.
// Promises one word for each state. Never used to decide anything.
#pragma once

#include <string_view>

#include "adapters/bus/exchange.hpp"
#include "gateway/core/name_table.hpp"

namespace axisgate::bus {

[[nodiscard]] constexpr std::string_view text(NodeState state) {
  return names_of<NodeState>({{NodeState::stopped, "stopped"},
                              {NodeState::pre_operational, "pre-operational"},
                              {NodeState::operational, "operational"}})
      .of(state, "passing state");
}

}  // namespace axisgate::bus
