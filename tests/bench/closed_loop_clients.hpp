// The clients of the read benchmark: each sends a request, waits for its whole reply, and sends the next.
// Promises the same work for every server that is measured. Never looks into a reply but at its length.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "gateway/core/bytes.hpp"

namespace axisgate::bench {

struct Load {
  std::uint16_t port = 0;
  Bytes request;
  std::size_t reply_size = 0;
  int clients = 1;
  std::chrono::milliseconds lasting{1000};
};

/// Replies per second over all clients, after a tenth of the time to get going. Throws std::runtime_error.
[[nodiscard]] double replies_per_second(const Load& load);

}  // namespace axisgate::bench
