// SPDX-License-Identifier: Apache-2.0
// The MBAP framer: cuts the byte stream of a Modbus-TCP connection into requests (MODBUS Messaging on TCP/IP
// V1.0b 3.1). Promises that any split of the stream gives the same frames, and that a header that is none is reported
// as soon as it shows. Never resynchronises: after `malformed` there is no way to know where a frame begins, and the
// connection must close.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::modbus_tcp {

inline constexpr std::size_t kMbapSize = 7;       ///< transaction, protocol, length, unit
inline constexpr std::size_t kMaxPdu = 253;       ///< V1.1b3 section 4.1
inline constexpr std::uint16_t kMinLength = 2;    ///< unit and a function code
inline constexpr std::uint16_t kMaxLength = 254;  ///< unit and the largest PDU

/// One to be sent.
using Pdu = boost::container::static_vector<Byte, kMaxPdu>;

struct Frame {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  Bytes pdu;  ///< 1..253 bytes; good until the next push() or next()
};

class MbapFramer {
 public:
  enum class Verdict : std::uint8_t { need_more, frame, malformed };

  void push(Bytes bytes);
  /// With `frame`: it is taken off the stream and stands in `frame`.
  [[nodiscard]] Verdict next(Frame& frame);
  /// Bytes not yet taken off: a part of a frame, or frames not asked for yet.
  [[nodiscard]] std::size_t kept() const { return bytes_.size() - begin_; }

 private:
  std::vector<Byte> bytes_;
  std::size_t begin_ = 0;
};

}  // namespace axisgate::modbus_tcp
