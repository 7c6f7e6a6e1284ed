// SPDX-License-Identifier: Apache-2.0
// The clients of the read benchmark: each sends a request, waits for its whole reply, and sends the next.
// Promises the same work for every server that is measured. Never looks into a reply but at its length.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "gateway/core/bytes.hpp"

namespace axisgate::bench {

/// FC 3.
struct ReadRequest {
  ReadRequest(std::uint16_t address, std::uint16_t registers);
  std::array<Byte, 12> bytes;
  std::size_t reply_size;
};

/// Replies per second over all clients, after a tenth of the time to get going. Throws std::runtime_error.
[[nodiscard]] double replies_per_second(std::uint16_t port, const ReadRequest& request, int clients,
                                        std::chrono::milliseconds lasting);

}  // namespace axisgate::bench
