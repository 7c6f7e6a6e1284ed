// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/discovery/writer_watch.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace axisgate::dds {

WriterWatch::Writer* WriterWatch::find(const Guid& writer) {
  const auto found = writers_.find(writer);
  return found == writers_.end() ? nullptr : &found->second;
}

WriterWatch::Writer* WriterWatch::find_or_add(const Guid& writer) {
  if (Writer* known = find(writer)) return known;
  if (writers_.size() >= kMaxWritersKnown) {
    ++refused_;
    return nullptr;
  }
  return &writers_[writer];
}

void WriterWatch::on_discovered(const Guid& writer, const WriterStatement& statement) {
  const std::lock_guard lock(mutex_);
  Writer* known = find_or_add(writer);
  if (known == nullptr) return;
  if (!known->discovered) known->good_until += statement.lease.length;  // it was matched without
  known->discovered = true;
  known->statement = statement;
}

void WriterWatch::on_matched(const Guid& writer, SteadyNs now) {
  const std::lock_guard lock(mutex_);
  Writer* known = find_or_add(writer);
  if (known == nullptr || known->matched) return;
  known->matched = true;
  known->asserted = false;
  known->good_until = now + known->statement.lease.length + kFirstGrace;
}

void WriterWatch::on_unmatched(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  Writer* known = find(writer);
  if (known == nullptr) return;
  known->matched = false;
  known->heard = false;
  known->lost_since = known->reported;
}

void WriterWatch::on_removed(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  Writer* known = find(writer);
  if (known == nullptr) return;
  if (!known->reported) {
    writers_.erase(writer);
    return;
  }
  known->matched = false;
  known->heard = false;
  known->lost_since = true;
}

void WriterWatch::on_liveliness(const Guid& writer, const LivelinessLease& asked, bool alive) {
  const std::lock_guard lock(mutex_);
  Writer* known = find(writer);
  if (known == nullptr || known->statement.lease != asked) return;
  known->heard = alive;
  known->asserted = known->asserted || alive;
  if (alive) return;
  known->good_until = 0;
  known->lost_since = known->reported;
}

void WriterWatch::on_sample(const Guid& writer, SteadyNs now) {
  const std::lock_guard lock(mutex_);
  Writer* known = find(writer);
  if (known == nullptr) return;
  known->asserted = true;
  known->good_until = std::max(known->good_until, now + known->statement.lease.length);
}

WriterWatch::Changes WriterWatch::take_changes(SteadyNs now) {
  const std::lock_guard lock(mutex_);
  Changes changes;
  changes.refused = std::exchange(refused_, 0);
  for (auto at = writers_.begin(); at != writers_.end();) {
    auto& [guid, writer] = *at;
    const bool there = writer.there(now);
    const bool gone = writer.reported && (writer.lost_since || !there);
    if (gone) {
      const WriterRecord record{guid, writer.reported_statement.strength, true, writer.reported_statement.where,
                                writer.reported_statement.kind};
      // Of one that is back already, the samples taken may be of its second life.
      (there ? changes.before : changes.after).push_back(record);
      writer.reported = false;
    }
    writer.lost_since = false;
    if (there && (!writer.reported || writer.reported_statement != writer.statement)) {
      changes.before.push_back({guid, writer.statement.strength, false, writer.statement.where, writer.statement.kind});
      writer.reported = true;
      writer.reported_statement = writer.statement;
    }
    at = gone && !writer.matched ? writers_.erase(at) : std::next(at);
  }
  return changes;
}

std::vector<BeatRecord> WriterWatch::beats(SteadyNs now) const {
  const std::lock_guard lock(mutex_);
  std::vector<BeatRecord> records(1, BeatRecord{{}, now});
  for (const auto& [guid, writer] : writers_) {
    if (!writer.reported || !writer.asserted || writer.statement.lease.length == 0 || !writer.there(now)) continue;
    if (records.back().writers.size() == kMaxBeats) records.push_back({{}, now});
    records.back().writers.push_back(guid);
  }
  return records;
}

std::set<LivelinessLease> WriterWatch::leases() const {
  const std::lock_guard lock(mutex_);
  std::set<LivelinessLease> all;
  for (const auto& [guid, writer] : writers_) {
    if (writer.discovered && writer.matched && writer.statement.lease.length != 0) all.insert(writer.statement.lease);
  }
  return all;
}

}  // namespace axisgate::dds
