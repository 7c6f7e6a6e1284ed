// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/request_memory.hpp"

namespace axisgate::dds {

RequestMemory::Seen RequestMemory::see(const RequestKey& key, Instant now) {
  while (!entries_.empty() && now - entries_.front().at >= kept_) {
    known_.erase(entries_.front().key);
    entries_.pop_front();
  }
  if (const auto found = known_.find(key); found != known_.end()) {
    found->second->at = now;
    entries_.splice(entries_.end(), entries_, found->second);
    return Seen::again;
  }
  if (known_.size() >= most_) return Seen::full;
  known_[key] = entries_.insert(entries_.end(), {key, now});
  return Seen::first;
}

}  // namespace axisgate::dds
