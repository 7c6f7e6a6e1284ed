// SPDX-License-Identifier: Apache-2.0
// The serial line of one Modbus RTU bus, as the wire sees it: frames out, frames in. CRC, gaps and line timing are the
// link's; what a frame means is the codec's. The product has one over libmodbus (libmodbus_link), the simulation
// another. Promises that on_frame() carries a frame whose CRC was right, tagged with the newest transmit() before it
// was heard, and that a lost link is reported at once, whatever its worker is still waiting for. Never calls back from
// inside a call of its own, never repeats or orders frames.
#pragma once

#include <boost/noncopyable.hpp>
#include <cstdint>
#include <string_view>

#include "gateway/core/bytes.hpp"

namespace axisgate::modbus_rtu {

/// Number of an exchange: frames heard are distinguished from those of the one before by it. 0: nobody had asked yet.
using ExchangeNumber = std::uint64_t;

/// Longest frame without its CRC: unit address and a PDU of 253 bytes (Modbus application protocol V1.1b3, 4.1).
inline constexpr std::size_t kMaxFrame = 254;

class RtuLinkEvents : boost::noncopyable {
 public:
  virtual ~RtuLinkEvents() = default;
  virtual void on_link_up() = 0;
  /// `why` names the device and the system's reason, for the log.
  virtual void on_link_down(std::string_view why) = 0;
  /// `frame`: unit address and PDU, without the CRC; a copy of the request among them, where the line echoes. `newest`:
  /// the newest frame sent when this one was heard.
  virtual void on_frame(ExchangeNumber newest, Bytes frame) = 0;
  /// Bytes that are no frame: noise, a half frame, a wrong CRC.
  virtual void on_bad_frame(ExchangeNumber newest, std::size_t bytes) = 0;
  /// Bytes before a frame that cannot begin it, as a transceiver makes them; they were skipped.
  virtual void on_glitch(std::size_t bytes) = 0;
};

class RtuLink : boost::noncopyable {
 public:
  virtual ~RtuLink() = default;
  /// Opens the device and keeps it open, reopening it when it was lost. `events` must outlive the link.
  virtual void start(RtuLinkEvents& events) = 0;
  /// Unit address and PDU; the link adds the CRC. Only while up. One frame at a time: the caller waits for its answer
  /// or for its own deadline before the next.
  virtual void transmit(ExchangeNumber number, Bytes frame) = 0;
  /// Its exchange was given up: a frame that still waits to leave shall not leave any more. Nothing to do for a link
  /// whose frames never wait.
  virtual void withdraw(ExchangeNumber number) { static_cast<void>(number); }
  /// Closes and opens again, for a line that babbles. While up: reports down with `why`, then up when it is open again.
  /// While down: tries again at once. Nothing to do for a link that cannot be opened again.
  virtual void reopen(std::string_view why) { static_cast<void>(why); }
};

}  // namespace axisgate::modbus_rtu
