// SPDX-License-Identifier: Apache-2.0
// A plain second telling of the arbiter's rules, against which the real one is checked step by step.
// Promises to judge each answer by the words of design section 7 point 3, rule by rule. Never chooses: it only objects.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "tests/unit/bus/arbiter_stage.hpp"

namespace axisgate::test {

class ArbiterReference {
 public:
  struct Known {
    BusJob job;
    JobId place = 0;
    bool started = false;
    Instant ready_at = kLongAgo;
  };
  static constexpr std::size_t kDrives = 3;

  // What happens to the arbiter.
  void on_submit(const BusJob& job, const Arbiter::Submission& submission, Instant now) {
    expire(now);
    if (job.priority == Priority::stop) drop_for(job);
    if (submission.joined) return check_join(job, submission.id);
    JobId place = submission.id;
    if (const auto older = replaceable(job); older != 0) {
      EXPECT_EQ(submission.code, Errc::ok) << "a newer setpoint always finds room";
      place = known_.at(older).place;
      end(older, Errc::superseded);
    }
    if (submission.code == Errc::ok) {
      EXPECT_TRUE(seen_.insert(submission.id).second) << "a number was given twice";
      known_[submission.id] = {job, place};
    } else {
      EXPECT_EQ(submission.code, Errc::queue_full);
    }
    EXPECT_LE(
        count([](const BusJob& o) { return o.priority == Priority::command || o.priority == Priority::interactive; }),
        bus::kMaxJobsPerBus);
    EXPECT_LE(count([&](const BusJob& o) { return o.priority == Priority::command && same_axis(o, job); }),
              bus::kMaxJobsPerAxis);
    EXPECT_LE(count([](const BusJob& o) { return o.priority == Priority::stop; }), bus::kMaxStopsPerBus);
    EXPECT_LE(count([&](const BusJob& o) { return o.priority == Priority::cause && o.drive == job.drive; }),
              bus::kMaxCausesPerDrive);
  }
  void on_grant(const Arbiter::Grant& grant, Instant now) {
    expire(now);
    EXPECT_FALSE(busy_) << "at most one exchange";
    EXPECT_GE(now, silent_until_);
    if (grant.id == 0) {
      check_poll(grant, now);
    } else {
      check_job(grant, now);
    }
    busy_ = true;
    granted_ = grant;
    granted_at_ = now;
    served_[{grant.drive, grant.priority}] = ++grants_;
    others_ = grant.id == 0 ? 0 : others_ + 1;
  }
  void on_nothing(Instant now) {
    expire(now);
    if (busy_ || now < silent_until_) return;
    for (const auto& [id, known] : known_) EXPECT_FALSE(ready(known, now)) << "job " << id << " is stranded";
    for (DriveSlot drive = 0; drive < kDrives; ++drive) EXPECT_FALSE(poll_ready(drive, now)) << "a poll is stranded";
  }
  void on_over(Instant silent_until, bool lost = false) {
    busy_ = false;
    silent_until_ = silent_until;
    lost_[granted_.drive] = lost;
    const Duration taken = silent_until - granted_at_;
    owed_ = lost ? std::max(owed_, taken) : std::max(owed_ - taken, Duration{});
  }
  void on_decline() {
    busy_ = false;
    if (granted_.id == 0) not_before_[granted_.drive] = granted_at_ + bus::kDeclinePause;
    const auto at = known_.find(granted_.id);
    if (at != known_.end()) at->second.ready_at = std::max(at->second.ready_at, granted_at_ + bus::kDeclinePause);
  }
  void on_wait(JobId id, Instant until) {
    if (known_.contains(id) && known_[id].started) known_[id].ready_at = until;
  }
  void on_finish(JobId id) {
    known_.erase(id);
    std::erase_if(ended_, [id](const auto& e) { return e.id == id; });
  }
  void on_poll_due(DriveSlot drive, Instant due) { due_[drive] = due; }
  void on_end(std::optional<DriveSlot> drive, Errc waiting, Errc started) {
    for (const JobId id : ids()) {
      const Known& known = known_.at(id);
      if (!drive || known.job.drive == *drive) end(id, known.started ? started : waiting);
    }
    if (drive) return;
    busy_ = false;
    silent_until_ = kLongAgo;
    owed_ = {};
  }
  void on_ending(const std::optional<Arbiter::Ending>& ending, Instant now) {
    expire(now);
    EXPECT_EQ(ending.has_value(), !ended_.empty());
    if (!ending || ended_.empty()) return;
    EXPECT_EQ(*ending, ended_.front());
    ended_.erase(ended_.begin());
  }

  [[nodiscard]] bool busy() const { return busy_; }
  [[nodiscard]] const std::map<JobId, Known>& known() const { return known_; }
  [[nodiscard]] bool quiet() const { return known_.empty() && ended_.empty(); }

 private:
  static bool same_axis(const BusJob& a, const BusJob& b) { return a.drive == b.drive && a.axis == b.axis; }

  [[nodiscard]] std::vector<JobId> ids() const {
    std::vector<JobId> all;
    for (const auto& [id, known] : known_) all.push_back(id);
    return all;
  }
  template <typename Which>
  [[nodiscard]] std::size_t count(Which which) const {
    return static_cast<std::size_t>(std::ranges::count_if(known_, [&](const auto& k) { return which(k.second.job); }));
  }
  void end(JobId id, Errc code) {
    ended_.push_back({id, known_.at(id).job.drive, code});
    known_.erase(id);
  }
  void expire(Instant now) {
    for (const JobId id : ids()) {
      if (!known_.at(id).started && known_.at(id).job.start_by <= now) end(id, Errc::never_started);
    }
  }
  void drop_for(const BusJob& stop) {
    for (const JobId id : ids()) {
      const Known& k = known_.at(id);
      const bool hit = k.job.drive == stop.drive && (stop.axis == kNoAxis || k.job.axis == stop.axis);
      const bool can_fall =
          k.job.priority == Priority::command || (k.job.priority == Priority::interactive && !k.started);
      if (hit && can_fall && !k.job.survives_stop) end(id, Errc::dropped_by_stop);
    }
  }
  void check_join(const BusJob& job, JobId id) {
    ASSERT_TRUE(known_.contains(id));
    EXPECT_TRUE(job.read.has_value());
    EXPECT_FALSE(known_[id].started) << "never one on the wire";
    EXPECT_EQ(known_[id].job.read, job.read);
    EXPECT_TRUE(same_axis(known_[id].job, job));
    known_[id].job.start_by = std::max(known_[id].job.start_by, job.start_by);
    for (const auto& [other, known] : known_) {
      if (other > id && known.job.drive == job.drive) {
        EXPECT_TRUE(known.job.read && known.job.writes.empty()) << "joined across a write";
      }
    }
  }
  [[nodiscard]] JobId replaceable(const BusJob& job) const {
    JobId newest = 0;
    for (const auto& [id, known] : known_) {
      if (same_axis(known.job, job)) newest = id;
    }
    if (newest == 0 || !job.setpoints_only) return 0;
    const Known& k = known_.at(newest);
    const bool fits =
        !k.started && k.job.setpoints_only && k.job.writes == job.writes && k.job.priority == job.priority;
    return fits ? newest : 0;
  }
  [[nodiscard]] bool ready(const Known& known, Instant now) const {
    if (known.started) return known.ready_at <= now;
    if (known.job.priority == Priority::stop) return true;
    return std::ranges::none_of(known_, [&](const auto& k) {
      const BusJob& o = k.second.job;
      const bool same_queue =
          known.job.priority == Priority::setup ? o.drive == known.job.drive : same_axis(o, known.job);
      return k.second.started && o.priority == known.job.priority && same_queue;
    });
  }
  /// Its drive has lost an exchange, and those that were answered since have not had as much time.
  [[nodiscard]] bool deferred(DriveSlot drive, Priority priority) const {
    return lost_[drive] && owed_ > Duration{} && priority > Priority::cause;
  }
  /// Whether the rules among equals hold between the two; and that nobody who answers waits for who did not.
  [[nodiscard]] bool comparable(const Arbiter::Grant& grant, DriveSlot drive, Priority priority) const {
    const bool mine = deferred(grant.drive, grant.priority);
    const bool others = deferred(drive, priority);
    EXPECT_FALSE(mine && !others) << "drive " << int{drive} << " waited for one that does not answer";
    return mine == others;
  }
  void check_poll(const Arbiter::Grant& grant, Instant now) {
    EXPECT_TRUE(poll_ready(grant.drive, now)) << "a poll before its time";
    due_[grant.drive] = kNever;
    for (const auto& [id, known] : known_) {
      if (!ready(known, now) || !comparable(grant, known.job.drive, known.job.priority)) continue;
      EXPECT_GT(known.job.priority, Priority::cause) << "a stop, or the cause of a fault, waited for a poll";
      EXPECT_GE(others_, bus::kOthersPerPoll) << "a poll went before job " << id << " and was not owed";
    }
    for (DriveSlot drive = 0; drive < kDrives; ++drive) {
      if (poll_ready(drive, now) && comparable(grant, drive, Priority::poll)) {
        EXPECT_LE((served_[{grant.drive, Priority::poll}]), (served_[{drive, Priority::poll}])) << "turns";
      }
    }
  }
  void check_job(const Arbiter::Grant& grant, Instant now) {
    ASSERT_TRUE(known_.contains(grant.id)) << "granted though it has ended";
    Known& mine = known_[grant.id];
    EXPECT_EQ(grant.drive, mine.job.drive);
    EXPECT_EQ(grant.priority, mine.job.priority);
    EXPECT_TRUE(ready(mine, now));
    for (DriveSlot drive = 0; drive < kDrives; ++drive) {
      if (!poll_ready(drive, now) || !comparable(grant, drive, Priority::poll)) continue;
      EXPECT_FALSE(mine.job.priority > Priority::cause && others_ >= bus::kOthersPerPoll)
          << "poll did not get its share";
    }
    for (const auto& [id, known] : known_) {
      if (id == grant.id || !ready(known, now)) continue;
      if (!comparable(grant, known.job.drive, known.job.priority)) continue;
      EXPECT_LE(mine.job.priority, known.job.priority) << "job " << id << " is more urgent";
      if (known.job.priority != mine.job.priority) continue;
      if (mine.job.priority == Priority::stop && mine.started != known.started) {
        EXPECT_FALSE(mine.started) << "a new stop waited for an older one's second exchange";
        continue;
      }
      const auto my_turn = served_[{mine.job.drive, mine.job.priority}];
      const auto other_turn = served_[{known.job.drive, known.job.priority}];
      EXPECT_LE(my_turn, other_turn) << "it was the other drive's turn";
      if (mine.job.drive == known.job.drive) {
        EXPECT_LT(mine.place, known.place) << "out of order";
      }
    }
    mine.started = true;
  }

  std::map<JobId, Known> known_;
  std::vector<Arbiter::Ending> ended_;
  std::set<JobId> seen_;
  [[nodiscard]] bool poll_ready(DriveSlot drive, Instant now) const {
    return due_[drive] <= now && not_before_[drive] <= now;
  }

  std::vector<Instant> not_before_ = std::vector<Instant>(kDrives, kLongAgo);
  std::vector<Instant> due_ = std::vector<Instant>(kDrives, kNever);
  std::map<std::pair<DriveSlot, Priority>, std::uint64_t> served_;
  std::vector<bool> lost_ = std::vector<bool>(kDrives, false);
  Duration owed_{};
  std::uint64_t grants_ = 0;
  int others_ = 0;
  bool busy_ = false;
  Arbiter::Grant granted_;
  Instant granted_at_ = kLongAgo;
  Instant silent_until_ = kLongAgo;
};

}  // namespace axisgate::test
