// SPDX-License-Identifier: Apache-2.0
#include "adapters/keya/keya_serial_receiver.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace axisgate::keya {

void SerialReceiver::sent(const bus::Exchange& exchange, const FrameBytes& request) {
  before_request_ = filled_;
  clean_ = true;
  sent_ = request;
  echo_.on_sent(exchange.access == bus::Access::read);
  glitch_.renew();
  awaited_.reset();
  if (exchange.access == bus::Access::read) awaited_ = exchange;
}

void SerialReceiver::reset() {
  while (filled_ > 0) drop_one();
  in_step_ = true;
  awaited_.reset();
  echo_.reset();
  sent_ = {};
}

SerialReceiver::Heard SerialReceiver::take(Byte byte) {
  assert(filled_ < window_.size());
  window_[filled_++] = byte;
  return look(false);
}

SerialReceiver::Heard SerialReceiver::on_silence() {
  const Heard heard = look(true);
  while (filled_ > 0) drop_one();
  in_step_ = true;
  return heard;
}

SerialReceiver::Heard SerialReceiver::look(bool silence) {
  while (filled_ > 0) {
    if (filled_ < kFrameSize && may_start(line_, window_[0])) return Heard::nothing;
    if (in_step_ && glitch_.skips(window_[0])) {
      ++dropped_bytes_;
      remove(1);
      continue;
    }
    const auto frame = whole_frame();
    if (!frame) {
      drop_one();
      continue;
    }
    const bool followed = filled_ > kFrameSize;
    if (has_rival() && !(followed ? may_start(line_, window_[kFrameSize]) : silence)) {
      if (!followed) return Heard::nothing;
      drop_one();
      continue;
    }
    return accept(*frame);
  }
  return Heard::nothing;
}

/// What the window starts with. On RS232 nobody but we ourselves could have sent a control frame.
std::optional<SerialFrame> SerialReceiver::whole_frame() const {
  const Decoded decoded = decode(line_, Bytes(window_).first(filled_));
  const SerialFrame* frame = std::get_if<SerialFrame>(&decoded);
  if (frame == nullptr) return std::nullopt;
  const bool noise = line_ == KeyaLine::rs232 && frame->start == kControl &&
                     !std::equal(window_.begin(), window_.begin() + kFrameSize, sent_.begin());
  return noise ? std::nullopt : std::optional(*frame);
}

/// Inside the frame at the head, the answer awaited may begin.
bool SerialReceiver::has_rival() const {
  if (!awaited_) return false;
  const auto code = static_cast<std::uint8_t>(awaited_->object.index - kQueryIndex);
  for (std::size_t at = std::max<std::size_t>(before_request_, 1); at < kFrameSize; ++at) {
    if (may_become_answer(line_, Bytes(window_).subspan(at, kFrameSize - at), awaited_->node, code)) return true;
  }
  return false;
}

SerialReceiver::Heard SerialReceiver::accept(const SerialFrame& frame) {
  frame_ = frame;
  std::copy_n(window_.begin(), kFrameSize, frame_bytes_.begin());
  const bool began_before_request = before_request_ > 0;
  remove(kFrameSize);
  in_step_ = true;
  glitch_.renew();
  const Heard heard = name(frame, began_before_request);
  switch (heard) {
    case Heard::answer:
      awaited_.reset();
      echo_.on_answer(clean_);
      break;
    case Heard::late:
      ++late_replies_;
      break;
    case Heard::echo:
      break;
    case Heard::foreign:
      ++foreign_frames_;
      break;
    case Heard::heartbeat:
      if (!frame.sum_as_believed) ++odd_heartbeats_;
      break;
    case Heard::nothing:
      break;
  }
  if (heard == Heard::late || heard == Heard::foreign) {
    clean_ = false;
    echo_.on_other();
  }
  return heard;
}

SerialReceiver::Heard SerialReceiver::name(const SerialFrame& frame, bool began_before_request) {
  if (frame.start == kHeartbeat) return Heard::heartbeat;
  const bool may_be_drives = frame.start == kQuery && !is_never_zero(frame.code);
  if (!began_before_request && frame_bytes_ == sent_) {
    const bus::EchoWatch::Copy copy = echo_.on_copy(may_be_drives);
    if (copy == bus::EchoWatch::Copy::echo) ++echoes_;
    if (copy != bus::EchoWatch::Copy::answer) return Heard::echo;
  }
  if (frame.start == kControl) return Heard::foreign;
  return !began_before_request && awaited_ && answers(line_, frame, *awaited_) ? Heard::answer : Heard::late;
}

void SerialReceiver::drop_one() {
  ++dropped_bytes_;
  clean_ = false;
  echo_.on_other();
  // A lost beginning is one lost frame, however many bytes it takes to find the next.
  if (std::exchange(in_step_, false)) ++lost_frames_;
  remove(1);
}

void SerialReceiver::remove(std::size_t bytes) {
  std::shift_left(window_.begin(), window_.end(), static_cast<std::ptrdiff_t>(bytes));
  filled_ -= bytes;
  before_request_ -= std::min(before_request_, bytes);
}

}  // namespace axisgate::keya
