// SPDX-License-Identifier: Apache-2.0
#include "adapters/kinco/kinco_codec.hpp"

#include <numeric>

namespace axisgate::kinco {

namespace {

/// CHKS of the sheet: (-(byte 0 + ... + byte 8)) modulo 256; of a whole good frame it is 0.
Byte checksum(Bytes bytes) { return static_cast<Byte>(-std::accumulate(bytes.begin(), bytes.end(), 0)); }

bool is_command(Byte byte) {
  const auto command = static_cast<Command>(byte);
  return is_request(command) || value_size(command) != 0 || command == Command::written || command == Command::error;
}

}  // namespace

FrameBytes encode(const Frame& frame) {
  FrameBytes bytes{};
  bytes[0] = frame.node;
  bytes[1] = static_cast<Byte>(frame.command);
  store_le16(bytes, 2, frame.object.index);
  bytes[4] = frame.object.sub;
  store_le(bytes, 5, 4, frame.data);
  bytes[9] = checksum(Bytes(bytes).first(kFrameSize - 1));
  return bytes;
}

Decoded decode(Bytes bytes) {
  if (bytes.size() < kFrameSize) return NeedMore{};
  const Bytes window = bytes.first(kFrameSize);
  if (checksum(window) != 0) return Bad{Bad::Reason::sum};
  if (!is_command(window[1])) return Bad{Bad::Reason::command};
  return Frame{.node = window[0],
               .command = static_cast<Command>(window[1]),
               .object = {load_le16(window, 2), window[4]},
               .data = load_le(window, 5, 4)};
}

}  // namespace axisgate::kinco
