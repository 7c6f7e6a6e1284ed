// SPDX-License-Identifier: Apache-2.0
// What is let in, what falls out, and how each bus job ends. Every rule is also asked of random operations in
// arbiter_property_test.cpp, but for those of what may join and of what is refused: these are told here in full.
#include "tests/unit/bus/arbiter_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
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

TEST_F(ArbiterAdmission,
       a_setpoint_does_not_replace_one_on_the_wire_of_another_object_or_axis_or_behind_another_command) {
  submit(setpoint(0));
  ASSERT_TRUE(arbiter.next(now));
  for (const BusJob& o : {setpoint(0), setpoint(0, kTargetPosition, 1), setpoint(1), setpoint(0, kProfileVelocity),
                          setpoint(0), command(0), setpoint(0)}) {
    submit(o);
    EXPECT_THAT(endings(), IsEmpty());
  }
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

TEST_F(ArbiterAdmission, a_read_joins_none_on_the_wire_of_another_drive_or_object_or_from_before_a_write_of_its_drive) {
  submit(reading(0));
  ASSERT_TRUE(arbiter.next(now));
  for (const BusJob& o : {reading(0), reading(1), reading(0, kTargetPosition), command(0, 1)}) submit(o);
  submit(reading(0));  // the client that wrote must not read what was before
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

TEST_F(ArbiterAdmission, a_joined_read_waits_as_long_as_the_one_that_waits_longest) {
  for (const bool hasty_first : {true, false}) {
    BusJob hasty = reading(0), patient = reading(0);
    hasty.start_by = now + 10ms;
    patient.start_by = now + 500ms;
    const JobId id = submit(hasty_first ? hasty : patient);
    ASSERT_EQ(arbiter.submit(hasty_first ? patient : hasty, now).id, id);
    now += 499ms;
    EXPECT_THAT(endings(), IsEmpty()) << hasty_first;
    now += 1ms;
    EXPECT_THAT(endings(), ElementsAre(Ending{id, 0, Errc::never_started})) << hasty_first;
  }
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
    submit(stop(2, static_cast<bus::AxisSlot>(i % 32)));
  }
  expect_refused(stop(1));
}

TEST_F(ArbiterAdmission, a_stop_drops_what_waits_for_its_axis_and_the_command_under_way) {
  const JobId under_way = submit(command(0));
  ASSERT_EQ(exchange(), under_way);
  const JobId move = submit(command(0));
  const JobId mailbox = submit(interactive(0));
  const JobId halt = submit(stop(0));
  EXPECT_THAT(endings(),
              ElementsAre(Ending{under_way, 0, Errc::dropped_by_stop}, Ending{move, 0, Errc::dropped_by_stop},
                          Ending{mailbox, 0, Errc::dropped_by_stop}));
  EXPECT_EQ(serve(), halt);
  EXPECT_EQ(serve(), std::nullopt);
}

TEST_F(ArbiterAdmission, a_stop_leaves_parameters_other_axes_other_stops_and_setup_alone_one_of_the_drive_no_axis) {
  BusJob parameters = command(0);
  parameters.survives_stop = true;
  submit(parameters);
  submit(command(1));
  submit(stop(0));
  submit(setup(0));
  const JobId of_other_axis = submit(command(0, 1));
  submit(stop(0));
  EXPECT_THAT(endings(), IsEmpty());
  submit(stop(0, bus::kNoAxis));
  EXPECT_THAT(endings(), ElementsAre(Ending{of_other_axis, 0, Errc::dropped_by_stop}));
}

TEST_F(ArbiterAdmission, a_drive_that_went_offline_takes_its_jobs_along_and_a_lost_link_all_and_the_wire) {
  const JobId started = submit(command(0, 0));
  ASSERT_EQ(exchange(), started);
  EXPECT_EQ(arbiter.waiting(), 0u) << "one that has started does not wait";
  const JobId waiting = submit(command(0, 1));
  const JobId of_other = submit(command(1));
  const JobId last = submit(stop(2));
  arbiter.end_drive(0, Errc::offline, Errc::link_lost);
  EXPECT_THAT(endings(), ElementsAre(Ending{started, 0, Errc::link_lost}, Ending{waiting, 0, Errc::offline}));
  EXPECT_EQ(arbiter.waiting(), 2u);
  ASSERT_EQ(arbiter.next(now)->id, last);
  arbiter.end_all(Errc::offline, Errc::link_lost);
  EXPECT_FALSE(arbiter.wire_busy());
  EXPECT_THAT(endings(), ElementsAre(Ending{of_other, 1, Errc::offline}, Ending{last, 2, Errc::link_lost}));
  EXPECT_EQ(arbiter.waiting(), 0u);
}

TEST_F(ArbiterAdmission, an_ending_wants_attention_at_once_and_none_comes_of_a_bus_job_that_its_owner_finished) {
  const JobId move = submit(command(0));
  submit(stop(0));
  ASSERT_TRUE(arbiter.next(now));
  EXPECT_LE(arbiter.next_deadline(), now);
  arbiter.finish(move);
  EXPECT_THAT(endings(), IsEmpty());
  EXPECT_EQ(arbiter.next_deadline(), kNever);
  arbiter.finish(move);
  arbiter.finish(4711);
  arbiter.wait(4711, now);
}

}  // namespace
}  // namespace axisgate::test
