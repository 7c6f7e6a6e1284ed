// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/http/token_buckets.hpp"

#include <algorithm>

namespace axisgate::web {

bool TokenBuckets::takes(const Address& address, SteadyNs now) {
  const Address who = counted_as(address);
  if (full_at_.size() >= kMostAddresses && !full_at_.contains(who)) make_room(now);
  SteadyNs& full_at = full_at_[who];
  full_at = std::max(full_at, now);
  if (full_at - now > (kDepth - 1) * kRefill) return false;
  full_at += kRefill;
  return true;
}

void TokenBuckets::make_room(SteadyNs now) {
  std::erase_if(full_at_, [now](const auto& each) { return each.second <= now; });
  if (full_at_.size() < kMostAddresses) return;
  full_at_.erase(std::ranges::min_element(full_at_, [](const auto& a, const auto& b) { return a.second < b.second; }));
}

}  // namespace axisgate::web
