// SPDX-License-Identifier: Apache-2.0
// Collects the bytes a drive hears into ten-byte frames.
// Promises: a frame is found however its bytes are split; a frame with a wrong sum is dropped whole and in silence
// (JD 2.1, MD 2.2); a pause longer than the gap drops what was begun.
// Never answers and never looks into a frame.
#pragma once

#include <cstdint>
#include <optional>

#include "tests/simulated/ten_byte_frame.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

class FrameReceiver {
 public:
  // The sheets give no gap (JD 10.1); with a fixed length and no delimiter, silence is the only mark (MD 2.2).
  explicit FrameReceiver(Time gap = std::chrono::milliseconds(20)) : gap_(gap) {}

  std::optional<TenByteFrame> receive(std::uint8_t byte, Time at) {
    if (filled_ > 0 && at - last_ > gap_) filled_ = 0;
    last_ = at;
    frame_[filled_++] = byte;
    if (filled_ < frame_length) return std::nullopt;
    filled_ = 0;
    if (sums_to_zero(frame_)) return frame_;
    ++bad_frames_;
    return std::nullopt;
  }

  void forget() { filled_ = 0; }
  std::uint64_t bad_frames() const { return bad_frames_; }

 private:
  Time gap_;
  Time last_{};
  TenByteFrame frame_{};
  std::size_t filled_ = 0;
  std::uint64_t bad_frames_ = 0;
};

}  // namespace axisgate::simulated
