// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/busy_clients.hpp"

#include <utility>

namespace axisgate::bench {

BusyClients::~BusyClients() {
  ending_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void BusyClients::add(Turn turn) {
  threads_.emplace_back([this, turn = std::move(turn)] { run(turn); });
}

void BusyClients::run(const Turn& turn) {
  try {
    ModbusClient client(port_);
    while (!ending_) {
      turn(client);
      ++turns_;
    }
  } catch (...) {
    const std::lock_guard lock(failing_);
    if (!failure_) failure_ = std::current_exception();
  }
}

void BusyClients::stop() {
  ending_ = true;
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace axisgate::bench
