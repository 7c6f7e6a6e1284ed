// SPDX-License-Identifier: Apache-2.0
// How many bits a frame takes on the wire (ISO 11898-1): header, data, CRC, the stuff bits that it really has, and the
// space behind it. Promises the exact number for a frame that was sent once and acknowledged. Never counts what the
// controller sent again, nor error frames: nobody tells us of those.
#pragma once

#include "adapters/can/can_frame.hpp"

namespace axisgate::can {

namespace detail {

// CRC delimiter, acknowledge slot and delimiter, end of frame (7), intermission (3): sent as they are, without
// stuffing.
inline constexpr int kUnstuffedEnd = 13;
inline constexpr int kCrcBits = 15;
inline constexpr std::uint32_t kCrcPolynomial = 0x4599;  // x15 + x14 + x10 + x8 + x7 + x4 + x3 + 1
inline constexpr int kRun = 5;                           // after so many equal bits comes one of the other kind

/// Takes the bits from the start of frame to the end of the CRC, and counts the stuff bits among them.
class Stuffing {
 public:
  void take(std::uint32_t value, int bits) {
    for (int i = bits - 1; i >= 0; --i) take((value >> i & 1U) != 0);
  }
  void take_crc() {
    const std::uint32_t crc = crc_;
    take(crc, kCrcBits);
  }
  [[nodiscard]] int bits() const { return bits_; }

 private:
  void take(bool bit) {
    const bool turns = bit != ((crc_ >> (kCrcBits - 1) & 1U) != 0);
    crc_ = (crc_ << 1U) & 0x7FFFU;
    if (turns) crc_ ^= kCrcPolynomial;
    ++bits_;
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ < kRun) return;
    ++bits_;  // the stuff bit begins the next run
    last_ = !bit;
    run_ = 1;
  }
  std::uint32_t crc_ = 0;
  int bits_ = 0;
  int run_ = 0;
  bool last_ = true;  // recessive, as the idle bus is
};

}  // namespace detail

[[nodiscard]] inline int bits_on_wire(const CanFrame& frame) {
  constexpr int kLowBits = 18;  // of an extended identifier
  const std::uint32_t remote = frame.remote ? 1 : 0;
  detail::Stuffing stuffing;
  stuffing.take(0, 1);  // start of frame
  if (frame.extended) {
    stuffing.take(frame.id >> kLowBits, 11);
    stuffing.take(0b11, 2);  // substitute remote request, identifier extension
    stuffing.take(frame.id & ((1U << kLowBits) - 1U), kLowBits);
    stuffing.take(remote << 2U, 3);  // remote request and two reserved bits
  } else {
    stuffing.take(frame.id, 11);
    stuffing.take(remote << 2U, 3);  // remote request, identifier extension, reserved
  }
  stuffing.take(frame.size, 4);
  for (const Byte byte : frame.bytes()) stuffing.take(byte, 8);
  stuffing.take_crc();
  return stuffing.bits() + detail::kUnstuffedEnd;
}

}  // namespace axisgate::can
