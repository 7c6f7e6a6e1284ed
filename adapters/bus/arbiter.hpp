// SPDX-License-Identifier: Apache-2.0
// The arbiter of one bus: the only queue to a wire. Pure: bus jobs and instants go in, one grant at a time comes out.
// Promises at most one exchange outstanding; stop before cause before command before interactive before setup before
// poll; turns between drives inside a class; every fifth exchange to poll when one is due; to the others as much time
// as a drive that did not answer has taken; each bus job ends exactly once; every queue bounded. Never looks at a clock
// or a wire, and never repeats anything.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "adapters/bus/bus_job.hpp"
#include "adapters/bus/exchange_times.hpp"
#include "adapters/bus/statistics.hpp"

namespace axisgate::bus {

inline constexpr std::size_t kMaxDrivesPerBus = 127;
/// Poll keeps 20 % of the exchanges: it goes next after this many others while one is due.
inline constexpr int kOthersPerPoll = 4;
/// Stops do not count against the bounds of bus_job.hpp; these are their own. Far more than a plant needs: a drive that
/// has a stop waiting gains nothing from a second one.
inline constexpr std::size_t kMaxStopsPerAxis = 16;
inline constexpr std::size_t kMaxStopsPerBus = 256;
/// Setup is the gateway's own: clients that fill the queue must not keep a drive from coming up.
inline constexpr std::size_t kMaxSetupsPerDrive = 2;
/// So is the reading of causes: one bus job is enough for all axes of a drive.
inline constexpr std::size_t kMaxCausesPerDrive = 1;
/// A drive that declines a grant and neither waits nor finishes is asked again then, not at once: the loop must rest.
inline constexpr Duration kDeclinePause = std::chrono::milliseconds(1);

class Arbiter {
 public:
  explicit Arbiter(std::size_t drives);

  struct Submission {
    Errc code = Errc::ok;  ///< ok, or queue_full
    JobId id = 0;          ///< the bus job; with `joined`, the waiting read that it joined
    bool joined = false;
  };
  /// A stop drops the waiting commands and interactive bus jobs of its axis (of all axes, where it is the drive's) that
  /// do not survive one, and a started one of class command; it does not count against the bounds. A setpoints-only
  /// bus job supersedes a waiting one of the same axis that writes the same objects if nothing of that axis was
  /// accepted between; it takes that one's place in the queue. A read joins an identical waiting one, at least as
  /// urgent, unless something other than a read was accepted for the drive between; that one then waits for the later
  /// of their start deadlines, and who has the earlier one must keep it himself. Bounds: kMaxJobsPerBus, and
  /// kMaxJobsPerAxis of class command.
  [[nodiscard]] Submission submit(const BusJob& job, Instant now);

  struct Grant {
    JobId id = 0;  ///< 0: a poll
    DriveSlot drive = 0;
    Priority priority = Priority::poll;
    AxisSlot axis = kNoAxis;  ///< whose bus job it is
  };
  /// Whose exchange goes on the wire now; none while one is outstanding, the line must be silent or nobody is ready.
  /// A granted bus job is started: its axis's other bus jobs of the same class wait until it is finished (setup: its
  /// drive's; stops do not wait). A granted poll is spent: the drive says again when its next one is due.
  [[nodiscard]] std::optional<Grant> next(Instant now);
  /// The drive granted last had nothing to send after all: the wire is free again at once, the turn is spent. That
  /// bus job, if it is not finished, or that drive's next poll is granted after kDeclinePause at the earliest.
  void decline();
  /// The exchange outstanding is over; the line stays silent until `silent_until`. One that was `lost` has taken the
  /// time of a timeout: its drive's next one, but for stops and causes, waits until answered ones have had as much,
  /// or nobody else wants the wire. So a drive that is always late costs its neighbours one timeout at a time.
  void exchange_over(Instant silent_until, bool lost = false);

  /// A started bus job wants no exchange before `until` (it waits for a condition).
  void wait(JobId id, Instant until);
  /// The bus job has ended, by its owner's word. Unknown ids are ignored: it may have been ended by a stop meanwhile.
  /// An ending of it that was not taken yet is withdrawn: no bus job ends twice.
  void finish(JobId id);
  /// A started bus job goes on as another, and keeps its place: of a stop, what stood beside it. It stays its drive's
  /// and its axis's, whatever `rest` says of them. False: there is no room in its class, or it has ended meanwhile.
  [[nodiscard]] bool go_on_as(JobId id, const BusJob& rest);
  /// The drive's next poll is due then; kNever: none.
  void set_poll_due(DriveSlot drive, Instant due);
  /// All bus jobs of a drive (offline, restarted) or of the bus (link lost) end: the waiting ones with `waiting`, the
  /// started ones with `started`. A link loss also frees the wire.
  void end_drive(DriveSlot drive, Errc waiting, Errc started);
  void end_all(Errc waiting, Errc started);

  struct Ending {
    JobId id = 0;
    DriveSlot drive = 0;
    Errc code = Errc::ok;
    AxisSlot axis = kNoAxis;  ///< whose bus job it was: the number of the bus job says it too, and is what is compared
    friend bool operator==(const Ending& a, const Ending& b) {
      return a.id == b.id && a.drive == b.drive && a.code == b.code;
    }
  };
  /// Bus jobs that the arbiter itself has ended, oldest first: superseded, dropped_by_stop, never_started, or by
  /// end_*(). Start deadlines are seen here and in next().
  [[nodiscard]] std::optional<Ending> take_ending(Instant now);

  /// When next() or take_ending() may give something new without a call in between.
  [[nodiscard]] Instant next_deadline() const;
  [[nodiscard]] bool wire_busy() const { return wire_busy_; }
  [[nodiscard]] std::size_t waiting() const;
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }  ///< refused, coalesced, superseded
  /// By class, from the acceptance of a bus job, or from when a poll was due, to its first exchange.
  [[nodiscard]] const ExchangeTimes& waits() const { return waits_; }

 private:
  struct Entry {
    JobId id = 0;
    JobId place = 0;  ///< its id, or the place of the bus job that it superseded
    BusJob job;
    bool started = false;
    Instant ready_at = kLongAgo;   ///< of a started one
    Instant waits_since = kNever;  ///< its acceptance; kNever: it has had an exchange
  };
  struct DriveTurns {
    Instant poll_due = kNever;
    Instant poll_not_before = kLongAgo;  ///< after a poll that it declined
    bool unanswered = false;             ///< its last exchange was lost
    [[nodiscard]] Instant poll_ready_at() const { return std::max(poll_due, poll_not_before); }
    std::array<std::uint64_t, kPriorityCount> served{};  ///< number of its last grant, per class
  };
  struct Candidate;

  [[nodiscard]] Candidate candidate(const Entry& entry) const;
  [[nodiscard]] Candidate poll_candidate(DriveSlot drive) const;
  [[nodiscard]] std::optional<Candidate> choose(Instant now) const;
  [[nodiscard]] bool deferred(DriveSlot drive, Priority priority) const;
  [[nodiscard]] bool blocked(const Entry& entry) const;
  [[nodiscard]] Entry* joinable(const BusJob& job);
  [[nodiscard]] const Entry* supersedable(const BusJob& job) const;
  [[nodiscard]] bool full(const BusJob& job) const;
  [[nodiscard]] Entry* find(JobId id);
  void drop_for_stop(const BusJob& stop);
  void expire_starts(Instant now);
  /// Ends all bus jobs that `which` picks, with the code that `reason` gives.
  template <typename Which, typename Reason>
  void end_where(Which which, Reason reason);

  std::vector<Entry> entries_;  // in order of acceptance
  std::vector<Ending> endings_;
  std::vector<DriveTurns> drives_;
  JobId last_id_ = 0;
  std::uint64_t grants_ = 0;
  int others_since_poll_ = 0;
  Duration owed_to_answers_{};  ///< time of the wire that answered exchanges have before the next one that may be lost
  bool wire_busy_ = false;
  struct {
    JobId id = 0;
    DriveSlot drive = 0;
    Instant at = kLongAgo;
    Priority priority = Priority::poll;
    Instant waits_since = kNever;  ///< kNever: it is not its first exchange
  } granted_;
  Instant silent_until_ = kLongAgo;
  Statistics statistics_;
  ExchangeTimes waits_;
};

}  // namespace axisgate::bus
