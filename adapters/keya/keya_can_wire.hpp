// SPDX-License-Identifier: Apache-2.0
// Keya's own protocol on a CAN link, as the bus sees it: requests out, answers back, heartbeats as unsolicited events.
// Promises at most one reply per send(), none after abandon() or a loss of the link, and none but to the request that
// asked for it (node, index, sub-index); that what drives send unsolicited is reported in order and within bounds.
// Never queues or repeats a request, and never judges a value.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/wire.hpp"
#include "adapters/can/can_link.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::keya {

struct KeyaCanSettings {
  std::string name;                 ///< the bus's, for the log
  std::vector<std::uint8_t> nodes;  ///< from 1; each once
  Duration timeout =
      std::chrono::milliseconds(100);  ///< of an exchange: two of them tell the second reply of a duplicate node-ID
};

/// What the wire says of an exchange, beside wire.hpp's rules:
/// - What the protocol cannot say (keya_can_exchange.hpp) is refused_by_drive in the next turn of the loop, with
///   CiA 301's code for it; nothing is sent.
/// - The drive has no error answer: what it does not know or take, it leaves unanswered.
/// - `babbling` carries the upper 16 bits of the id: 0x0580 for replies, 0x0700 for heartbeats.
/// The link is started with the reply and heartbeat ids of `nodes` as its filters. `runtime` and `log` must outlive the
/// wire.
[[nodiscard]] std::unique_ptr<bus::Wire> make_keya_can_wire(KeyaCanSettings settings,
                                                            std::unique_ptr<can::CanLink> link, Runtime& runtime,
                                                            const Log& log);

}  // namespace axisgate::keya
