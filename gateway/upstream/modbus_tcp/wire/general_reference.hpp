// SPDX-License-Identifier: Apache-2.0
// The codec of the CANopen general reference (function 43, MEI type 13): one object of one drive, by index and
// sub-index (MODBUS Application Protocol V1.1b3 6.20 and annex B, CiA 309-2). Promises that a decoded request is whole,
// and that a reply repeats its header byte by byte. Never knows whether there is such an axis or object.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "gateway/core/bytes.hpp"
#include "gateway/core/error.hpp"
#include "gateway/upstream/modbus_tcp/wire/mbap.hpp"

namespace axisgate::modbus_tcp {

inline constexpr std::uint8_t kGeneralReference = 13;  ///< MEI type

/// Function, MEI type, two control bytes, a reserved one, counter, network, encoding, node, index, sub-index, start.
inline constexpr std::size_t kMaxReferenceHead = 14;

struct GeneralReference {
  boost::container::static_vector<Byte, kMaxReferenceHead> head;  ///< the request up to its `count`
  bool write = false;
  bool more_follows = false;  ///< the extend flag: a part of a write, and not its last
  std::uint16_t node = 0;     ///< the axis: node number, and the network id as the high byte
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  std::uint16_t start = 0;  ///< offset in the object, bytes
  std::uint16_t count = 0;  ///< bytes: of a write those that follow, of a read those wanted, 0 all there are

  /// Where the data of a write begins in its request, and that of a read in its reply.
  [[nodiscard]] std::size_t data_at() const { return head.size() + 2; }
};

/// `pdu` begins with 2B 0D. No value: exception 0x03. That is a header that is not whole; reserved bits or a reserved
/// byte other than 0, since what they may mean is not known; in a read, the extend flag, a control of two bytes, or
/// data; in a write, another number of bytes than `count` or none at all.
[[nodiscard]] std::optional<GeneralReference> decode_reference(Bytes pdu);

/// So many bytes of an object fit a reply.
[[nodiscard]] std::size_t room_for_data(const GeneralReference& request);
/// `data`: of a read, at most room_for_data() bytes. `more`: the object goes on behind them.
[[nodiscard]] Pdu reference_reply(const GeneralReference& request, Bytes data, bool more);
/// The extended exception that carries a CiA 301 abort code, most significant byte first.
[[nodiscard]] Pdu abort_pdu(std::uint32_t abort_code);

}  // namespace axisgate::modbus_tcp
