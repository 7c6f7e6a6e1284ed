// SPDX-License-Identifier: Apache-2.0
#include "adapters/kinco/kinco_receiver.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::kinco {

void Receiver::await(const bus::Exchange& exchange) {
  drop_window();
  awaited_ = exchange;
  sent_ = encode(request_of(exchange));
  glitch_.renew();
}

void Receiver::reset() {
  drop_window();
  awaited_.reset();
  sent_ = {};
}

Receiver::Heard Receiver::take(Byte byte) {
  // No station has number 0x00 or 0xFF.
  if (filled_ == 0 && glitch_.skips(byte)) {
    ++dropped_bytes_;
    return Heard::nothing;
  }
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
  glitch_.renew();
  if (is_answer) {
    awaited_.reset();
    filled_ = explained_ = 0;
    return Heard::answer;
  }
  if (window_ == sent_) {
    ++echoes_;
    filled_ = explained_ = 0;
    return Heard::echo;
  }
  explained_ = kFrameSize;
  if (is_request(frame.command)) {
    ++foreign_frames_;
    return Heard::foreign;
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
