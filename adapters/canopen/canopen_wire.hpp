// SPDX-License-Identifier: Apache-2.0
// CANopen (CiA 301) on a CAN link, as the bus sees it: SDO requests out, answers back; beside them NMT, heartbeats,
// guarding, EMCY, process data and SYNC.
// Promises at most one reply per send(), none after abandon() or a loss of the link, and none but to the request that
// asked for it (node, command, index, sub-index, toggle); that a transfer given up is aborted at the server; that what
// nodes send unsolicited is reported in order and within bounds.
// Never queues or repeats a request, and never judges a value.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/wire.hpp"
#include "adapters/can/can_link.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::canopen {

/// What the wire must know of a drive before it speaks to it.
struct CanopenNode {
  std::uint8_t node = 1;  ///< 1 to 126
  Duration heartbeat{};   ///< the period it is configured to send one in; 0: none is expected
  Duration guard_time{};  ///< node guarding by us, this often; 0: none
  std::uint8_t life_factor = 3;
  bool sdo_block = false;  ///< its server offers block transfer
};

struct CanopenSettings {
  std::string name;             ///< the bus's, for the log
  std::uint8_t own_node = 127;  ///< whose heartbeat ours is
  Duration own_heartbeat{};     ///< 0: none is sent
  Duration sync{};              ///< SYNC is sent this often; 0: never
  Duration timeout =
      std::chrono::milliseconds(100);  ///< of an SDO exchange: two of them tell the second reply of a duplicate node-ID
  std::vector<CanopenNode> nodes;
};

/// What the wire says of an exchange, beside wire.hpp's rules:
/// - An NMT command is sent at once and ends ok in the next turn of the loop.
/// - A value comes with the width that the drive sent, whatever was asked for: the profile's type judges it. Where the
///   drive says no width, it is the one of Exchange::unsaid.
/// - Part::whole of an object that is longer than four bytes, or has three: refused, detail 0x06070010.
/// - An object over kMaxObjectBytes: refused, detail 0x05040005, and not `for_now`.
/// - Wrong CRC, a length other than the server said, blocks that never arrive: bad_reply; the detail is the abort sent.
/// - Part::next where no such chain is open (something else was done with the node): refused for now, 0x08000022.
/// - A node that has restarted answers nothing any more: `started` is reported, the exchange is left to the bus,
///   and its process data are dropped until they are mapped again.
/// A node whose server has no block transfer after all, or wants longer blocks, is served in segments. Of our own
/// heartbeat only the very first comes behind a boot-up: after a loss of the link we have not restarted.
/// `runtime` and `log` must outlive the wire. Each node may be named once.
[[nodiscard]] std::unique_ptr<bus::Wire> make_canopen_wire(CanopenSettings settings, std::unique_ptr<can::CanLink> link,
                                                           Runtime& runtime, const Log& log);

}  // namespace axisgate::canopen
