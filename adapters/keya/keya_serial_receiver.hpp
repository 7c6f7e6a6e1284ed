// SPDX-License-Identifier: Apache-2.0
// Finds Keya's serial frames in a stream of bytes, and in them the one answer that is awaited.
// Promises that a heartbeat, an echo or another's frame is never taken for the answer: a query's echo is byte for byte
// the answer whose data are all 0, "no fault, standing still", and is one only on a line that is known not to echo, nor
// a frame that began before the request; that noise before the answer gives way byte by byte; that a window of twelve
// bytes in which the awaited answer may begin again is decided only by what follows it: another start byte, or silence.
// RS232 has no sum. Counts what it skips. Never allocates, and never looks at a clock: silence is passed in.
#pragma once

#include <optional>

#include "adapters/bus/echo_watch.hpp"
#include "adapters/bus/glitch_skip.hpp"
#include "adapters/keya/keya_serial_exchange.hpp"

namespace axisgate::keya {

class SerialReceiver {
 public:
  explicit SerialReceiver(KeyaLine line) : line_(line) {}

  /// What one byte, or silence, has completed.
  enum class Heard : std::uint8_t {
    nothing,
    answer,     ///< to the exchange awaited; none is awaited any more
    late,       ///< a well-formed answer to something else: of an exchange given up, or from another drive
    echo,       ///< our own frame
    heartbeat,  ///< RS232 alone
    foreign,    ///< a control frame that is not ours: another master is on the line
  };

  /// `request` goes out; a read awaits its answer. What has begun to come in goes on, but is no answer to it.
  void sent(const bus::Exchange& exchange, const FrameBytes& request);
  /// The answer, should it come, is late.
  void give_up() { awaited_.reset(); }
  /// The line is a new one.
  void reset();

  [[nodiscard]] Heard take(Byte byte);
  /// Nothing has come for longer than any pause within a frame: what is unfinished never will be.
  [[nodiscard]] Heard on_silence();
  /// Bytes wait for more.
  [[nodiscard]] bool unfinished() const { return filled_ > 0; }

  /// The frame heard last, where take() said more than `nothing`.
  [[nodiscard]] const SerialFrame& frame() const { return frame_; }
  [[nodiscard]] const FrameBytes& frame_bytes() const { return frame_bytes_; }

  [[nodiscard]] std::uint32_t late_replies() const { return late_replies_; }
  /// Times that the beginning of a frame was lost, or its end.
  [[nodiscard]] std::uint32_t lost_frames() const { return lost_frames_; }
  [[nodiscard]] std::uint32_t foreign_frames() const { return foreign_frames_; }
  /// Heartbeats whose sum is not what we believe in; they were accepted.
  [[nodiscard]] std::uint32_t odd_heartbeats() const { return odd_heartbeats_; }
  [[nodiscard]] std::uint32_t dropped_bytes() const { return dropped_bytes_; }
  [[nodiscard]] std::uint32_t echoes() const { return echoes_; }
  [[nodiscard]] const bus::EchoWatch& echo() const { return echo_; }

 private:
  [[nodiscard]] Heard look(bool silence);
  [[nodiscard]] std::optional<SerialFrame> whole_frame() const;
  [[nodiscard]] bool has_rival() const;
  [[nodiscard]] Heard accept(const SerialFrame& frame);
  [[nodiscard]] Heard name(const SerialFrame& frame, bool began_before_request);
  void drop_one();
  void remove(std::size_t bytes);

  KeyaLine line_;
  std::array<Byte, kFrameSize + 1> window_{};
  std::size_t filled_ = 0;
  std::size_t before_request_ = 0;  ///< bytes at the head of the window that came before the request
  bool in_step_ = true;
  bool clean_ = true;  ///< nothing but heartbeats and glitches since the request
  std::optional<bus::Exchange> awaited_;
  FrameBytes sent_{};
  bus::EchoWatch echo_;
  bus::GlitchSkip glitch_;
  SerialFrame frame_;
  FrameBytes frame_bytes_{};
  std::uint32_t late_replies_ = 0;
  std::uint32_t lost_frames_ = 0;
  std::uint32_t foreign_frames_ = 0;
  std::uint32_t odd_heartbeats_ = 0;
  std::uint32_t dropped_bytes_ = 0;
  std::uint32_t echoes_ = 0;
};

}  // namespace axisgate::keya
