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

TEST_F(ArbiterTest, counts_how_long_each_has_waited_for_its_first_exchange) {
  const auto of = [&](Priority priority) { return arbiter.waits().by_class()[static_cast<std::size_t>(priority)]; };
  const JobId first = submit(command(0));
  now += 3ms;
  ASSERT_TRUE(arbiter.next(now));
  arbiter.decline();
  EXPECT_EQ(of(Priority::command).total(), 0U) << "it had nothing to send yet";
  now += 2ms;
  ASSERT_EQ(exchange(), first);
  now += 10ms;
  ASSERT_EQ(exchange(), first) << "its second one";
  EXPECT_EQ(of(Priority::command).total(), 1U);
  EXPECT_EQ(of(Priority::command).sum_ns, 5'000'000U);
  arbiter.finish(first);
  arbiter.set_poll_due(1, now + 1ms);
  now += 5ms;
  ASSERT_EQ(exchange(), 0u);
  arbiter.set_poll_due(1, kLongAgo);
  ASSERT_EQ(exchange(), 0u) << "before all that is overdue";
  EXPECT_EQ(of(Priority::poll).total(), 2U);
  EXPECT_EQ(of(Priority::poll).sum_ns, 4'000'000U);
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

}  // namespace
}  // namespace axisgate::test
