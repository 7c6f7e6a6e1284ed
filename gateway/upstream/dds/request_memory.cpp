// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/request_memory.hpp"

namespace axisgate::dds {

void RequestMemory::forget_old(Instant now) {
  while (!entries_.empty() && now - entries_.front().at >= kept_) {
    const Entry& old = entries_.front();
    Writer& writer = old.writer->second;
    if (writer.requests.size() > bounds_.sure) --common_;
    const auto newest = writer.newest.find(old.request.axis);
    if (newest != writer.newest.end() && newest->second == old.request.id) writer.newest.erase(newest);
    writer.requests.erase(old.request);
    if (writer.requests.empty()) writers_.erase(old.writer);
    entries_.pop_front();
  }
}

RequestMemory::Entry* RequestMemory::find(const RequestKey& key) {
  const auto writer = writers_.find(key.writer);
  if (writer == writers_.end()) return nullptr;
  const auto found = writer->second.requests.find({key.axis, key.request_id});
  return found == writer->second.requests.end() ? nullptr : &*found->second;
}

bool RequestMemory::has_room(const Guid& writer) const {
  const auto known = writers_.find(writer);
  if (known == writers_.end()) return writers_.size() < bounds_.writers;
  const std::size_t has = known->second.requests.size();
  return has < bounds_.sure || (has < bounds_.of_a_writer && common_ < bounds_.common);
}

RequestMemory::Seen RequestMemory::see(const RequestKey& key, std::uint8_t command, Instant now) {
  forget_old(now);
  const Request request{key.axis, key.request_id};
  if (Entry* const known = find(key)) {
    known->at = now;
    Writer& writer = known->writer->second;
    const Seen seen{Known::again, known->command, writer.newest[key.axis] == key.request_id, known->result};
    writer.newest[key.axis] = key.request_id;
    entries_.splice(entries_.end(), entries_, writer.requests.at(request));
    return seen;
  }
  if (!has_room(key.writer)) return {Known::full};
  const auto writer = writers_.try_emplace(key.writer).first;
  writer->second.requests[request] = entries_.insert(entries_.end(), {writer, request, now, command, 0});
  writer->second.newest[key.axis] = key.request_id;
  if (writer->second.requests.size() > bounds_.sure) ++common_;
  return {Known::first};
}

void RequestMemory::acts(const RequestKey& key, std::uint8_t command) {
  if (Entry* const known = find(key)) {
    known->command = command;
    known->result = 0;
  }
}

void RequestMemory::ended(const RequestKey& key, std::uint8_t command, std::uint8_t result) {
  Entry* const known = find(key);
  if (known != nullptr && known->command == command) known->result = result;
}

}  // namespace axisgate::dds
