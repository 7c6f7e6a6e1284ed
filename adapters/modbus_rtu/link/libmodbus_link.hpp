// SPDX-License-Identifier: Apache-2.0
// The serial line of one Modbus RTU bus over libmodbus: the RtuLink of the product.
// Promises a loss reported at once with its reason, also while its worker waits for the rest of a frame, a new try each
// second and at once when the path appears, exclusive use, and that a port whose descriptor libmodbus cannot serve is
// down and not the end of the process. A device that is missing at the start is a matter for the log, not an error.
// Never blocks the core's thread but for its worker's last step in its destructor; never calls its events from
// inside a call, nor once destroyed.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/opening_failures.hpp"
#include "adapters/modbus_rtu/link/port_worker.hpp"
#include "adapters/serial/path_watch.hpp"
#include "adapters/serial/reopen_plan.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::modbus_rtu {

class LibmodbusLink final : public RtuLink, private PortWorkerEvents {
 public:
  /// `name` is the bus's, for the log. `context`, `runtime` and `log` must outlive the link.
  LibmodbusLink(std::string name, serial::SerialSettings settings, boost::asio::io_context& context, Runtime& runtime,
                const Log& log, Duration adapter_latency = kAdapterLatency);
  ~LibmodbusLink() override;

  /// Throws std::system_error where there is no thread or descriptor left for the worker.
  void start(RtuLinkEvents& events) override;
  void transmit(ExchangeNumber number, Bytes frame) override;
  void withdraw(ExchangeNumber number) override;
  void reopen(std::string_view why) override;

 private:
  void on_opened(OpeningNumber opening, const std::vector<std::string>& notes) override;
  void on_not_opened(OpeningNumber opening, const std::string& why) override;
  void on_lost(OpeningNumber opening, const std::string& why) override;
  void on_heard(OpeningNumber opening, ExchangeNumber newest, Bytes frame) override;
  void on_noise(OpeningNumber opening, ExchangeNumber newest, std::size_t bytes) override;
  void on_glitch(OpeningNumber opening, std::size_t bytes) override;

  enum class State : std::uint8_t { closed, opening, open, closing };

  void on_path();
  void try_open();
  void arm();
  void closed(const std::string& why);

  LogSource log_source_;
  serial::SerialSettings settings_;
  Duration adapter_latency_;
  boost::asio::io_context& context_;
  Runtime& runtime_;
  const Log& log_;
  RtuLinkEvents* events_ = nullptr;
  serial::ReopenPlan plan_;
  State state_ = State::closed;
  OpeningNumber opening_ = 0;
  bool path_appeared_ = false;  ///< while a try was under way
  bus::OpeningFailures failures_;
  std::vector<std::string> last_notes_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
  std::unique_ptr<Timer> timer_;
  std::unique_ptr<serial::PathWatch> path_watch_;
  std::unique_ptr<PortWorker> worker_;
};

}  // namespace axisgate::modbus_rtu
