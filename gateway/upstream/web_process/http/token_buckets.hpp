// SPDX-License-Identifier: Apache-2.0
// How many requests an address has: a bucket of kDepth for each, filled by kEachSecond a second.
// Promises a bounded table: where it is full, the address that has the most left is forgotten first, which is the one
// that loses least by it. Never says what a request asks for.
#pragma once

#include <cstdint>
#include <map>

#include "gateway/upstream/web_process/http/address.hpp"
#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::web {

class TokenBuckets {
 public:
  static constexpr std::int64_t kDepth = 100;
  static constexpr std::int64_t kEachSecond = 50;
  static constexpr SteadyNs kRefill = kSecond / kEachSecond;
  static constexpr std::size_t kMostAddresses = 1024;

  /// False: the address has none left.
  [[nodiscard]] bool takes(const Address& address, SteadyNs now);
  [[nodiscard]] std::size_t addresses() const { return full_at_.size(); }

 private:
  void make_room(SteadyNs now);
  /// When each bucket is full again: this one instant says how much is in it.
  std::map<Address, SteadyNs> full_at_;
};

}  // namespace axisgate::web
