// SPDX-License-Identifier: Apache-2.0
// A server on loopback ports with a clock that stands still, and clients on real sockets, all on the test's own thread.
// Promises that a test waits for events only: what it awaits and does not see within kPatience fails it.
// Never sleeps: virtual time moves when the test says so.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "tests/unit/modbus_server/filled_image.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

/// Only a broken server is ever waited for so long.
inline constexpr std::chrono::seconds kPatience{20};

/// FC 3 on the flat map.
[[nodiscard]] std::vector<Byte> read_request(std::uint16_t transaction, std::uint16_t address, std::uint16_t count);
/// FC 6.
[[nodiscard]] std::vector<Byte> write_request(std::uint16_t transaction, std::uint16_t address, std::uint16_t value);
inline constexpr std::uint16_t kPositionOfAxis1 = 102;
[[nodiscard]] inline std::size_t read_reply_size(std::uint16_t count) { return 9U + 2U * count; }

class Served {
 public:
  Served();
  ~Served();

  /// On the settings in `listeners`, with as many descriptors as the system gives.
  void start();
  void start(const modbus_tcp::DescriptorPlan& descriptors);
  /// Turns the loop until `seen` holds.
  [[nodiscard]] bool await(const std::function<bool()>& seen);
  /// Turns the loop until nothing is ready.
  void settle();
  /// Moves the clock, with the loop turned before and after, as time would pass for an idle loop.
  void pass(Duration time);

  boost::asio::io_context io{1};
  ManualRuntime runtime;
  ProcessImage image;
  RememberingPort port;
  modbus_tcp::ClientRegistry clients;
  std::vector<std::string> lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view message) {
    lines.push_back(std::string(source) + ": " + std::string(message));
  }};
  std::vector<std::string> events;
  bool listener_down = false;
  std::vector<modbus_tcp::ListenerSettings> listeners;
  std::unique_ptr<modbus_tcp::Server> server;
};

/// A client of one connection. Its calls turn the server's loop, so nothing here can wait for a server that has no
/// turn.
class TestClient {
 public:
  enum class Family : std::uint8_t { v4, v6 };
  explicit TestClient(Served& served, std::size_t listener = 0, Family family = Family::v4);
  /// With a receive buffer as small as the system allows, for a client that does not read.
  static std::unique_ptr<TestClient> with_small_buffer(Served& served);
  ~TestClient();
  TestClient(const TestClient&) = delete;
  TestClient& operator=(const TestClient&) = delete;

  void send(const std::vector<Byte>& bytes);
  /// As much as the socket takes now.
  std::size_t send_what_fits(const std::vector<Byte>& bytes);
  /// Exactly so many bytes, or fewer where the server closed.
  [[nodiscard]] std::vector<Byte> receive(std::size_t bytes);
  /// What has come so far, without waiting.
  std::size_t received_so_far();
  [[nodiscard]] bool closed_by_server();
  /// Ends the connection: orderly, or by a reset as a crashed host would.
  void leave(bool reset = false);

 private:
  struct Unconnected {};
  TestClient(Served& served, Unconnected) : served_(served) {}
  void connect(std::size_t listener, Family family, int receive_buffer);
  void take();

  Served& served_;
  int socket_ = -1;
  bool ended_ = false;
  std::vector<Byte> received_;
};

}  // namespace axisgate::test
