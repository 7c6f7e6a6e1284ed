// SPDX-License-Identifier: Apache-2.0
// The thread of one port: what waits for a device, or for the rest of a frame, does that here and not on the core's.
// Promises that what it is asked is taken up as soon as no frame is half read, that what it hears is reported on the
// core's thread in order, each frame with the number of the newest frame sent before it, and that it calls nobody once
// it is destroyed. Never decides: it opens, sends and listens as it is asked, and keeps no more than kMaxHeard frames.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/noncopyable.hpp>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "adapters/modbus_rtu/link/libmodbus_port.hpp"

namespace axisgate::modbus_rtu {

/// Numbers openings: what is reported of an earlier one is out of date.
using OpeningNumber = std::uint64_t;

class PortWorkerEvents : boost::noncopyable {
 public:
  virtual ~PortWorkerEvents() = default;
  virtual void on_opened(OpeningNumber opening, const std::vector<std::string>& notes) = 0;
  virtual void on_not_opened(OpeningNumber opening, const std::string& why) = 0;
  virtual void on_lost(OpeningNumber opening, const std::string& why) = 0;
  virtual void on_heard(OpeningNumber opening, ExchangeNumber newest, Bytes frame) = 0;
  virtual void on_noise(OpeningNumber opening, ExchangeNumber newest, std::size_t bytes) = 0;
  virtual void on_glitch(OpeningNumber opening, std::size_t bytes) = 0;
};

class PortWorker : boost::noncopyable {
 public:
  /// Frames and runs of noise that wait for the core's thread; what comes beyond is dropped, its bytes reported as
  /// noise.
  static constexpr std::size_t kMaxHeard = 32;
  /// Before a frame is sent, what has come unsolicited is read: at most so many times.
  static constexpr int kMaxReadsBeforeSending = 32;

  /// `context` is the core's and must outlive the worker; `events` are called on its thread.
  PortWorker(serial::SerialSettings settings, Duration adapter_latency, boost::asio::io_context& context,
             PortWorkerEvents& events);
  ~PortWorker();

  void open(OpeningNumber opening);
  void close();
  /// False: the frame before had not left yet, and is dropped.
  bool send(ExchangeNumber number, Bytes frame);
  void withdraw(ExchangeNumber number);

 private:
  class Mailbox;
  class Loop;

  std::shared_ptr<Mailbox> mailbox_;
  std::thread thread_;
};

}  // namespace axisgate::modbus_rtu
