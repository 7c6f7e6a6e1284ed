// SPDX-License-Identifier: Apache-2.0
// A serial port spoken to through libmodbus: the one file that knows <modbus/modbus.h>, and of it only the framing of
// requests and confirmations. Its server half is never used, nor what it would do about an error by itself. It is given
// whole frames by a pipe: what it cannot skip, glitch bytes and copies of our requests, it does not see.
// Promises to tell whole frames with a right CRC from everything else, never to wait, to give a frame that has begun
// the time that it takes and no more, and never to give libmodbus a descriptor that its select() would abort the
// process on. Never decides, queues or remembers an exchange; one thread at a time.
#pragma once

#include <array>
#include <boost/noncopyable.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "adapters/modbus_rtu/frame_finder.hpp"
#include "adapters/modbus_rtu/rtu_link.hpp"
#include "adapters/modbus_rtu/rtu_timing.hpp"
#include "adapters/serial/serial_settings.hpp"

namespace axisgate::modbus_rtu {

/// How much later than the line itself an adapter may pass bytes on: a USB adapter's latency timer is 16 ms, and the
/// machine has its own moments.
inline constexpr Duration kAdapterLatency = std::chrono::milliseconds(30);

/// What listening has brought.
struct Heard {
  enum class Kind : std::uint8_t { nothing, frame, glitch, noise, lost };
  Kind kind = Kind::nothing;
  Bytes frame{};          ///< unit and PDU, until the next call
  std::size_t bytes = 0;  ///< of noise or a glitch
  std::string why{};      ///< of a loss
};

class LibmodbusPort : boost::noncopyable {
 public:
  /// Bytes that skip() takes at once.
  static constexpr std::size_t kSkipSize = 256;

  LibmodbusPort(serial::SerialSettings settings, Duration adapter_latency);
  ~LibmodbusPort();

  struct Opening {
    std::string error;  ///< empty: it is open
    std::vector<std::string> notes;
  };
  [[nodiscard]] Opening open();
  void close();
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] const serial::SerialSettings& settings() const { return settings_; }

  /// Hands the frame to the kernel, never waiting for room there. Empty, or why the port is of no more use.
  [[nodiscard]] std::string transmit(Bytes frame);
  [[nodiscard]] std::size_t bytes_waiting() const;
  /// The next of what has come; nothing: more must come. `may_read`: not only of what was read before.
  [[nodiscard]] Heard receive(bool may_read);
  /// A frame has begun.
  [[nodiscard]] bool unfinished() const { return finder_.unfinished(); }
  /// How long its rest is still waited for.
  [[nodiscard]] Duration patience_left() const;
  /// Drops what has begun; how many bytes that was.
  std::size_t drop() { return finder_.drop(); }
  /// Bytes as they come, no frames, no waiting: after noise, until the line is silent.
  [[nodiscard]] Heard skip();

 private:
  struct Context;

  [[nodiscard]] bool selectable() const;
  [[nodiscard]] bool read_more(Heard& lost);
  [[nodiscard]] Heard heard_of(const FrameFinder::Found& found);
  [[nodiscard]] Heard judged(Bytes frame);
  [[nodiscard]] Duration patience() const;

  serial::SerialSettings settings_;
  Duration adapter_latency_;
  std::size_t longest_reply_;
  FrameFinder finder_;
  Instant begun_at_ = kLongAgo;  ///< of the frame that has begun
  int descriptor_ = -1;
  std::unique_ptr<Context> context_;
  std::array<Byte, 260> buffer_{};  ///< what libmodbus may fill: its own largest frame
};

}  // namespace axisgate::modbus_rtu
