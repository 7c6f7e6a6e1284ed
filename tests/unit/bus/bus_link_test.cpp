// SPDX-License-Identifier: Apache-2.0
// The link comes and goes, in each state of the bus (design 8, P7).
#include "tests/unit/bus/bus_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

using BusLink = BusStage;

TEST_F(BusLink, takes_no_job_before_it_is_up_and_then_serves_the_poll_that_was_due) {
  EXPECT_FALSE(bus->up());
  EXPECT_EQ(bus->submit(BusJob{}).code, Errc::offline);
  bus->set_poll_due(0, runtime.now());
  turn();
  EXPECT_THAT(wire->sent, IsEmpty());
  wire->up();
  EXPECT_TRUE(bus->up());
  EXPECT_THAT(wire->sent, SizeIs(1));
}

TEST_F(BusLink, tells_every_drive_and_the_log_that_it_is_up_and_that_it_is_lost) {
  wire->up();
  EXPECT_THAT(diary, ElementsAre("drive 1: link up", "drive 2: link up"));
  EXPECT_THAT(log_lines, ElementsAre("info bus lift: link up"));
  link_up();
  wire->down("/dev/ttyUSB0: hung up");
  EXPECT_FALSE(bus->up());
  EXPECT_THAT(diary, ElementsAre("drive 1: link down", "drive 2: link down"));
  EXPECT_THAT(log_lines, ElementsAre("warning bus lift: link down: /dev/ttyUSB0: hung up"));
}

TEST_F(BusLink, lost_with_an_exchange_on_the_wire_it_ends_everything_in_the_same_turn) {
  link_up();
  submit(0);
  submit(0);
  submit(1);
  turn();
  diary.clear();
  wire->down("gone");
  EXPECT_THAT(diary, ElementsAre("drive 1: link lost", "drive 1: job 1 link lost", "drive 1: job 2 offline",
                                 "drive 2: job 3 offline", "drive 1: link down", "drive 2: link down"));
  EXPECT_EQ(bus->queue_depth(), 0u);
  EXPECT_EQ(runtime.next_deadline(), kNever) << "nothing is left to wait for";
}

TEST_F(BusLink, lost_between_two_exchanges_of_a_bus_job_or_while_it_waits_for_a_condition_its_outcome_is_unknown) {
  for (const bool waits : {false, true}) {
    link_up();
    const JobId id = submit(0);
    turn();
    wire->reply();
    if (waits) bus->wait(id, runtime.now() + 1h);
    turn();
    diary.clear();
    wire->down("gone");
    EXPECT_THAT(diary,
                ElementsAre(fmt::format("drive 1: job {} link lost", id), "drive 1: link down", "drive 2: link down"));
  }
}

TEST_F(BusLink, lost_from_inside_send_the_exchange_ends_in_the_same_turn_and_a_return_is_told_as_well) {
  for (const bool returns : {false, true}) {
    link_up();
    wire->on_send = [this, returns] {
      wire->on_send = nullptr;
      wire->down("gone");
      if (returns) wire->up();
    };
    const JobId id = submit(0);
    turn();
    Diary expected{fmt::format("drive 1: grant {}", id), "drive 1: link lost",
                   fmt::format("drive 1: job {} link lost", id), "drive 1: link down", "drive 2: link down"};
    if (returns) expected.insert(expected.end(), {"drive 1: link up", "drive 2: link up"});
    EXPECT_EQ(diary, expected);
    EXPECT_EQ(bus->up(), returns);
  }
}

TEST_F(BusLink, a_drive_may_ask_for_more_while_the_link_is_going_down) {
  link_up();
  std::vector<Errc> answers;
  const auto ask = [&] { answers.push_back(bus->submit(BusJob{}).code); };
  drives[0].result_hook = [&](const ExchangeResult&) { ask(); };
  drives[0].ended_hook = [&](JobId id, Errc) {
    bus->finish(id);
    ask();
  };
  drives[0].link_hook = [&](bool) { ask(); };
  submit(0);
  turn();
  wire->down("gone");
  EXPECT_THAT(answers, ElementsAre(Errc::offline, Errc::offline, Errc::offline));
}

TEST_F(BusLink, works_as_before_when_it_is_back_and_the_silence_after_an_exchange_does_not_outlive_it) {
  link_up();
  submit(0);
  turn();
  runtime.advance_by(kTimeout);
  wire->down("gone");
  wire->up();
  diary.clear();
  submit(1);
  turn();
  wire->reply();
  EXPECT_THAT(diary, ElementsAre("drive 2: grant 2", "drive 2: ok"));
}

TEST_F(BusLink, a_bus_destroyed_with_an_exchange_on_the_wire_calls_nobody) {
  link_up();
  submit(0);
  turn();
  diary.clear();
  bus.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(diary, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
