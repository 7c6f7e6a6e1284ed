// SPDX-License-Identifier: Apache-2.0
// Whether a link that opens and closes its device still has the opening for which a handler was made.
// Promises a true answer in a handler that runs after its link is gone. Never keeps a link alive.
#pragma once

#include <cstdint>
#include <memory>

namespace axisgate::serial {

/// True as long as the link exists and has the same opening as when this was made. `opening` is the link's own count.
class StillOpen {
 public:
  explicit StillOpen(const std::shared_ptr<std::uint64_t>& opening) : opening_(opening), mine_(*opening) {}
  explicit operator bool() const {
    const auto opening = opening_.lock();
    return opening != nullptr && *opening == mine_;
  }

 private:
  std::weak_ptr<std::uint64_t> opening_;
  std::uint64_t mine_;
};

}  // namespace axisgate::serial
