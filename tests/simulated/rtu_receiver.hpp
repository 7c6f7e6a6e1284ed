// SPDX-License-Identifier: Apache-2.0
// Collects the bytes that a Modbus RTU slave hears into frames; the line tells when the silence that ends one has come.
// Promises that a pause longer than `longest_pause` inside a frame throws away what was collected, the next byte being
// taken for an address, and that a frame of more than 256 bytes is thrown away whole. Never answers, never looks
// inside.
#pragma once

#include <utility>

#include "tests/simulated/rtu_frame.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

class RtuReceiver {
 public:
  // `silence`: how long the line was quiet before this byte began.
  void receive(std::uint8_t byte, Time silence, Time longest_pause) {
    if (!bytes_.empty() && silence > longest_pause) forget();
    if (bytes_.size() == longest_rtu_frame) overflowed_ = true;
    if (!overflowed_) bytes_.push_back(byte);
  }

  // 3.5 characters of silence have come.
  std::optional<RtuFrame> end() {
    auto frame = overflowed_ ? std::nullopt : open_rtu(bytes_);
    if (!frame && !bytes_.empty()) ++bad_frames_;
    forget();
    return frame;
  }

  void forget() {
    bytes_.clear();
    overflowed_ = false;
  }
  std::uint64_t bad_frames() const { return bad_frames_; }

 private:
  RtuBytes bytes_;
  bool overflowed_ = false;
  std::uint64_t bad_frames_ = 0;
};

}  // namespace axisgate::simulated
