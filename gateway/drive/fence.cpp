#include "gateway/drive/fence.hpp"

#include <algorithm>

namespace axisgate::drive {

void Fence::lost(bus::ObjectAddress object, Instant now) {
  last_lost_ = now;
  if (std::find(lost_.begin(), lost_.end(), object) == lost_.end() && lost_.size() < kMaxLost) lost_.push_back(object);
}

std::optional<ObjectId> Fence::candidate() const {
  for (const ObjectId id : facts_.candidates)
    if (std::find(lost_.begin(), lost_.end(), objects_[id].address) == lost_.end()) return id;
  return std::nullopt;
}

}  // namespace axisgate::drive
