// SPDX-License-Identifier: Apache-2.0
// A Modbus-TCP server on loopback with a process image filled by hand, in a thread of its own: what commands are run
// against.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "tests/unit/modbus_server/filled_image.hpp"

namespace axisgate::commands::test_server {

class RunningServer {
 public:
  explicit RunningServer(modbus_tcp::ListenerSettings settings = {}, AxisNumber axes = 3,
                         const std::map<AxisNumber, std::string>& names = {}) {
    test::fill_image(image_, axes, runtime_.now());
    for (const auto& [number, name] : names) image_.find(number)->name = name;
    settings.port = settings.port == 1502 ? 0 : settings.port;
    server_ =
        std::make_unique<modbus_tcp::Server>(io_, runtime_, std::span(&settings, 1), image_, port_, clients_, log_);
    server_->start(modbus_tcp::take_descriptors({.clients = settings.max_clients}));
    listening_on_ = server_->ports()[0];
    thread_ = std::thread([this] { io_.run(); });
  }
  ~RunningServer() {
    boost::asio::post(io_, [this] { server_->stop(); });
    thread_.join();
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;
  [[nodiscard]] std::uint16_t port() const { return listening_on_; }
  [[nodiscard]] std::string endpoint() const { return "127.0.0.1:" + std::to_string(listening_on_); }

 private:
  boost::asio::io_context io_{1};
  AsioRuntime runtime_{io_};
  ProcessImage image_;
  test::RememberingPort port_;
  modbus_tcp::ClientRegistry clients_;
  Log log_;
  std::unique_ptr<modbus_tcp::Server> server_;
  std::uint16_t listening_on_ = 0;
  std::thread thread_;
};

}  // namespace axisgate::commands::test_server
