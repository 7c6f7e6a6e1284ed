// SPDX-License-Identifier: Apache-2.0
#include "adapters/kinco/kinco_receiver.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::kinco {

void Receiver::await(const bus::Exchange& exchange) {
  drop_window();
  awaited_ = exchange;
}

void Receiver::reset() {
  drop_window();
  awaited_.reset();
}

Receiver::Heard Receiver::take(Byte byte) {
  if (filled_ == kFrameSize) slide();
  window_[filled_++] = byte;
  if (filled_ < kFrameSize) return Heard::nothing;
  const Decoded decoded = decode(window_);
  if (const Frame* frame = std::get_if<Frame>(&decoded)) return take_frame(*frame);
  // A lost beginning is one bad frame, however many windows it takes to find the next.
  if (explained_ == 0 && std::exchange(in_step_, false)) ++bad_frames_;
  return Heard::nothing;
}

Receiver::Heard Receiver::take_frame(const Frame& frame) {
  const bool is_answer = awaited_ && answers(frame, *awaited_);
  // A frame that overlaps one already counted is an accident of the sum, unless it is the one we wait for.
  if (!is_answer && explained_ != 0) return Heard::nothing;
  frame_ = frame;
  frame_bytes_ = window_;
  in_step_ = true;
  if (is_answer) {
    awaited_.reset();
    filled_ = explained_ = 0;
    return Heard::answer;
  }
  explained_ = kFrameSize;
  if (is_request(frame.command)) {
    ++echoes_;
    return Heard::echo;
  }
  ++late_replies_;
  return Heard::late;
}

void Receiver::slide() {
  if (explained_ > 0) {
    --explained_;
  } else {
    ++dropped_bytes_;
  }
  std::shift_left(window_.begin(), window_.end(), 1);
  --filled_;
}

void Receiver::drop_window() {
  dropped_bytes_ += static_cast<std::uint32_t>(filled_ - explained_);
  filled_ = explained_ = 0;
  in_step_ = true;
}

}  // namespace axisgate::kinco
