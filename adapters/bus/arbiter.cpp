// SPDX-License-Identifier: Apache-2.0
#include "adapters/bus/arbiter.hpp"

#include <algorithm>
#include <cassert>

namespace axisgate::bus {

namespace {

/// kNoAxis is an axis of its own here: what concerns the whole drive has one queue.
bool same_axis(const BusJob& a, const BusJob& b) { return a.drive == b.drive && a.axis == b.axis; }

/// Bus jobs of which one may be started at a time.
bool exclude_each_other(const BusJob& a, const BusJob& b) {
  if (a.priority != b.priority || a.priority == Priority::stop) return false;
  return a.priority == Priority::setup ? a.drive == b.drive : same_axis(a, b);
}

bool falls_to_stop(const BusJob& job, bool started, const BusJob& stop) {
  if (job.drive != stop.drive || (stop.axis != kNoAxis && job.axis != stop.axis)) return false;
  if (job.survives_stop) return false;
  return job.priority == Priority::command || (job.priority == Priority::interactive && !started);
}

bool is_plain_read(const BusJob& job) { return job.read.has_value() && job.writes.empty(); }

}  // namespace

struct Arbiter::Candidate {
  Grant grant;
  bool deferred = false;
  int rank = 0;
  bool started = false;
  std::uint64_t served = 0;
  JobId place = 0;

  /// The order in which the wire is given away, in five comparisons.
  [[nodiscard]] bool goes_before(const Candidate& other) const {
    if (deferred != other.deferred) return other.deferred;       // who answers before who did not
    if (rank != other.rank) return rank < other.rank;            // stop, cause, a poll that is owed, then by class
    if (rank == 0 && started != other.started) return !started;  // a new stop before what follows from an older one
    if (served != other.served) return served < other.served;    // drives take turns inside a class
    return place < other.place;                                  // in order of acceptance
  }
};

Arbiter::Arbiter(std::size_t drives) : drives_(drives) {
  assert(drives <= kMaxDrivesPerBus);
  const std::size_t most = kMaxJobsPerBus + kMaxStopsPerBus + (kMaxSetupsPerDrive + kMaxCausesPerDrive) * drives;
  entries_.reserve(most);
  endings_.reserve(most);
}

Arbiter::Submission Arbiter::submit(const BusJob& job, Instant now) {
  assert(job.drive < drives_.size() && job.priority != Priority::poll);
  expire_starts(now);
  if (job.priority == Priority::stop) {
    drop_for_stop(job);
  } else if (Entry* waiting = joinable(job)) {
    ++statistics_.coalesced;
    waiting->job.start_by = std::max(waiting->job.start_by, job.start_by);
    return {Errc::ok, waiting->id, true};
  }
  Entry entry{.id = last_id_ + 1, .place = last_id_ + 1, .job = job, .waits_since = now};
  if (const Entry* older = supersedable(job)) {
    ++statistics_.superseded;
    entry.place = older->place;
    end_where([id = older->id](const Entry& e) { return e.id == id; }, [](const Entry&) { return Errc::superseded; });
  } else if (full(job)) {
    ++statistics_.refused;
    return {Errc::queue_full, 0, false};
  }
  ++last_id_;
  entries_.push_back(entry);
  return {Errc::ok, last_id_, false};
}

std::optional<Arbiter::Grant> Arbiter::next(Instant now) {
  expire_starts(now);
  if (wire_busy_ || now < silent_until_) return std::nullopt;
  const std::optional<Candidate> chosen = choose(now);
  if (!chosen) return std::nullopt;
  const Grant& grant = chosen->grant;
  DriveTurns& drive = drives_[grant.drive];
  drive.served[static_cast<std::size_t>(grant.priority)] = ++grants_;
  Instant waits_since = drive.poll_due == kLongAgo ? now : drive.poll_due;  // before all that is overdue
  if (Entry* entry = find(grant.id)) {
    waits_since = entry->waits_since;
    entry->started = true;
    others_since_poll_ = std::min(others_since_poll_ + 1, kOthersPerPoll);
  } else {
    drive.poll_due = kNever;
    others_since_poll_ = 0;
  }
  wire_busy_ = true;
  granted_ = {grant.id, grant.drive, now, grant.priority, waits_since};
  return grant;
}

std::optional<Arbiter::Candidate> Arbiter::choose(Instant now) const {
  std::optional<Candidate> best;
  const auto consider = [&best](const Candidate& one) {
    if (!best || one.goes_before(*best)) best = one;
  };
  for (const Entry& entry : entries_) {
    if (entry.started ? entry.ready_at <= now : !blocked(entry)) consider(candidate(entry));
  }
  for (std::size_t slot = 0; slot < drives_.size(); ++slot) {
    if (drives_[slot].poll_ready_at() <= now) consider(poll_candidate(static_cast<DriveSlot>(slot)));
  }
  return best;
}

Arbiter::Candidate Arbiter::candidate(const Entry& entry) const {
  static constexpr std::array<int, kPriorityCount> kRanks{0, 1, 3, 4, 5, 6};
  const auto priority = static_cast<std::size_t>(entry.job.priority);
  return {.grant = {entry.id, entry.job.drive, entry.job.priority, entry.job.axis},
          .deferred = deferred(entry.job.drive, entry.job.priority),
          .rank = kRanks[priority],
          .started = entry.started,
          .served = drives_[entry.job.drive].served[priority],
          .place = entry.place};
}

Arbiter::Candidate Arbiter::poll_candidate(DriveSlot drive) const {
  return {.grant = {0, drive, Priority::poll},
          .deferred = deferred(drive, Priority::poll),
          .rank = others_since_poll_ >= kOthersPerPoll ? 2 : 6,
          .served = drives_[drive].served[static_cast<std::size_t>(Priority::poll)]};
}

bool Arbiter::deferred(DriveSlot drive, Priority priority) const {
  return priority > Priority::cause && owed_to_answers_ > Duration{} && drives_[drive].unanswered;
}

bool Arbiter::blocked(const Entry& entry) const {
  return std::ranges::any_of(entries_,
                             [&](const Entry& e) { return e.started && exclude_each_other(e.job, entry.job); });
}

void Arbiter::decline() {
  assert(wire_busy_);
  wire_busy_ = false;
  const Instant pause_over = granted_.at + kDeclinePause;
  if (granted_.id == 0) {
    drives_[granted_.drive].poll_not_before = pause_over;
  } else if (Entry* entry = find(granted_.id)) {
    entry->ready_at = std::max(entry->ready_at, pause_over);
  }
}

void Arbiter::exchange_over(Instant silent_until, bool lost) {
  assert(wire_busy_);
  wire_busy_ = false;
  if (granted_.waits_since != kNever) waits_.add(granted_.priority, granted_.at - granted_.waits_since);
  if (Entry* entry = find(granted_.id)) entry->waits_since = kNever;
  silent_until_ = silent_until;
  drives_[granted_.drive].unanswered = lost;
  const Duration taken = silent_until - granted_.at;
  owed_to_answers_ = lost ? std::max(owed_to_answers_, taken) : std::max(owed_to_answers_ - taken, Duration{});
}

void Arbiter::wait(JobId id, Instant until) {
  Entry* entry = find(id);
  if (entry != nullptr && entry->started) entry->ready_at = until;
}

bool Arbiter::go_on_as(JobId id, const BusJob& rest) {
  Entry* entry = find(id);
  if (entry == nullptr || !entry->started) return false;
  BusJob job = rest;
  job.drive = entry->job.drive;
  job.axis = entry->job.axis;
  if (full(job)) return false;
  entry->job = job;
  return true;
}

void Arbiter::finish(JobId id) {
  std::erase_if(entries_, [id](const Entry& e) { return e.id == id; });
  std::erase_if(endings_, [id](const Ending& e) { return e.id == id; });
}

void Arbiter::set_poll_due(DriveSlot drive, Instant due) {
  assert(drive < drives_.size());
  drives_[drive].poll_due = due;
}

Arbiter::Entry* Arbiter::joinable(const BusJob& job) {
  if (!is_plain_read(job)) return nullptr;
  // From the newest back: beyond the first write of the drive, a waiting read could be answered with what was before
  // it.
  for (auto e = entries_.rbegin(); e != entries_.rend(); ++e) {
    if (e->job.drive != job.drive) continue;
    if (!is_plain_read(e->job)) return nullptr;
    const bool as_lasting = e->job.survives_stop || !job.survives_stop;
    if (!e->started && e->job.axis == job.axis && e->job.read == job.read && e->job.priority <= job.priority &&
        as_lasting) {
      return &*e;
    }
  }
  return nullptr;
}

const Arbiter::Entry* Arbiter::supersedable(const BusJob& job) const {
  if (!job.setpoints_only) return nullptr;
  // The newest of the axis, whatever it is: anything accepted between forbids it.
  const auto e =
      std::find_if(entries_.rbegin(), entries_.rend(), [&](const Entry& entry) { return same_axis(entry.job, job); });
  if (e == entries_.rend() || e->started || !e->job.setpoints_only) return nullptr;
  return e->job.priority == job.priority && e->job.writes == job.writes ? &*e : nullptr;
}

bool Arbiter::full(const BusJob& job) const {
  const auto count = [&](auto which) {
    return static_cast<std::size_t>(std::ranges::count_if(entries_, [&](const Entry& e) { return which(e.job); }));
  };
  const auto same_class = [&](const BusJob& o) { return o.priority == job.priority; };
  const auto same_class_and_axis = [&](const BusJob& o) { return same_class(o) && same_axis(o, job); };
  switch (job.priority) {
    case Priority::stop:
      return count(same_class) >= kMaxStopsPerBus || count(same_class_and_axis) >= kMaxStopsPerAxis;
    case Priority::setup:
      return count([&](const BusJob& o) { return same_class(o) && o.drive == job.drive; }) >= kMaxSetupsPerDrive;
    case Priority::cause:
      return count([&](const BusJob& o) { return same_class(o) && o.drive == job.drive; }) >= kMaxCausesPerDrive;
    default:
      return count([](const BusJob& o) {
               return o.priority == Priority::command || o.priority == Priority::interactive;
             }) >= kMaxJobsPerBus ||
             (job.priority == Priority::command && count(same_class_and_axis) >= kMaxJobsPerAxis);
  }
}

Arbiter::Entry* Arbiter::find(JobId id) {
  const auto at = std::ranges::find(entries_, id, &Entry::id);
  return at == entries_.end() ? nullptr : &*at;
}

template <typename Which, typename Reason>
void Arbiter::end_where(Which which, Reason reason) {
  std::erase_if(entries_, [&](const Entry& entry) {
    if (!which(entry)) return false;
    endings_.push_back({entry.id, entry.job.drive, reason(entry), entry.job.axis});
    return true;
  });
}

void Arbiter::drop_for_stop(const BusJob& stop) {
  end_where([&](const Entry& e) { return falls_to_stop(e.job, e.started, stop); },
            [](const Entry&) { return Errc::dropped_by_stop; });
}

void Arbiter::expire_starts(Instant now) {
  end_where([now](const Entry& e) { return !e.started && e.job.start_by <= now; },
            [](const Entry&) { return Errc::never_started; });
}

void Arbiter::end_drive(DriveSlot drive, Errc waiting, Errc started) {
  end_where([drive](const Entry& e) { return e.job.drive == drive; },
            [&](const Entry& e) { return e.started ? started : waiting; });
}

void Arbiter::end_all(Errc waiting, Errc started) {
  end_where([](const Entry&) { return true; }, [&](const Entry& e) { return e.started ? started : waiting; });
  wire_busy_ = false;
  silent_until_ = kLongAgo;
  owed_to_answers_ = {};
}

std::optional<Arbiter::Ending> Arbiter::take_ending(Instant now) {
  expire_starts(now);
  if (endings_.empty()) return std::nullopt;
  const Ending first = endings_.front();
  endings_.erase(endings_.begin());
  return first;
}

Instant Arbiter::next_deadline() const {
  if (!endings_.empty()) return kLongAgo;
  Instant next = kNever;
  const auto wire_wanted_at = [&](Instant at) {
    if (!wire_busy_) next = std::min(next, std::max(at, silent_until_));
  };
  for (const Entry& entry : entries_) {
    if (entry.started) {
      wire_wanted_at(entry.ready_at);
    } else {
      next = std::min(next, entry.job.start_by);
      if (!blocked(entry)) wire_wanted_at(kLongAgo);
    }
  }
  for (const DriveTurns& drive : drives_) wire_wanted_at(drive.poll_ready_at());
  return next;
}

std::size_t Arbiter::waiting() const {
  return static_cast<std::size_t>(std::ranges::count(entries_, false, &Entry::started));
}

}  // namespace axisgate::bus
