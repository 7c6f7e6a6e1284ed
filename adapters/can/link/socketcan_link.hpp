// SPDX-License-Identifier: Apache-2.0
// A CAN link through an interface of Linux (SocketCAN), on Boost.Asio.
// Promises what CanLink promises, and that an interface that is missing, down, gone or created again is reported once
// with what to do about it and picked up again: each second, and at once when the system tells of it. Never configures
// the interface (bit rate, restart after bus-off: the administrator's), never blocks, and never calls its events once
// destroyed.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/opening_failures.hpp"
#include "adapters/can/can_bus_off_plan.hpp"
#include "adapters/can/can_filter_set.hpp"
#include "adapters/can/can_send_queue.hpp"
#include "adapters/can/link/interface_watch.hpp"
#include "adapters/can/link/raw_socket.hpp"
#include "adapters/serial/reopen_plan.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::can {

class SocketCanLink final : public CanLink {
 public:
  /// A full queue is tried again this often: a frame takes 0.1 ms to 13 ms, by bit rate.
  static constexpr Duration kSendRetry = std::chrono::milliseconds(2);
  /// A queue that stayed full for too long is looked at this often.
  static constexpr Duration kClogRetry = std::chrono::seconds(1);

  /// `name` is the bus's, for the log; `bitrate` is for what the log tells to do. `context`, `runtime` and `log` must
  /// outlive the link.
  SocketCanLink(std::string name, std::string interface, std::uint32_t bitrate, boost::asio::io_context& context,
                Runtime& runtime, const Log& log);
  ~SocketCanLink() override;

  void start(CanLinkEvents& events, std::vector<CanFilter> filters) override;
  void send(const CanFrame& frame, bool urgent) override;
  [[nodiscard]] const CanTrouble& trouble() const override { return trouble_; }

 private:
  void wake();
  void try_open();
  void wait_for_frames();
  void read();
  void take(const Received& received);
  void pump();
  void look_at_clog();
  void on_change(const InterfaceChange& change);
  void lose(const std::string& why);
  void close();
  /// Tells up or down where that has changed.
  void judge();
  [[nodiscard]] std::string trouble_now() const;
  void arm();

  LogSource log_source_;
  std::string interface_;
  std::uint32_t bitrate_;
  boost::asio::io_context& context_;
  Runtime& runtime_;
  const Log& log_;
  CanLinkEvents* events_ = nullptr;
  FilterSet filters_;
  serial::ReopenPlan reopen_;
  BusOffPlan faults_;
  SendQueue queue_;
  CanTrouble trouble_;
  bus::OpeningFailures failures_;
  std::string broken_;              ///< found while sending; reported from the loop, so that send() calls nobody back
  std::string clogged_;             ///< the queue stayed full: why the link is down
  Instant clog_look_at_ = kNever;   ///< when the queue is looked at again
  Instant send_again_at_ = kNever;  ///< the queue was full: when it is tried again
  std::uint32_t dropped_ = 0;       ///< by the system, on this socket
  bool running_ = true;             ///< as the last message said
  bool reported_up_ = false;
  bool ever_up_ = false;
  boost::asio::posix::stream_descriptor socket_;
  /// Counts openings: handlers of an earlier one that are still in the queue of the loop are out of date. Shared with
  /// them, so that they can tell when the link is gone.
  std::shared_ptr<std::uint64_t> opening_ = std::make_shared<std::uint64_t>(0);
  std::unique_ptr<Timer> timer_;
  std::unique_ptr<InterfaceWatch> watch_;
};

}  // namespace axisgate::can
