// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/client/object_buffers.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::modbus_tcp {
namespace {

bool is_over(Instant since, Instant now) { return now - since >= kObjectKept; }

}  // namespace

void ObjectBuffers::keep(const ObjectKey& key, ObjectBytes content, Instant now) {
  forget(key);
  if (kept_.size() == kMaxKeptObjects) kept_.erase(kept_.begin());
  kept_.push_back({key, std::move(content), now});
}

void ObjectBuffers::forget(const ObjectKey& key) {
  const auto found = std::ranges::find_if(kept_, [&](const Kept& each) { return each.key == key; });
  if (found != kept_.end()) kept_.erase(found);
}

ObjectBytes ObjectBuffers::kept(const ObjectKey& key, Instant now) const {
  const auto found = std::ranges::find_if(kept_, [&](const Kept& each) { return each.key == key; });
  return found == kept_.end() || is_over(found->at, now) ? nullptr : found->content;
}

bool ObjectBuffers::add_part(const ObjectKey& key, std::size_t start, Bytes part, Instant now) {
  if (start == 0) written_ = Written{key, {}, now};
  const bool fits = written_ && written_->key == key && written_->bytes.size() == start &&
                    !is_over(written_->at, now) && start + part.size() <= kMaxObjectBytes;
  if (!fits) {
    written_.reset();
    return false;
  }
  written_->bytes.insert(written_->bytes.end(), part.begin(), part.end());
  written_->at = now;
  return true;
}

std::optional<std::vector<Byte>> ObjectBuffers::add_last(const ObjectKey& key, std::size_t start, Bytes part,
                                                         Instant now) {
  if (start == 0) {
    if (written_ && written_->key == key) written_.reset();
    return std::vector<Byte>(part.begin(), part.end());
  }
  if (!add_part(key, start, part, now)) return std::nullopt;
  return std::exchange(written_, std::nullopt)->bytes;
}

}  // namespace axisgate::modbus_tcp
