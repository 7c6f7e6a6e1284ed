// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/reply_queue.hpp"

#include <utility>

namespace axisgate::dds {

void ReplyQueue::add(Record reply) {
  if (open_ && has_room()) waiting_.push_back(std::move(reply));
}

std::optional<Record> ReplyQueue::next() {
  if (waiting_.empty()) return std::nullopt;
  std::optional<Record> out(std::move(waiting_.front()));
  waiting_.pop_front();
  return out;
}

void ReplyQueue::close() {
  open_ = false;
  waiting_.clear();
}

}  // namespace axisgate::dds
