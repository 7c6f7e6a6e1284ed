// SPDX-License-Identifier: Apache-2.0
// What is let in, what falls out, and how each bus job ends. Every rule is also asked of random operations in
// arbiter_property_test.cpp, but for those of what may join and of what is refused: these are told here in full.
#include "tests/unit/bus/arbiter_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using Ending = Arbiter::Ending;

using ArbiterAdmission = ArbiterStage;

TEST_F(ArbiterAdmission, a_bus_job_that_cannot_start_in_time_was_never_started_and_one_that_has_started_may_take_long) {
  BusJob hasty = command(0);
  hasty.start_by = now + 500ms;
  const JobId started = submit(hasty);
  ASSERT_EQ(exchange(), started);
  const JobId waiting = submit(hasty);
  ASSERT_EQ(exchange(), started);
  ASSERT_TRUE(arbiter.next(now));
  EXPECT_EQ(arbiter.next_deadline(), now + 500ms);
  now += 500ms;
  EXPECT_THAT(endings(), ElementsAre(Ending{waiting, 0, Errc::never_started}));
  arbiter.exchange_over(now);
  EXPECT_EQ(serve(), started);
  submit(hasty);
  EXPECT_EQ(arbiter.next(now), std::nullopt) << "nor granted";
}

TEST_F(ArbiterAdmission, the_newest_setpoint_replaces_the_waiting_one_and_takes_its_place_in_the_queue) {
  const JobId old = submit(setpoint(0));
  const JobId of_other_axis = submit(command(0, 1));
  const JobId fresh = submit(setpoint(0));
  EXPECT_THAT(endings(), ElementsAre(Ending{old, 0, Errc::superseded}));
  EXPECT_EQ(arbiter.statistics().superseded, 1u);
  EXPECT_EQ(serve(), fresh);
  EXPECT_EQ(serve(), of_other_axis);
}

TEST_F(ArbiterAdmission, a_read_joins_an_identical_waiting_one) {
  const JobId first = submit(reading(0));
  submit(reading(0, kTargetPosition, 4));
  const JobId narrow = submit(reading(0, kTargetPosition, 2));
  EXPECT_TRUE(arbiter.submit(reading(0), now).joined);
  EXPECT_EQ(arbiter.submit(reading(0), now).id, first);
  EXPECT_EQ(arbiter.submit(reading(0, kTargetPosition, 2), now).id, narrow) << "each joins its like";
  EXPECT_EQ(arbiter.statistics().coalesced, 3u);
  EXPECT_EQ(arbiter.waiting(), 3u);
}

TEST_F(ArbiterAdmission, a_read_that_is_more_urgent_or_outlives_a_stop_joins_none_that_is_not_or_does_not) {
  BusJob slow = setup(0);
  slow.read = {kStatusword, 2};
  submit(slow);
  BusJob urgent = slow;
  urgent.priority = Priority::interactive;
  submit(urgent);
  EXPECT_TRUE(arbiter.submit(slow, now).joined) << "but the other way round it gains";
  submit(reading(1));
  BusJob lasting = reading(1);
  lasting.survives_stop = true;
  submit(lasting);
}

TEST_F(ArbiterAdmission, the_ninth_command_of_an_axis_is_refused_but_a_newer_setpoint_and_those_of_others_are_not) {
  for (std::size_t i = 1; i < bus::kMaxJobsPerAxis; ++i) submit(command(0));
  submit(setpoint(0));
  expect_refused(command(0));
  EXPECT_EQ(arbiter.statistics().refused, 1u);
  submit(setpoint(0));
  submit(command(0, 1));
  submit(command(1, 0));
}

TEST_F(ArbiterAdmission, the_bus_takes_64_jobs_of_clients_and_then_still_stops_and_setup) {
  for (std::size_t i = 0; i < bus::kMaxJobsPerBus; ++i) submit(interactive(1));
  expect_refused(interactive(2));
  expect_refused(command(2));
  submit(stop(0));
  submit(setup(0));
}

TEST_F(ArbiterAdmission, stops_and_setup_have_bounds_of_their_own) {
  for (std::size_t i = 0; i < bus::kMaxStopsPerAxis; ++i) submit(stop(0));
  const JobId move = submit(command(0));
  expect_refused(stop(0));
  EXPECT_THAT(endings(), ElementsAre(Ending{move, 0, Errc::dropped_by_stop}))
      << "a stop without room drops all the same";
  submit(stop(0, 1));
  for (std::size_t i = 0; i < bus::kMaxSetupsPerDrive; ++i) submit(setup(0));
  expect_refused(setup(0));
  for (std::size_t i = bus::kMaxStopsPerAxis + 1; i < bus::kMaxStopsPerBus; ++i) {
    submit(stop(2, static_cast<AxisSlot>(i % 32)));
  }
  expect_refused(stop(1));
}

}  // namespace
}  // namespace axisgate::test
