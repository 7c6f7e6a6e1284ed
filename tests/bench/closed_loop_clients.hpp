// SPDX-License-Identifier: Apache-2.0
// The clients of the read benchmarks: each sends a request and waits for its whole reply, the next one at once or when
// it is due. Promises the same work for every server that is measured. Never looks into a reply but at its length.
#pragma once

#include <sys/epoll.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gateway/core/bytes.hpp"
#include "tests/bench/modbus_client.hpp"

namespace axisgate::bench {

/// FC 3.
struct ReadRequest {
  ReadRequest(std::uint16_t address, std::uint16_t registers);
  std::array<Byte, 12> bytes;
  std::size_t reply_size;
};

struct AskingClient {
  ModbusClient connection;
  std::size_t received = 0;

  void ask(Bytes request) const;
  /// True: the reply is whole.
  [[nodiscard]] bool take(std::size_t reply_size);
};

/// Whose replies have come.
class EpollSet {
 public:
  EpollSet();
  ~EpollSet();
  EpollSet(const EpollSet&) = delete;
  EpollSet& operator=(const EpollSet&) = delete;
  void add(const ModbusClient& client, std::uint32_t index) const;
  /// Each by `data.u32`, its index.
  [[nodiscard]] std::span<const epoll_event> wait(std::chrono::milliseconds patience);

 private:
  int descriptor_;
  std::array<epoll_event, 256> events_{};
};

/// Replies per second over all clients, after a tenth of the time to get going. Throws std::runtime_error.
[[nodiscard]] double replies_per_second(std::uint16_t port, const ReadRequest& request, int clients,
                                        std::chrono::milliseconds lasting);

}  // namespace axisgate::bench
