// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/rtu_frame.hpp"

#include "gateway/core/rtu_crc.hpp"

namespace axisgate::modbus_tcp {
namespace {

constexpr std::size_t kShortRequest = 8;  // unit, function, address, count or value, CRC
constexpr std::size_t kByteCount = 6;     // of functions 15 and 16, behind the same

std::size_t size_of_request(Bytes bytes) {
  const Byte function = bytes[1];
  if (function >= 1 && function <= 6) return kShortRequest;
  if (function == 15 || function == 16) return kByteCount + 1U + bytes[kByteCount] + kCrcSize;
  return 0;
}

}  // namespace

bool is_rtu_request(Bytes bytes) {
  // With its own CRC, low byte first, the sum of a whole frame is 0.
  return bytes.size() >= kShortRequest && bytes.size() == size_of_request(bytes) && crc16(bytes) == 0;
}

}  // namespace axisgate::modbus_tcp
