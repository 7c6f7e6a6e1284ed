#include "gateway/upstream/dds_process/writer_watch.hpp"

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
  if (Writer* known = find_or_add(writer)) known->statement = statement;
}

void WriterWatch::on_matched(const Guid& writer, SteadyNs now) {
  const std::lock_guard lock(mutex_);
  Writer* known = find_or_add(writer);
  if (known == nullptr || known->matched) return;
  known->matched = true;
  known->good_until = now + known->statement.lease.length + kFirstGrace;
}

void WriterWatch::on_unmatched(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  Writer* known = find(writer);
  if (known == nullptr) return;
  known->matched = false;
  known->heard = false;
  known->lost_since = known->told;
}

void WriterWatch::on_asserted(const Guid& writer, LivelinessKind kind) {
  const std::lock_guard lock(mutex_);
  if (asserted_.size() < kMaxAssertedKnown || asserted_.contains(writer))
    asserted_[writer] = kind;
  else
    too_many_asserted_ = true;
}

bool WriterWatch::believed(const Guid& writer, LivelinessKind kind) const {
  if (kind == LivelinessKind::manual_by_topic) return true;
  constexpr std::ptrdiff_t kPrefix = 12;  // DDSI-RTPS 9.3.1: the participant's part of a GUID
  return !too_many_asserted_ && std::all_of(asserted_.begin(), asserted_.end(), [&](const auto& each) {
    return each.second != kind || std::equal(writer.begin(), writer.begin() + kPrefix, each.first.begin());
  });
}

void WriterWatch::on_removed(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  asserted_.erase(writer);
  Writer* known = find(writer);
  if (known == nullptr) return;
  if (!known->told) {
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
  if (alive) return;
  known->good_until = 0;
  known->lost_since = known->told;
}

void WriterWatch::on_sample(const Guid& writer, SteadyNs now) {
  const std::lock_guard lock(mutex_);
  Writer* known = find(writer);
  if (known != nullptr) known->good_until = std::max(known->good_until, now + known->statement.lease.length);
}

// Of a stronger one no sample is held back, and none is to be lost for another's sake.
bool WriterWatch::holds_others_back(const Writer& silent, SteadyNs now) const {
  if (!silent.matched || silent.statement.lease.topic != CommandTopic::command) return false;
  return std::none_of(writers_.begin(), writers_.end(), [&](const auto& each) {
    const Writer& other = each.second;
    return other.there(now) && other.statement.lease.topic == CommandTopic::command &&
           other.statement.strength > silent.statement.strength;
  });
}

WriterWatch::Changes WriterWatch::take_changes(SteadyNs now) {
  const std::lock_guard lock(mutex_);
  Changes changes;
  changes.refused = std::exchange(refused_, 0);
  const bool doubted = std::any_of(writers_.begin(), writers_.end(), [&](const auto& each) {
    const LivelinessLease& lease = each.second.statement.lease;
    return lease.length != 0 && each.second.matched && !believed(each.first, lease.kind);
  });
  changes.doubted = doubted && !std::exchange(doubted_, doubted);
  doubted_ = doubted;
  for (auto at = writers_.begin(); at != writers_.end();) {
    auto& [guid, writer] = *at;
    const bool there = writer.there(now);
    const bool gone = writer.told && (writer.lost_since || !there);
    if (gone) {
      const WriterRecord record{guid, writer.told_statement.strength, true, writer.told_statement.where};
      // Of one that is back already, the samples taken may be of its second life.
      (there ? changes.before : changes.after).push_back(record);
      writer.told = false;
      if (!there && holds_others_back(writer, now)) changes.owner_silent = true;
    }
    writer.lost_since = false;
    if (there && (!writer.told || writer.told_statement != writer.statement)) {
      changes.before.push_back({guid, writer.statement.strength, false, writer.statement.where});
      writer.told = true;
      writer.told_statement = writer.statement;
    }
    at = gone && !writer.matched ? writers_.erase(at) : std::next(at);
  }
  return changes;
}

BeatRecord WriterWatch::beats(SteadyNs now) const {
  const std::lock_guard lock(mutex_);
  BeatRecord record;
  for (const auto& [guid, writer] : writers_) {
    if (record.beats.size() == kMaxBeats) break;
    const LivelinessLease& lease = writer.statement.lease;
    if (writer.told && lease.length != 0 && writer.there(now) && believed(guid, lease.kind)) {
      record.beats.push_back({guid, lease.kind != LivelinessKind::automatic});
    }
  }
  return record;
}

std::set<LivelinessLease> WriterWatch::leases() const {
  const std::lock_guard lock(mutex_);
  std::set<LivelinessLease> all;
  for (const auto& [guid, writer] : writers_) {
    if (writer.statement.lease.length != 0) all.insert(writer.statement.lease);
  }
  return all;
}

}  // namespace axisgate::dds
