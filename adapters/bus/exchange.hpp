// The exchange: one request frame to one drive and its answer, in words that hold for every protocol.
// Promises that whatever an adapter sends or hears can be said with these types; a reply is a list of object and raw
// value. Never knows units, quantities or axes: the drive profile gives those a meaning.
#pragma once

#include <boost/container/static_vector.hpp>
#include <compare>
#include <cstdint>

#include "gateway/core/clock.hpp"
#include "gateway/core/error.hpp"

namespace axisgate::bus {

/// An object inside a drive: CiA 301 index and sub-index on CANopen and Kinco's serial protocol; the register and 0 on
/// Modbus RTU; index and sub on Keya's CAN; 0x2100 + query code and the field's number on Keya's serial protocols.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  friend auto operator<=>(const ObjectAddress&, const ObjectAddress&) = default;
};

enum class Access : std::uint8_t { read, write };

/// The longest list one answer can carry: a run of 26 registers (iD286pro) as 16-bit fields.
inline constexpr std::size_t kMaxReplyFields = 26;

/// Another object that the same request reads.
struct Neighbour {
  ObjectAddress object;
  std::uint8_t size = 0;  ///< bytes: 1, 2 or 4
  friend bool operator==(const Neighbour&, const Neighbour&) = default;
};

struct Exchange {
  std::uint8_t node = 0;  ///< station, unit or node-ID
  Access access = Access::read;
  ObjectAddress object;
  std::uint8_t size = 0;  ///< bytes: 1, 2 or 4; 0 in a read: as many as the drive has
  std::uint32_t raw = 0;  ///< value to write, in the low `size` bytes
  /// Modbus RTU, reads alone: objects at higher registers than `object`, ascending, read in one request from the first
  /// register of `object` to the last of the last; registers between that are nobody's are read and dropped.
  boost::container::static_vector<Neighbour, kMaxReplyFields - 1> more{};
  friend bool operator==(const Exchange&, const Exchange&) = default;
};

struct ReplyField {
  ObjectAddress object;
  std::uint8_t size = 0;  ///< bytes the drive sent: 1, 2 or 4
  std::uint32_t raw = 0;  ///< in the low `size` bytes, not sign-extended
  friend bool operator==(const ReplyField&, const ReplyField&) = default;
};

using ReplyFields = boost::container::static_vector<ReplyField, kMaxReplyFields>;

/// How an exchange ended. `ok`: fields of a read (none for a write). `refused_by_drive`: `detail` is the drive's code.
/// `timed_out`, `link_lost`, `bad_reply`: whether the drive acted is unknown.
struct ExchangeResult {
  Errc code = Errc::ok;
  std::uint32_t detail = 0;
  ReplyFields fields{};
  /// refused_by_drive: not now, but perhaps later (busy, under local control). Else the drive does not have the object.
  bool for_now = false;
  friend bool operator==(const ExchangeResult&, const ExchangeResult&) = default;
};

}  // namespace axisgate::bus
