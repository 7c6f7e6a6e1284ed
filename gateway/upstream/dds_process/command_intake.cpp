// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/command_intake.hpp"

#include <utility>

namespace axisgate::dds {

bool CommandIntake::has_room() const {
  const std::lock_guard lock(mutex_);
  return stops_.size() + others_.size() < kMaxCommandsWaiting;
}

void CommandIntake::add(CommandRecord record, bool stops) {
  const std::lock_guard lock(mutex_);
  (stops ? stops_ : others_).push_back(std::move(record));
}

void CommandIntake::take(std::size_t most, std::vector<Record>& taken) {
  const std::lock_guard lock(mutex_);
  for (std::deque<CommandRecord>* queue : {&stops_, &others_}) {
    for (; !queue->empty() && taken.size() < most; queue->pop_front()) taken.emplace_back(std::move(queue->front()));
  }
}

}  // namespace axisgate::dds
