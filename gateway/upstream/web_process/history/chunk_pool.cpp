// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/history/chunk_pool.hpp"

namespace axisgate::web {

std::optional<ChunkPool::Place> ChunkPool::next_taken() const {
  return used_ < most_ ? std::nullopt : std::optional(oldest_);
}

ChunkPool::Place ChunkPool::take(Series owner) {
  if (const auto place = next_taken()) give_back(*place);
  Place place = 0;
  if (!free_.empty()) {
    place = free_.back();
    free_.pop_back();
  } else {
    if (made_ == blocks_.size() * kBlock) blocks_.push_back(std::make_unique<Block>());
    place = static_cast<Place>(made_++);
  }
  ++used_;
  Chunk& chunk = (*this)[place];
  chunk.owner = owner;
  chunk.count = 0;
  link_newest(place);
  return place;
}

void ChunkPool::give_back(Place place) {
  unlink(place);
  --used_;
  free_.push_back(place);
}

void ChunkPool::written(Place place) {
  if (place == newest_) return;
  unlink(place);
  link_newest(place);
}

void ChunkPool::link_newest(Place place) {
  Chunk& chunk = (*this)[place];
  chunk.older = newest_;
  chunk.newer = kNone;
  (newest_ == kNone ? oldest_ : (*this)[newest_].newer) = place;
  newest_ = place;
}

void ChunkPool::unlink(Place place) {
  const Chunk& chunk = (*this)[place];
  (chunk.older == kNone ? oldest_ : (*this)[chunk.older].newer) = chunk.newer;
  (chunk.newer == kNone ? newest_ : (*this)[chunk.newer].older) = chunk.older;
}

}  // namespace axisgate::web
