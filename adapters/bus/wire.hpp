// SPDX-License-Identifier: Apache-2.0
// A wire: the link of one bus together with the protocol spoken on it, as the bus sees it. Each adapter makes one.
// Promises at most one reply per send(), and none after abandon() or a link loss: what comes then is counted as late.
// Never queues, repeats or orders requests: that is the arbiter's work alone.
#pragma once

#include <boost/noncopyable.hpp>
#include <optional>
#include <string_view>

#include "adapters/bus/exchange.hpp"
#include "adapters/bus/statistics.hpp"

namespace axisgate::bus {

class WireEvents : boost::noncopyable {
 public:
  virtual ~WireEvents() = default;
  virtual void on_wire_up() = 0;
  /// `why` names the device and the system's reason, for the log.
  virtual void on_wire_down(std::string_view why) = 0;
  /// The answer to the exchange sent last. Its code is ok, refused_by_drive or bad_reply.
  virtual void on_reply(const ExchangeResult& result) = 0;
  /// Never from inside send() or another call of the wire.
  virtual void on_unsolicited(const UnsolicitedEvent& /*unsolicited*/) {}
};

class Wire : boost::noncopyable {
 public:
  virtual ~Wire() = default;
  /// Opens the link and keeps it open until the wire is destroyed; `events` must outlive it. May call on_wire_up() at
  /// once.
  virtual void start(WireEvents& events) = 0;
  /// Only while up and with no exchange outstanding.
  virtual void send(const Exchange& exchange) = 0;
  /// The exchange outstanding is given up (timeout): its reply, should it come, is late.
  virtual void abandon() = 0;
  /// From now on process data object `number` (1, 2, ...) of the node carries these; none: what comes of it is dropped.
  virtual void map_process_data(std::uint8_t /*node*/, std::uint8_t /*number*/, const ProcessMap& /*objects*/) {}
  /// Asks the node for a sign of life, beside the exchanges (CANopen: a node guarding frame); it answers with an
  /// unsolicited event, if it does. False: this protocol has no such thing, only exchanges tell.
  [[nodiscard]] virtual bool call(std::uint8_t /*node*/) { return false; }
  /// Bits of all frames that it has sent and heard, with stuff bits and the space between frames; none: not counted.
  [[nodiscard]] virtual std::optional<std::uint64_t> bits_carried() const { return std::nullopt; }
  /// The adapter adds what it counts: bad_frames, late_replies, dropped_bytes, reconnects, echoes.
  [[nodiscard]] virtual const Statistics& statistics() const = 0;
  /// Decode level (design section 6): log every frame sent and received.
  virtual void set_decode(bool on) = 0;
};

}  // namespace axisgate::bus
