// SPDX-License-Identifier: Apache-2.0
// The exchange: one request frame to one drive and its answer, in words that hold for every protocol.
// Promises that whatever an adapter sends or hears can be said with these types; a reply is a list of object and raw
// value. Never knows units, quantities or axes: the drive profile gives those a meaning.
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "gateway/core/bytes.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/core/error.hpp"
#include "gateway/core/object_address.hpp"

namespace axisgate::bus {

enum class Access : std::uint8_t {
  read,
  write,
  command,  ///< CANopen: an NMT command, `raw` is its code. Nobody answers it: it ends ok when it was sent
};

/// An object longer than 4 bytes is carried by a chain of exchanges (CANopen: segmented or block SDO), all with the
/// same node, access and object. Between two of them the wire is free for other nodes.
enum class Part : std::uint8_t {
  whole,  ///< no chain: 4 bytes at most; a reply that would be longer is refused
  first,  ///< begins one; ExchangeResult::more tells whether it is over already
  next,   ///< goes on with the one that is open
};

/// The longest list one answer can carry: a run of 26 registers (iD286pro) as 16-bit fields.
inline constexpr std::size_t kMaxReplyFields = 26;

/// Another object that the same request reads or writes.
struct Neighbour {
  ObjectAddress object;
  std::uint8_t size = 0;  ///< bytes: 1, 2 or 4
  std::uint32_t raw = 0;  ///< of a write: its value, in the low `size` bytes
  friend bool operator==(const Neighbour&, const Neighbour&) = default;
};

struct Exchange {
  std::uint8_t node = 0;  ///< station, unit or node-ID
  Access access = Access::read;
  ObjectAddress object;
  std::uint8_t size = 0;  ///< bytes: 1, 2 or 4; 0 in a read: as many as the drive has
  std::uint32_t raw = 0;  ///< value to write, in the low `size` bytes
  /// Modbus RTU: objects at higher registers than `object`, ascending, read in one request from the first
  /// register of `object` to the last of the last; registers between that are nobody's are read and dropped. Of a
  /// write each begins where the one before ends, and all are written at once or none is.
  /// Keya reads: objects of the same index and sub, in the order of their bytes. Keya's serial protocols, writes: the
  /// other fields of the one control frame, which carries the whole desired state of both motors each time.
  boost::container::static_vector<Neighbour, kMaxReplyFields - 1> more{};
  /// Any other exchange with a node that has a chain open ends that chain (CiA 301: abort 0x08000022).
  Part part = Part::whole;
  ObjectBytes bytes{};  ///< Part::first of a write: all that is written, in the object's own order
  /// CANopen reads: the bytes of an answer that does not say how many it has; 0: `size` of them, or else four.
  std::uint8_t unsaid = 0;
  /// Writes: of the object these bits alone become `raw`, whose lowest bit is the lowest of them; the bus reads the
  /// others just before, in the same turn. 0: all of it is written.
  std::uint32_t mask = 0;
  friend bool operator==(const Exchange&, const Exchange&) = default;
};

struct ReplyField {
  ObjectAddress object;
  std::uint8_t size = 0;  ///< bytes the drive sent: 1, 2 or 4
  std::uint32_t raw = 0;  ///< in the low `size` bytes, not sign-extended
  friend bool operator==(const ReplyField&, const ReplyField&) = default;
};

using ReplyFields = boost::container::static_vector<ReplyField, kMaxReplyFields>;

/// How an exchange ended. `ok`: fields of a read (none for a write). A request that no reply is documented for (Keya's
/// serial control frame) ends ok when its last byte has left: that the drive has taken it is not known by that.
/// `refused_by_drive`: `detail` is the drive's code. `timed_out`, `link_lost`, `bad_reply`: whether the drive acted is
/// unknown.
struct ExchangeResult {
  Errc code = Errc::ok;
  std::uint32_t detail = 0;
  ReplyFields fields{};
  /// refused_by_drive: not now, but perhaps later (busy, under local control). Else the drive does not have the object,
  /// if it has answered any other rightly.
  bool for_now = false;
  bool more = false;    ///< of a chain: it goes on with Part::next
  ObjectBytes bytes{};  ///< at the end of a chain that read, where the object did not fit a field
  friend bool operator==(const ExchangeResult&, const ExchangeResult&) = default;
};

/// An abort code (CiA 301 section 7.2.4.3.17) that says what the drive has: it does not know the command, the object
/// (0602 xxxx) or the sub-index. Every other may pass: the drive starts, is busy, or under somebody else's control.
[[nodiscard]] constexpr bool abort_may_pass(std::uint32_t code) {
  return code != 0x05040001 && code >> 16 != 0x0602 && code != 0x06090011;
}

/// CiA 301 section 7.2.8.3.1: what Access::command may carry.
enum class NmtCommand : std::uint8_t {
  start = 0x01,
  stop = 0x02,
  enter_pre_operational = 0x80,
  reset_node = 0x81,
  reset_communication = 0x82,
};

/// CiA 301 NMT states, as far as somebody outside can see them.
enum class NodeState : std::uint8_t { unknown, stopped, pre_operational, operational };

/// What a drive says without being asked.
struct UnsolicitedEvent {
  enum class Kind : std::uint8_t {
    started,         ///< it has just started: whatever it held is gone (CANopen boot-up)
    present,         ///< it is there, in `state`: at its first sign of life, at each change, and at
                     ///< each sign of another state than operational
    gone,            ///< its heartbeat is overdue, or guarding it was not answered
    values,          ///< `fields`: process data, as map_process_data() has named it
    emergency,       ///< CiA 301 EMCY: `code`, `error_register`, `vendor`; `repeats` more like it were left out before
    duplicate_node,  ///< two devices answer to this number
    foreign_write,   ///< it acknowledges a write that nobody here waits for: another master's, or a late answer to ours
    stranger,        ///< another node is heard, `code`, that is none of the bus's: of each drive, once
    babbling,        ///< it floods the bus: `code` is the COB-ID
  };
  Kind kind = Kind::present;
  std::uint8_t node = 0;
  NodeState state = NodeState::unknown;
  std::uint16_t code = 0;
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> vendor{};
  std::uint32_t repeats = 0;
  ReplyFields fields{};
  friend bool operator==(const UnsolicitedEvent&, const UnsolicitedEvent&) = default;
};

/// What one process data object of a node carries, in its order (CANopen: a TPDO holds 8 bytes).
using ProcessMap = boost::container::static_vector<Neighbour, 8>;

}  // namespace axisgate::bus
