// SPDX-License-Identifier: Apache-2.0
// A link that carries CAN frames: SocketCAN, a serial CAN adapter (Lawicel), or a simulated bus in tests.
// Promises to report up and down in turn, frames in order, and to come back by itself until it is destroyed.
// Never interprets a frame.
#pragma once

#include <boost/noncopyable.hpp>
#include <cstdint>
#include <string_view>
#include <vector>

#include "adapters/can/can_frame.hpp"
#include "gateway/core/clock.hpp"

namespace axisgate::can {

/// Frames that pass: those whose id differs from `id` in no bit of `mask`; standard and extended ids are distinguished.
struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = kMaxStandardId;
  bool extended = false;
  [[nodiscard]] bool passes(const CanFrame& frame) const {
    return frame.extended == extended && (frame.id & mask) == (id & mask);
  }
  friend bool operator==(const CanFilter&, const CanFilter&) = default;
};

/// Filters a link takes; enough for 127 nodes with all their ids.
inline constexpr std::size_t kMaxFilters = 2048;

/// Frames that wait to be sent (the driver's queue is full: nobody acknowledges, or the bus is busy). More, or one for
/// longer than kMaxSendWait: the bus is reported down.
inline constexpr std::size_t kMaxUnsentFrames = 64;
inline constexpr Duration kMaxSendWait = std::chrono::milliseconds(500);

/// Frames handed over in one turn of the loop; more wait for the next one, so that other buses keep their deadlines.
inline constexpr std::size_t kMaxFramesPerTurn = 64;

/// What a link has seen go wrong; counters only grow.
struct CanTrouble {
  std::uint32_t lost_in = 0;        ///< received by the system, and dropped before we took them (queue overflow)
  std::uint32_t send_waits = 0;     ///< times the send queue was full (ENOBUFS)
  std::uint32_t error_frames = 0;   ///< of any kind
  std::uint32_t no_ack = 0;         ///< sent, and acknowledged by nobody
  std::uint32_t error_passive = 0;  ///< times the controller went error passive
  std::uint32_t bus_offs = 0;
  std::uint32_t bad_bytes = 0;   ///< Lawicel: bytes that belong to no line
  std::uint32_t reconnects = 0;  ///< times the link came back
  friend bool operator==(const CanTrouble&, const CanTrouble&) = default;
};

class CanLinkEvents : boost::noncopyable {
 public:
  virtual ~CanLinkEvents() = default;
  virtual void on_link_up() = 0;
  /// `why` names the device and what is wrong with it: gone, down, bus-off, nobody acknowledges.
  virtual void on_link_down(std::string_view why) = 0;
  /// `received`: when it came in, as near as the system tells.
  virtual void on_frame(const CanFrame& frame, Instant received) = 0;
};

class CanLink : boost::noncopyable {
 public:
  virtual ~CanLink() = default;
  /// `events` must outlive the link. `filters`: only what passes one of them is handed over.
  virtual void start(CanLinkEvents& events, std::vector<CanFilter> filters) = 0;
  /// Only while up. In order; what the system cannot take at once waits. Calls nobody back. `urgent`: goes before what
  /// waits (an emergency stop must not stand behind a queue).
  virtual void send(const CanFrame& frame, bool urgent = false) = 0;
  [[nodiscard]] virtual const CanTrouble& trouble() const = 0;
};

}  // namespace axisgate::can
