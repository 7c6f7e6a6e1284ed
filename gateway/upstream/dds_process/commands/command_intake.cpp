// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/commands/command_intake.hpp"

#include <algorithm>
#include <utility>

#include "gateway/upstream/dds_link/stop_commands.hpp"

namespace axisgate::dds {
namespace {

bool take_from(std::deque<CommandRecord>& queue, std::size_t most, std::vector<Record>& taken) {
  for (; !queue.empty() && most > 0; queue.pop_front(), --most) taken.emplace_back(std::move(queue.front()));
  return queue.empty();
}

}  // namespace

bool CommandIntake::has_room(bool for_a_stop) const {
  const std::lock_guard lock(mutex_);
  return for_a_stop ? stops_.size() < kMaxStopsWaiting : others_.size() < kMaxCommandsWaiting;
}

void CommandIntake::add(CommandRecord record, SteadyNs now) {
  const std::lock_guard lock(mutex_);
  newest_ = std::max(newest_ + 1, now);
  record.received = newest_;
  (is_stop_command(record.command) ? stops_ : others_).push_back(std::move(record));
}

bool CommandIntake::take(std::size_t most_stops, std::size_t most_others, std::vector<Record>& taken) {
  const std::lock_guard lock(mutex_);
  return take_from(stops_, most_stops, taken) && take_from(others_, most_others, taken);
}

}  // namespace axisgate::dds
