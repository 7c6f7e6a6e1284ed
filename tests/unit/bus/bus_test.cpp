// SPDX-License-Identifier: Apache-2.0
// Grants become exchanges, exchanges get one result, and callbacks may call back.
#include "tests/unit/bus/bus_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

using BusTest = BusStage;

TEST_F(BusTest, a_grant_becomes_one_exchange_and_its_reply_one_result_and_then_the_line_is_silent) {
  bus->set_decode(true);
  EXPECT_TRUE(wire->decode) << "the decode level is passed on";
  link_up();
  submit(0);
  EXPECT_THAT(diary, IsEmpty()) << "the drive does not know the bus job's number yet";
  EXPECT_EQ(runtime.next_deadline(), runtime.now()) << "but the next turn of the loop goes on at once";
  submit(1);
  turn();
  EXPECT_THAT(wire->sent, ElementsAre(drives[0].exchange()));
  wire->reply();
  turn();
  EXPECT_THAT(wire->sent, SizeIs(1));
  EXPECT_EQ(runtime.next_deadline(), runtime.now() + kGap);
  wire->on_send = [this] { wire->reply(); };
  pass_gap();
  EXPECT_THAT(diary, ElementsAre("drive 1: grant 1", "drive 1: ok", "drive 2: grant 2", "drive 2: ok"))
      << "a reply from inside send() is one";
}

TEST_F(BusTest, an_exchange_without_an_answer_times_out_and_the_line_settles) {
  link_up();
  submit(0);
  submit(1);
  turn();
  runtime.advance_by(kTimeout - 1ns);
  EXPECT_EQ(wire->abandoned, 0);
  runtime.advance_by(1ns);
  EXPECT_EQ(wire->abandoned, 1);
  EXPECT_THAT(diary, ElementsAre("drive 1: grant 1", "drive 1: timed out"));
  EXPECT_EQ(runtime.next_deadline(), runtime.now() + kSettle);
  runtime.advance_by(kSettle);
  EXPECT_THAT(wire->sent, SizeIs(2));
}

TEST_F(BusTest, noise_in_place_of_the_answers_of_one_drive_is_told_with_its_number) {
  link_up();
  const auto ask = [&](DriveSlot drive, bool noise) {
    bus->finish(submit(drive));
    const JobId job = submit(drive);
    runtime.advance_by(kSettle);
    wire->counted.bad_frames += noise;
    runtime.advance_by(kTimeout);
    bus->finish(job);
  };
  ask(0, true);
  ask(0, true);
  ask(0, false);
  ask(0, true);
  ask(1, true);
  ask(0, true);
  EXPECT_THAT(log_lines, testing::IsEmpty()) << "silence between them: no number is there twice";
  ask(0, true);
  ask(0, true);
  EXPECT_THAT(log_lines, ElementsAre(testing::AllOf(testing::StartsWith("warning bus lift: node 1: noise came"),
                                                    testing::HasSubstr("two drives with this number"))));
}

TEST_F(BusTest, a_drive_may_submit_finish_wait_and_poll_from_inside_any_callback) {
  link_up();
  JobId second = 0;
  drives[0].result_hook = [&](const ExchangeResult&) {
    if (second != 0) return;
    bus->finish(drives[0].granted);
    second = submit(0);
    bus->set_poll_due(1, bus->now());
  };
  drives[1].result_hook = [&](const ExchangeResult&) { bus->end_drive(0, Errc::offline, Errc::link_lost); };
  drives[0].ended_hook = [&](JobId, Errc) { bus->set_poll_due(1, kNever); };
  submit(0);
  turn();
  wire->reply();
  pass_gap();
  wire->reply();
  bus->wait(second, runtime.now() + 10ms);
  pass_gap();
  EXPECT_THAT(wire->sent, ElementsAre(drives[0].exchange(), drives[0].exchange(), drives[1].exchange()));
  wire->reply();
  EXPECT_THAT(diary, ElementsAre("drive 1: grant 1", "drive 1: ok", "drive 1: grant 2", "drive 1: ok",
                                 "drive 2: grant poll", "drive 2: ok", "drive 1: job 2 link lost"));
}

TEST_F(BusTest, a_turn_of_the_loop_does_bounded_work) {
  link_up();
  for (DiaryDrive& drive : drives) {
    drive.grant_hook = [this](JobId id, Priority) -> std::optional<Exchange> {
      bus->finish(id);
      return std::nullopt;
    };
  }
  for (std::size_t i = 0; i < bus::kMaxJobsPerBus; ++i) submit(0, Priority::interactive);
  submit(1, Priority::stop);
  ASSERT_TRUE(runtime.fire_one(runtime.now()));
  EXPECT_THAT(diary, SizeIs(64));
  EXPECT_EQ(runtime.next_deadline(), runtime.now()) << "the rest goes on in the next turn";
  turn();
  EXPECT_THAT(diary, SizeIs(65));
}

TEST_F(BusTest, a_drive_that_wants_a_poll_and_declines_it_for_ever_lets_the_loop_rest) {
  link_up();
  drives[0].grant_hook = [this](JobId, Priority) -> std::optional<Exchange> {
    bus->set_poll_due(0, bus->now());
    return std::nullopt;
  };
  bus->set_poll_due(0, runtime.now());
  turn();
  EXPECT_THAT(diary, SizeIs(1));
  EXPECT_EQ(runtime.next_deadline(), runtime.now() + bus::kDeclinePause);
}

TEST_F(BusTest, a_stop_waits_for_the_exchange_on_the_wire_and_the_gap_alone) {
  link_up();
  bus->set_poll_due(0, runtime.now());
  bus->set_poll_due(1, runtime.now());
  for (AxisSlot axis = 0; axis < 8; ++axis) {
    for (std::size_t i = 0; i < 4; ++i) submit(1, Priority::command, axis);
    for (std::size_t i = 0; i < 4; ++i) submit(0, Priority::interactive, axis);
  }
  turn();
  ASSERT_TRUE(wire->outstanding);
  const JobId stop = submit(0, Priority::stop, 9);
  turn();
  runtime.advance_by(5ms);
  const Instant replied = runtime.now();
  diary.clear();
  wire->reply();
  pass_gap();
  EXPECT_EQ(drives[0].granted, stop);
  EXPECT_EQ(runtime.now(), replied + kGap);
  EXPECT_THAT(diary, ElementsAre("drive 2: ok", "drive 1: grant 65"));
}

TEST_F(BusTest, counts_its_own_the_arbiters_and_the_wires) {
  link_up();
  wire->counted.late_replies = 3;
  wire->counted.dropped_bytes = 7;
  submit(0);
  submit(1);
  EXPECT_EQ(bus->queue_depth(), 2u);
  turn();
  wire->reply(ended_as(Errc::refused_by_drive));
  runtime.advance_by(kGap + kTimeout);
  bus::Statistics expected;
  expected.requests = 2;
  expected.replies = 1;
  expected.timeouts = 1;
  expected.late_replies = 3;
  expected.dropped_bytes = 7;
  EXPECT_EQ(bus->statistics(), expected);
}

}  // namespace
}  // namespace axisgate::test
