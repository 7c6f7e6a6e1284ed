// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/publish/held_replies.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace axisgate::dds {
namespace {

constexpr SteadyNs kNoTime = std::numeric_limits<SteadyNs>::max();

}  // namespace

void HeldReplies::on_reader(const Guid& reader, SteadyNs now) {
  const std::lock_guard lock(mutex_);
  if (readers_.size() < kMaxReplyReaders) readers_.emplace(reader, now);
}

void HeldReplies::on_reader_gone(const Guid& reader) {
  const std::lock_guard lock(mutex_);
  readers_.erase(reader);
  // Whoever is found again, as after a cut, is new once more.
  const auto client = clients_.find(participant_of(reader));
  if (client != clients_.end() && client->second.over) clients_.erase(client);
}

SteadyNs HeldReplies::found_at(const GuidPrefix& participant) const {
  Guid first{};
  std::copy(participant.begin(), participant.end(), first.begin());
  SteadyNs at = kNoTime;
  for (auto next = readers_.lower_bound(first); next != readers_.end() && same_participant(next->first, first); ++next)
    at = std::min(at, next->second);
  return at;
}

SteadyNs HeldReplies::due_of(const GuidPrefix& participant, const Client& client) const {
  const SteadyNs found = found_at(participant);
  const SteadyNs patience = client.asked + kReplyPatience;
  return found == kNoTime ? patience : std::min(patience, std::max(client.asked, found) + kReaderGrace);
}

/// Those that are waited for no longer make way: at worst one is waited for once more.
bool HeldReplies::make_room() {
  if (clients_.size() < kMaxReplyClients) return true;
  std::erase_if(clients_, [](const auto& each) { return each.second.over; });
  return clients_.size() < kMaxReplyClients;
}

bool HeldReplies::hold(const Record& reply, const Guid& client, SteadyNs now) {
  const std::lock_guard lock(mutex_);
  const GuidPrefix participant = participant_of(client);
  auto known = clients_.find(participant);
  if (known == clients_.end()) {
    const SteadyNs found = found_at(participant);
    if (found != kNoTime && now - found >= kReaderSettled) return false;
    if (!make_room()) return false;
    known = clients_.emplace(participant, Client{now}).first;
  }
  if (known->second.over) return false;
  known->second.held.push_back(reply);
  ++held_;
  return true;
}

std::vector<Record> HeldReplies::take(SteadyNs now) {
  const std::lock_guard lock(mutex_);
  std::vector<Record> out;
  const bool full = held_ >= kMaxRepliesHeld;
  for (auto& [participant, client] : clients_) {
    if (client.over || (!full && now < due_of(participant, client))) continue;
    held_ -= client.held.size();
    std::move(client.held.begin(), client.held.end(), std::back_inserter(out));
    client.held.clear();
    client.over = true;
  }
  return out;
}

SteadyNs HeldReplies::due() const {
  const std::lock_guard lock(mutex_);
  if (held_ >= kMaxRepliesHeld) return 0;
  SteadyNs due = kNoTime;
  for (const auto& [participant, client] : clients_)
    if (!client.over) due = std::min(due, due_of(participant, client));
  return due;
}

}  // namespace axisgate::dds
