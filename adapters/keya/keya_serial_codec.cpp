// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_serial_codec.hpp"

#include <algorithm>
#include <numeric>

namespace axisgate::keya {

namespace {

constexpr std::size_t kSumAt = kFrameSize - 1;
constexpr std::uint8_t kMaxEnableCode = 3;
constexpr std::uint16_t kMaxAngle = 1000;

/// Where the data of an answer begin.
constexpr std::size_t answer_at(KeyaLine line) { return line == KeyaLine::rs232 ? 2 : 3; }
/// Where the values of a control frame begin. On RS232 two zeros stand before them.
constexpr std::size_t values_at(KeyaLine line) { return line == KeyaLine::rs232 ? 4 : 3; }
constexpr std::size_t kValueBytes = 8;

Byte sum(Bytes frame) {
  return static_cast<Byte>(std::accumulate(frame.begin(), frame.begin() + std::ptrdiff_t{kSumAt}, 0));
}
bool sum_is_right(Bytes frame) { return sum(frame) == frame[kSumAt]; }

bool all_zero(Bytes bytes) {
  return std::ranges::all_of(bytes, [](Byte byte) { return byte == 0; });
}

/// Data bytes that an answer may use on RS232; those behind are printed as 0. The layouts of codes 1 and 4 are not
/// documented, and of code 0 not where motor B's bytes are.
constexpr std::size_t used_bytes(std::uint8_t code) {
  switch (static_cast<Query>(code)) {
    case Query::voltage:
      return 1;
    case Query::control_state:
    case Query::speed:
    case Query::current:
    case Query::temperature:
    case Query::faults:
    case Query::version:
      return 4;
    case Query::encoder:
      return 8;
    default:
      return 10;
  }
}

void copy_to_data(Bytes from, SerialFrame& frame) { std::ranges::copy(from, frame.data.begin()); }

Decoded decode_query(KeyaLine line, Bytes bytes) {
  SerialFrame frame{.start = kQuery};
  if (line == KeyaLine::rs485) frame.node = bytes[1];
  frame.code = bytes[answer_at(line) - 1];
  if (!may_become_answer(line, bytes, frame.node, frame.code)) return Bad{};
  copy_to_data(bytes.subspan(answer_at(line), data_size(line)), frame);
  return frame;
}

Decoded decode_control(KeyaLine line, Bytes bytes) {
  SerialFrame frame{.start = kControl};
  const std::size_t code_at = line == KeyaLine::rs232 ? 1 : 2;
  if (line == KeyaLine::rs485) frame.node = bytes[1];
  frame.code = bytes[code_at];
  if (frame.code > kMaxEnableCode || !all_zero(bytes.subspan(code_at + 1, values_at(line) - code_at - 1))) return Bad{};
  copy_to_data(bytes.subspan(values_at(line), kValueBytes), frame);
  return frame;
}

Decoded decode_heartbeat(Bytes bytes) {
  SerialFrame frame{.start = kHeartbeat, .sum_as_believed = sum_is_right(bytes)};
  const bool angles_fit = load_be16(bytes, 1) <= kMaxAngle && load_be16(bytes, 7) <= kMaxAngle;
  if (!frame.sum_as_believed && !angles_fit) return Bad{};
  copy_to_data(bytes.subspan(1, 10), frame);
  return frame;
}

}  // namespace

FrameBytes encode(KeyaLine line, const SerialFrame& frame) {
  FrameBytes bytes{};
  bytes[0] = frame.start;
  std::size_t data_at = 1;
  std::size_t size = 10;
  if (frame.start != kHeartbeat) {
    const bool control = frame.start == kControl;
    std::size_t code_at = 1;
    if (line == KeyaLine::rs485) bytes[code_at++] = frame.node;
    bytes[code_at] = frame.code;
    data_at = control ? values_at(line) : answer_at(line);
    size = control ? kValueBytes : data_size(line);
  }
  std::copy_n(frame.data.begin(), size, bytes.begin() + static_cast<std::ptrdiff_t>(data_at));
  if (line == KeyaLine::rs485 || frame.start == kHeartbeat) bytes[kSumAt] = sum(bytes);
  return bytes;
}

Decoded decode(KeyaLine line, Bytes bytes) {
  if (!bytes.empty() && !may_start(line, bytes[0])) return Bad{};
  if (bytes.size() < kFrameSize) return NeedMore{};
  const Bytes window = bytes.first(kFrameSize);
  if (line == KeyaLine::rs485 && !sum_is_right(window)) return Bad{};
  switch (window[0]) {
    case kControl:
      return decode_control(line, window);
    case kQuery:
      return decode_query(line, window);
    default:
      return decode_heartbeat(window);
  }
}

bool may_start(KeyaLine line, Byte byte) {
  return byte == kControl || byte == kQuery || (byte == kHeartbeat && line == KeyaLine::rs232);
}

bool may_become_answer(KeyaLine line, Bytes head, std::uint8_t node, std::uint8_t code) {
  const std::size_t data_at = answer_at(line);
  if (code >= kQueries || head.empty() || head[0] != kQuery) return false;
  if (line == KeyaLine::rs485 && head.size() > 1 && head[1] != node) return false;
  if (head.size() >= data_at && head[data_at - 1] != code) return false;
  // What is behind the used bytes of RS485 ends with the sum, which says more than zeros do.
  const std::size_t unused_at = data_at + used_bytes(code);
  return line == KeyaLine::rs485 || head.size() <= unused_at || all_zero(head.subspan(unused_at));
}

Duration frame_time(std::uint32_t baud) {
  assert(baud > 0);
  constexpr std::int64_t kBits = 10 * std::int64_t{kFrameSize};
  return Duration(std::chrono::seconds(1)) * kBits / std::int64_t{baud};
}

}  // namespace axisgate::keya
