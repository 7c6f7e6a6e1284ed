// SPDX-License-Identifier: Apache-2.0
// Who gets the wire, and when.
#include "tests/unit/bus/arbiter_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;

using ArbiterTest = ArbiterStage;

TEST_F(ArbiterTest, grants_in_order_of_class_however_they_came) {
  arbiter.set_poll_due(0, now);
  const JobId of_setup = submit(setup(1));
  const JobId of_mailbox = submit(interactive(1));
  const JobId of_command = submit(command(2));
  const JobId of_stop = submit(stop(3));
  EXPECT_EQ(serve(), of_stop);
  EXPECT_EQ(serve(), of_command);
  EXPECT_EQ(serve(), of_mailbox);
  EXPECT_EQ(serve(), of_setup);
  EXPECT_EQ(serve(), 0u) << "the poll";
  EXPECT_EQ(serve(), std::nullopt) << "it is spent until the drive says anew";
  EXPECT_EQ(arbiter.next_deadline(), kNever);
}

TEST_F(ArbiterTest, keeps_the_wire_to_one_exchange) {
  submit(command(0));
  submit(stop(1));
  ASSERT_TRUE(arbiter.next(now));
  EXPECT_TRUE(arbiter.wire_busy());
  EXPECT_EQ(arbiter.next(now), std::nullopt);
  EXPECT_EQ(arbiter.next_deadline(), kNever) << "until the exchange is over, no time changes anything";
}

TEST_F(ArbiterTest, keeps_the_line_silent_even_before_a_stop) {
  submit(command(0));
  ASSERT_TRUE(arbiter.next(now));
  arbiter.exchange_over(now + 4ms);
  submit(stop(1));
  EXPECT_EQ(arbiter.next(now + 3ms), std::nullopt);
  EXPECT_EQ(arbiter.next_deadline(), now + 4ms);
  EXPECT_TRUE(arbiter.next(now + 4ms));
}

TEST_F(ArbiterTest, drives_take_turns_inside_a_class) {
  const JobId first = submit(command(0));
  const JobId second = submit(command(0));
  const JobId of_other = submit(command(1));
  EXPECT_EQ(serve(), first);
  EXPECT_EQ(serve(), of_other) << "drive 1 was served less recently";
  EXPECT_EQ(serve(), second);
}

TEST_F(ArbiterTest, a_turn_taken_in_one_class_costs_none_in_another) {
  arbiter.set_poll_due(1, now);
  ASSERT_EQ(exchange(), 0u);
  submit(command(0));
  serve();
  // Drive 1 was polled longer ago than drive 0 was commanded, but it is drive 0 whose poll has waited.
  arbiter.set_poll_due(0, now);
  arbiter.set_poll_due(1, now);
  ASSERT_EQ(exchange(), 0u);
  EXPECT_EQ(granted_drive, 0);
}

TEST_F(ArbiterTest, what_stood_beside_a_stop_goes_before_what_came_later) {
  const JobId of_stop = submit(stop(0));
  ASSERT_EQ(exchange(), of_stop);
  const JobId later = submit(command(0));
  ASSERT_TRUE(arbiter.go_on_as(of_stop, command(0)));
  const JobId of_other = submit(stop(1));
  EXPECT_EQ(serve(), of_other) << "it has no precedence any more";
  EXPECT_EQ(serve(), of_stop);
  EXPECT_EQ(serve(), later);
}

TEST_F(ArbiterTest, what_stood_beside_a_stop_falls_to_the_next_one) {
  const JobId of_stop = submit(stop(0));
  ASSERT_EQ(exchange(), of_stop);
  ASSERT_TRUE(arbiter.go_on_as(of_stop, command(0)));
  const JobId next = submit(stop(0));
  EXPECT_EQ(serve(), next);
  EXPECT_EQ(serve(), std::nullopt);
}

TEST_F(ArbiterTest, what_stood_beside_a_stop_stays_its_drives_and_its_axis) {
  bus::BusJob of_axis = stop(1);
  of_axis.axis = 1;
  const JobId of_stop = submit(of_axis);
  ASSERT_EQ(exchange(), of_stop);
  ASSERT_TRUE(arbiter.go_on_as(of_stop, command(0)));
  const JobId of_first_drive = submit(stop(0));
  EXPECT_EQ(serve(), of_first_drive);
  EXPECT_EQ(exchange(), of_stop) << "a stop of another drive drops nothing of it";
  EXPECT_EQ(granted_drive, 1);
  of_axis.axis = 0;
  const JobId of_other_axis = submit(of_axis);
  EXPECT_EQ(serve(), of_other_axis);
  EXPECT_EQ(serve(), of_stop);
}

TEST_F(ArbiterTest, only_a_started_job_goes_on_and_only_where_there_is_room) {
  const JobId of_stop = submit(stop(0));
  EXPECT_FALSE(arbiter.go_on_as(of_stop, command(0))) << "it has not begun";
  EXPECT_FALSE(arbiter.go_on_as(of_stop + 1, command(0))) << "there is none";
  ASSERT_EQ(exchange(), of_stop);
  for (std::size_t i = 0; i < bus::kMaxJobsPerAxis; ++i) submit(command(0));
  EXPECT_FALSE(arbiter.go_on_as(of_stop, command(0)));
}

TEST_F(ArbiterTest, commands_of_one_axis_are_never_interleaved_and_those_of_others_do_not_wait_for_them) {
  const JobId first = submit(command(0));
  const JobId second = submit(command(0));
  EXPECT_EQ(exchange(), first);
  EXPECT_EQ(exchange(), first) << "started, so it goes on";
  arbiter.wait(first, now + 20ms);
  EXPECT_EQ(exchange(), std::nullopt) << "the next one waits for the end of this one, not for its pauses";
  const JobId of_other_axis = submit(command(0, 1));
  EXPECT_EQ(serve(), of_other_axis);
  EXPECT_EQ(arbiter.next_deadline(), now + 20ms);
  now += 20ms;
  EXPECT_EQ(exchange(), first);
  arbiter.finish(first);
  EXPECT_EQ(exchange(), second);
}

TEST_F(ArbiterTest, one_setup_runs_per_drive) {
  const JobId first = submit(setup(0));
  submit(setup(0));
  const JobId of_other = submit(setup(1));
  EXPECT_EQ(exchange(), first);
  EXPECT_EQ(exchange(), of_other);
  EXPECT_EQ(exchange(), first);
}

TEST_F(ArbiterTest, poll_gets_every_fifth_exchange_while_one_is_due) {
  std::vector<JobId> seen;
  for (int i = 0; i < 10; ++i) {
    arbiter.set_poll_due(0, now);
    const JobId id = submit(command(1));
    seen.push_back(*exchange() == 0 ? 0 : 1);
    arbiter.finish(id);
  }
  EXPECT_THAT(seen, ElementsAre(1, 1, 1, 1, 0, 1, 1, 1, 1, 0));
}

TEST_F(ArbiterTest, polls_that_are_owed_go_round_all_drives) {
  std::vector<int> polled;
  for (int i = 0; i < 20; ++i) {
    for (DriveSlot drive = 0; drive < kDrives; ++drive) arbiter.set_poll_due(drive, now);
    const JobId id = submit(command(0));
    if (*exchange() == 0) polled.push_back(granted_drive);
    arbiter.finish(id);
  }
  EXPECT_THAT(polled, ElementsAre(0, 1, 2, 3));
}

TEST_F(ArbiterTest, a_poll_that_is_not_due_is_not_owed) {
  arbiter.set_poll_due(0, now + 100ms);
  for (int i = 0; i < 10; ++i) {
    const JobId id = submit(command(1));
    EXPECT_EQ(serve(), id);
  }
  EXPECT_EQ(arbiter.next_deadline(), now + 100ms);
}

TEST_F(ArbiterTest, a_stop_does_not_wait_for_the_share_of_poll) {
  arbiter.set_poll_due(0, now);
  for (int i = 0; i < bus::kOthersPerPoll; ++i) {
    submit(command(1));
    ASSERT_NE(serve(), 0u);
  }
  submit(command(1));
  const JobId halt = submit(stop(2));
  EXPECT_EQ(serve(), halt);
  EXPECT_EQ(serve(), 0u) << "then the poll that is owed";
}

TEST_F(ArbiterTest, a_stop_does_not_wait_for_what_follows_from_an_older_one) {
  const JobId halt = submit(stop(0));
  ASSERT_EQ(exchange(), halt);
  const JobId quick_stop = submit(stop(0));
  const JobId of_other_drive = submit(stop(1));
  EXPECT_EQ(exchange(), of_other_drive) << "the less recently served drive of the two new ones";
  EXPECT_EQ(exchange(), quick_stop);
}

TEST_F(ArbiterTest, a_flood_of_stops_of_one_drive_holds_up_another_by_one_exchange) {
  for (std::size_t i = 0; i < bus::kMaxStopsPerAxis; ++i) submit(stop(0));
  serve();
  const JobId of_other = submit(stop(1));
  EXPECT_EQ(serve(), of_other);
}

/// Drives 0 and 1 want the wire for commands all the time, drives 2 and 3 are to be polled all the time; an answer
/// takes 20 ms. Which drives had it, one digit each; small letters for exchanges that were lost.
std::string who_had_the_wire(int exchanges, Duration timeout, std::initializer_list<DriveSlot> late) {
  Arbiter arbiter(4);
  Instant now = Instant{} + 1h;
  std::string seen;
  for (const DriveSlot drive : {DriveSlot{0}, DriveSlot{1}}) static_cast<void>(arbiter.submit(command(drive), now));
  for (int i = 0; i < exchanges; ++i) {
    for (const DriveSlot drive : {DriveSlot{2}, DriveSlot{3}}) arbiter.set_poll_due(drive, now);
    const auto grant = arbiter.next(now);
    if (!grant) break;
    const bool lost = std::ranges::find(late, grant->drive) != late.end();
    seen += static_cast<char>((lost ? 'a' : '0') + grant->drive);
    now += lost ? timeout : 20ms;
    arbiter.exchange_over(now, lost);
  }
  return seen;
}

TEST_F(ArbiterTest, a_drive_that_does_not_answer_leaves_the_others_as_much_time_as_it_takes) {
  EXPECT_EQ(who_had_the_wire(12, 100ms, {}), "010120101301") << "where all answer, classes and turns decide";
  EXPECT_EQ(who_had_the_wire(18, 100ms, {0}), "a11121a11311a12111");
  EXPECT_EQ(who_had_the_wire(18, 60ms, {0}), "a1112a1113a1112a11")
      << "a shorter timeout, more often; polls keep their fifth";
  EXPECT_EQ(who_had_the_wire(18, 100ms, {0, 1}), "ab23232a32323b2323") << "two of them share that half";
}

TEST_F(ArbiterTest,
       a_drive_that_does_not_answer_goes_on_where_nobody_else_wants_the_wire_and_as_before_when_it_answers) {
  const JobId late = submit(command(0));
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(arbiter.next(now)->id, late);
    now += 100ms;
    arbiter.exchange_over(now, true);
  }
  arbiter.set_poll_due(1, now);
  EXPECT_EQ(exchange(), 0u) << "a poll of a drive that answers goes first";
  ASSERT_EQ(arbiter.next(now)->id, late);
  now += 20ms;
  arbiter.exchange_over(now);
  arbiter.set_poll_due(1, now);
  EXPECT_EQ(exchange(), late) << "it has answered: its command goes first, as all do";
}

TEST_F(ArbiterTest, a_stop_and_a_fault_s_cause_of_a_drive_that_does_not_answer_go_at_once) {
  submit(command(0));
  ASSERT_TRUE(arbiter.next(now));
  now += 100ms;
  arbiter.exchange_over(now, true);
  submit(command(1));
  const JobId cause = submit(job(Priority::cause, 0, bus::kNoAxis));
  const JobId halt = submit(stop(0, 1));
  EXPECT_EQ(serve(), halt);
  EXPECT_EQ(serve(), cause);
}

TEST_F(ArbiterTest, a_bus_job_that_declines_frees_the_wire_at_once_and_is_asked_again_after_a_pause_or_its_own_wait) {
  const JobId idle = submit(command(0));
  const JobId other = submit(command(1));
  ASSERT_EQ(arbiter.next(now)->id, idle);
  arbiter.decline();
  EXPECT_FALSE(arbiter.wire_busy());
  EXPECT_EQ(serve(), other);
  EXPECT_EQ(arbiter.next(now), std::nullopt) << "the loop must come to rest";
  EXPECT_EQ(arbiter.next_deadline(), now + bus::kDeclinePause);
  now += bus::kDeclinePause;
  ASSERT_EQ(arbiter.next(now)->id, idle);
  arbiter.wait(idle, now + 50ms);
  arbiter.decline();
  EXPECT_EQ(arbiter.next_deadline(), now + 50ms) << "a decline does not shorten a wait asked for";
}

}  // namespace
}  // namespace axisgate::test
