// SPDX-License-Identifier: Apache-2.0
// Finds frames in a stream of bytes, and in them the one answer that is awaited.
// Promises that the awaited answer is found whatever comes before it: a window of ten bytes that is not the answer
// gives way by one byte only, however good its sum, since noise may add up to 0 across the start of the true frame.
// Counts what it skips; a glitch before a frame is no bad frame. Never allocates, and never takes a byte received
// before await() for part of an answer.
#pragma once

#include <optional>

#include "adapters/bus/glitch_skip.hpp"
#include "adapters/kinco/kinco_exchange.hpp"

namespace axisgate::kinco {

class Receiver {
 public:
  /// What one byte has completed.
  enum class Heard : std::uint8_t {
    nothing,
    answer,   ///< to the exchange awaited; none is awaited any more
    late,     ///< a well-formed reply to something else: of an exchange given up, or from another station
    echo,     ///< our own request: passed round by drives in a chain (both settings of 6510:0B are served), or by an
              ///< adapter that hears itself
    foreign,  ///< another request: there is another master
  };

  /// Bytes that were left over are dropped: they cannot belong to the answer of what is sent now.
  void await(const bus::Exchange& exchange);
  /// The answer, should it come, is late.
  void give_up() { awaited_.reset(); }
  /// The line is a new one.
  void reset();

  [[nodiscard]] Heard take(Byte byte);
  /// The frame heard last, where take() said more than `nothing`.
  [[nodiscard]] const Frame& frame() const { return frame_; }
  [[nodiscard]] Bytes frame_bytes() const { return frame_bytes_; }

  [[nodiscard]] std::uint32_t late_replies() const { return late_replies_; }
  [[nodiscard]] std::uint32_t bad_frames() const {
    return bad_frames_;
  }  ///< times that the beginning of a frame was lost
  [[nodiscard]] std::uint32_t dropped_bytes() const { return dropped_bytes_; }
  [[nodiscard]] std::uint32_t echoes() const { return echoes_; }
  [[nodiscard]] std::uint32_t foreign_frames() const { return foreign_frames_; }

 private:
  void slide();
  void drop_window();
  [[nodiscard]] Heard take_frame(const Frame& frame);

  FrameBytes window_{};
  std::size_t filled_ = 0;
  /// Bytes at the head of the window that a counted frame has explained: neither dropped ones nor part of another.
  std::size_t explained_ = 0;
  bool in_step_ = true;
  std::optional<bus::Exchange> awaited_;
  FrameBytes sent_{};  ///< last; no station has number 0
  bus::GlitchSkip glitch_;
  Frame frame_;
  FrameBytes frame_bytes_{};
  std::uint32_t late_replies_ = 0;
  std::uint32_t bad_frames_ = 0;
  std::uint32_t dropped_bytes_ = 0;
  std::uint32_t echoes_ = 0;
  std::uint32_t foreign_frames_ = 0;
};

}  // namespace axisgate::kinco
