// SPDX-License-Identifier: Apache-2.0
// A serial port that is kept open: the ByteLink of the product, on Boost.Asio.
// Promises bytes in order, a loss reported once with its reason, a new try each second and at once when the path
// appears, and exclusive use. A device that is missing at the start is a matter for the log, not an error. Never
// blocks, never interprets a byte, and never calls its events once destroyed.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/byte_link.hpp"
#include "adapters/bus/opening_failures.hpp"
#include "adapters/serial/path_watch.hpp"
#include "adapters/serial/reopen_plan.hpp"
#include "adapters/serial/serial_settings.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::serial {

class SerialLink final : public bus::ByteLink {
 public:
  /// More than this unsent: the port takes nothing (a flow control that nobody serves), and is opened again.
  static constexpr std::size_t kMaxUnsent = 4096;
  static constexpr std::size_t kReadSize = 512;

  /// `name` is the bus's, for the log. `context`, `runtime` and `log` must outlive the link.
  SerialLink(std::string name, SerialSettings settings, boost::asio::io_context& context, Runtime& runtime,
             const Log& log);
  ~SerialLink() override;

  void start(bus::ByteLinkEvents& events) override;
  void send(Bytes bytes) override;
  void reopen(std::string_view why) override;

 private:
  void try_open();
  void arm();
  void read();
  void write();
  /// Something about the device itself went wrong.
  void lose(const std::string& why);
  /// As lose(), but from the loop, so that send() calls nobody back.
  void lose_later(std::string why);
  void close();
  [[nodiscard]] std::string device_and(const boost::system::error_code& error) const;

  LogSource log_source_;
  SerialSettings settings_;
  boost::asio::io_context& context_;
  Runtime& runtime_;
  const Log& log_;
  bus::ByteLinkEvents* events_ = nullptr;
  ReopenPlan plan_;
  bus::OpeningFailures failures_;
  std::vector<std::string> last_notes_;
  boost::asio::posix::stream_descriptor port_;
  std::array<Byte, kReadSize> incoming_{};
  std::vector<Byte> unsent_;
  bool writing_ = false;
  /// Counts openings: handlers of an earlier one that are still in the queue of the loop are out of date. Shared with
  /// them, so that they can tell when the link is gone.
  std::shared_ptr<std::uint64_t> opening_ = std::make_shared<std::uint64_t>(0);
  std::unique_ptr<Timer> timer_;
  std::unique_ptr<PathWatch> path_watch_;
};

}  // namespace axisgate::serial
