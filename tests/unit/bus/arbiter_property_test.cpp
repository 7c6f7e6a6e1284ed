// SPDX-License-Identifier: Apache-2.0
// Random operations, each answer judged by the reference; then time alone must bring everything to an end.
#include "gateway/core/random.hpp"
#include "tests/unit/bus/arbiter_reference.hpp"

namespace axisgate::test {
namespace {

class RandomRun {
 public:
  explicit RandomRun(std::uint64_t seed) : random_(seed) {}

  void step() {
    // Rush and quiet by turns: some rules show only on a full queue, others only on one that runs dry.
    if (random_.chance(1, 256)) jobs_per_16_ = random_.below(17);
    switch (random_.below(16)) {
      case 0:
      case 1:
      case 2:
      case 3:
        if (random_.below(16) < jobs_per_16_) submit();
        break;
      case 4:
      case 5:
      case 6:
        grant();
        break;
      case 7:
      case 8:
      case 9:
        end_exchange();
        break;
      case 10:
        wait_or_finish();
        break;
      case 11:
        poll_due();
        break;
      case 12:
        now_ += milliseconds(random_.below(8));
        break;
      case 13:
        take_endings();
        break;
      case 14:
        check_next_deadline();
        break;
      default:
        rare_event();
        break;
    }
  }

  /// No more bus jobs come: what is left must end within one start deadline and its own few exchanges.
  void drain() {
    for (int i = 0; i < 2000 && !(reference_.quiet() && !arbiter_.wire_busy()); ++i) {
      if (arbiter_.wire_busy()) {
        reference_.on_over(now_);
        arbiter_.exchange_over(now_);
        if (granted_ != 0) finish(granted_);
      }
      grant();
      take_endings();
      if (!arbiter_.wire_busy()) now_ += milliseconds(1);
    }
    EXPECT_TRUE(reference_.quiet()) << "a bus job is stranded";
    EXPECT_EQ(arbiter_.waiting(), 0u);
  }

 private:
  static Duration milliseconds(std::uint64_t count) {
    return std::chrono::milliseconds(static_cast<std::int64_t>(count));
  }

  void submit() {
    BusJob o =
        job(static_cast<Priority>(random_.below(5)), static_cast<DriveSlot>(random_.below(ArbiterReference::kDrives)),
            static_cast<AxisSlot>(random_.below(2)));
    if (o.priority == Priority::stop && !random_.chance(1, 4)) o.priority = Priority::command;
    if (random_.chance(1, o.priority == Priority::setup ? 2 : 16)) o.axis = kNoAxis;
    if (random_.chance(1, 2)) o.start_by = now_ + milliseconds(random_.below(40));
    o.survives_stop = random_.chance(1, 4);
    if (o.priority == Priority::command && random_.chance(1, 2)) {
      o.setpoints_only = true;
      o.writes.push_back(random_.chance(1, 2) ? kTargetPosition : kProfileVelocity);
    } else if (random_.chance(1, 2)) {
      o.read = {random_.chance(1, 2) ? kStatusword : kTargetPosition,
                static_cast<std::uint8_t>(random_.chance(1, 2) ? 2 : 4)};
    }
    const auto submission = arbiter_.submit(o, now_);
    reference_.on_submit(o, submission, now_);
  }
  void grant() {
    if (const auto granted = arbiter_.next(now_)) {
      reference_.on_grant(*granted, now_);
      granted_ = granted->id;
    } else {
      reference_.on_nothing(now_);
    }
  }
  void end_exchange() {
    ASSERT_EQ(arbiter_.wire_busy(), reference_.busy());
    if (!reference_.busy()) return;
    if (random_.chance(1, 8)) {
      reference_.on_decline();
      arbiter_.decline();
    } else {
      const bool lost = random_.chance(1, 4);
      if (lost) now_ += milliseconds(random_.below(40));
      const Instant silent_until = now_ + milliseconds(random_.below(3));
      reference_.on_over(silent_until, lost);
      arbiter_.exchange_over(silent_until, lost);
    }
    if (granted_ != 0 && random_.chance(1, 2)) finish(granted_);
  }
  void wait_or_finish() {
    if (reference_.known().empty()) return;
    auto at = reference_.known().begin();
    std::advance(at, static_cast<long>(random_.below(reference_.known().size())));
    const JobId id = at->first;
    if (random_.chance(1, 4)) return finish(id);
    const Instant until = now_ + milliseconds(random_.below(20));
    reference_.on_wait(id, until);
    arbiter_.wait(id, until);
  }
  void finish(JobId id) {
    reference_.on_finish(id);
    arbiter_.finish(id);
  }
  void poll_due() {
    const auto drive = static_cast<DriveSlot>(random_.below(ArbiterReference::kDrives));
    const Instant due = random_.chance(1, 8) ? kNever : now_ + milliseconds(random_.below(10));
    reference_.on_poll_due(drive, due);
    arbiter_.set_poll_due(drive, due);
  }
  void take_endings() {
    for (bool more = true; more;) {
      const auto ending = arbiter_.take_ending(now_);
      reference_.on_ending(ending, now_);
      more = ending.has_value();
    }
  }
  void rare_event() {
    if (random_.chance(1, 8)) {
      reference_.on_end(std::nullopt, Errc::offline, Errc::link_lost);
      arbiter_.end_all(Errc::offline, Errc::link_lost);
    } else if (random_.chance(1, 4)) {
      const auto drive = static_cast<DriveSlot>(random_.below(ArbiterReference::kDrives));
      reference_.on_end(drive, Errc::offline, Errc::timed_out);
      arbiter_.end_drive(drive, Errc::offline, Errc::timed_out);
    }
  }
  /// Before that instant nothing new comes, at it something does.
  void check_next_deadline() {
    Arbiter then = arbiter_;
    if (then.take_ending(now_) || then.next(now_)) return;
    const Instant deadline = arbiter_.next_deadline();
    ASSERT_GT(deadline, now_);
    const Instant before = deadline == kNever ? now_ + std::chrono::hours(1) : deadline - Duration(1);
    EXPECT_FALSE(then.take_ending(before));
    EXPECT_FALSE(then.next(before));
    if (deadline == kNever) return;
    EXPECT_TRUE(then.take_ending(deadline).has_value() || then.next(deadline).has_value());
  }

  Random random_;
  Arbiter arbiter_{ArbiterReference::kDrives};
  ArbiterReference reference_;
  Instant now_ = Instant{} + 1h;
  JobId granted_ = 0;
  std::uint64_t jobs_per_16_ = 16;
};

class ArbiterProperty : public testing::TestWithParam<std::uint64_t> {};

TEST_P(ArbiterProperty, keeps_every_rule_and_strands_no_job) {
  RandomRun run(GetParam());
  for (int step = 0; step < 20'000; ++step) {
    run.step();
    ASSERT_FALSE(HasFailure()) << "seed " << GetParam() << ", step " << step;
  }
  run.drain();
}

INSTANTIATE_TEST_SUITE_P(Seeds, ArbiterProperty, testing::Range<std::uint64_t>(1, 17));

}  // namespace
}  // namespace axisgate::test
