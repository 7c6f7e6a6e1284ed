// SPDX-License-Identifier: Apache-2.0
// Many clients at once, each a thread with a connection of its own that does one thing over and over.
// Promises to end them all, and to tell the first failure of any.
// Never shares anything between two clients.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/bench/modbus_client.hpp"

namespace axisgate::bench {

inline constexpr int kBusyClients = 32;

class BusyClients {
 public:
  using Turn = std::function<void(ModbusClient&)>;

  explicit BusyClients(std::uint16_t port) : port_(port) {}
  ~BusyClients();
  BusyClients(const BusyClients&) = delete;
  BusyClients& operator=(const BusyClients&) = delete;

  void add(Turn turn);
  [[nodiscard]] std::uint64_t turns() const { return turns_; }
  /// Ends them; throws what the first of them that failed threw.
  void stop();

 private:
  void run(const Turn& turn);

  std::uint16_t port_;
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> turns_{0};
  std::mutex failing_;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

}  // namespace axisgate::bench
