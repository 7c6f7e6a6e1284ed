// What is let in, what falls out, and how each order ends.
#include "tests/unit/bus/arbiter_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using ArbiterAdmission = ArbiterStage;

TEST_F(ArbiterAdmission, an_order_that_cannot_start_in_time_was_never_started) {
  Order late = command(0);
  late.start_by = now + 500ms;
  submit(command(0));
  const OrderId waiting = submit(late);
  ASSERT_TRUE(arbiter.next(now));
  EXPECT_EQ(arbiter.next_deadline(), now + 500ms);
  now += 500ms;
  EXPECT_THAT(endings(), ElementsAre(Arbiter::Ending{waiting, 0, Errc::never_started}));
}

TEST_F(ArbiterAdmission, an_order_whose_deadline_has_passed_is_not_granted) {
  Order late = command(0);
  late.start_by = now + 1ms;
  submit(late);
  now += 1ms;
  EXPECT_EQ(arbiter.next(now), std::nullopt);
}

TEST_F(ArbiterAdmission, a_started_order_has_no_start_deadline_any_more) {
  Order slow = command(0);
  slow.start_by = now + 1ms;
  const OrderId id = submit(slow);
  ASSERT_EQ(exchange(), id);
  now += 1s;
  EXPECT_THAT(endings(), IsEmpty());
  EXPECT_EQ(exchange(), id);
}

TEST_F(ArbiterAdmission, the_newest_setpoint_replaces_the_waiting_one) {
  const OrderId old = submit(setpoint(0));
  const OrderId fresh = submit(setpoint(0));
  EXPECT_THAT(endings(), ElementsAre(Arbiter::Ending{old, 0, Errc::superseded}));
  EXPECT_EQ(arbiter.statistics().superseded, 1u);
  EXPECT_EQ(serve(), fresh);
}

TEST_F(ArbiterAdmission, a_setpoint_on_the_wire_is_not_replaced) {
  const OrderId on_wire = submit(setpoint(0));
  ASSERT_EQ(arbiter.next(now)->id, on_wire);
  submit(setpoint(0));
  EXPECT_THAT(endings(), IsEmpty());
}

TEST_F(ArbiterAdmission, setpoints_of_other_objects_or_axes_are_not_replaced) {
  submit(setpoint(0, kTargetPosition));
  submit(setpoint(0, kTargetPosition, 1));
  submit(setpoint(1, kTargetPosition));
  submit(setpoint(0, kProfileVelocity));
  EXPECT_THAT(endings(), IsEmpty());
}

TEST_F(ArbiterAdmission, a_setpoint_is_not_replaced_across_another_command_of_its_axis) {
  const OrderId before = submit(setpoint(0));
  const OrderId start = submit(command(0));
  const OrderId after = submit(setpoint(0));
  EXPECT_THAT(endings(), IsEmpty());
  EXPECT_EQ(serve(), before);
  EXPECT_EQ(serve(), start);
  EXPECT_EQ(serve(), after);
}

TEST_F(ArbiterAdmission, a_setpoint_renewed_for_ever_keeps_its_place_in_the_queue) {
  submit(setpoint(0, kTargetPosition, 0));
  const OrderId of_other_axis = submit(command(0, 1));
  const OrderId renewed = submit(setpoint(0, kTargetPosition, 0));
  EXPECT_EQ(serve(), renewed);
  EXPECT_EQ(serve(), of_other_axis);
}

TEST_F(ArbiterAdmission, a_full_queue_still_takes_a_newer_setpoint) {
  for (std::size_t i = 1; i < bus::kMaxOrdersPerAxis; ++i) submit(command(0));
  submit(setpoint(0));
  EXPECT_EQ(arbiter.submit(command(0), now).code, Errc::queue_full);
  submit(setpoint(0));
}

TEST_F(ArbiterAdmission, a_read_joins_an_identical_waiting_one) {
  const OrderId first = submit(reading(0));
  const auto second = arbiter.submit(reading(0), now);
  EXPECT_TRUE(second.joined);
  EXPECT_EQ(second.id, first);
  EXPECT_EQ(arbiter.statistics().coalesced, 1u);
  EXPECT_EQ(arbiter.waiting(), 1u);
}

TEST_F(ArbiterAdmission, a_read_joins_none_on_the_wire) {
  submit(reading(0));
  ASSERT_TRUE(arbiter.next(now));
  EXPECT_FALSE(arbiter.submit(reading(0), now).joined);
}

TEST_F(ArbiterAdmission, a_read_joins_none_from_before_a_write_of_its_drive) {
  submit(reading(0));
  submit(command(0, 1));
  EXPECT_FALSE(arbiter.submit(reading(0), now).joined) << "the client that wrote must not read what was before";
}

TEST_F(ArbiterAdmission, a_read_joins_none_of_another_drive_or_object) {
  submit(reading(0));
  EXPECT_FALSE(arbiter.submit(reading(1), now).joined);
  EXPECT_FALSE(arbiter.submit(reading(0, kTargetPosition), now).joined);
}

TEST_F(ArbiterAdmission, a_read_joins_none_of_another_width) {
  submit(reading(0, kTargetPosition, 4));
  const OrderId narrow = submit(reading(0, kTargetPosition, 2));
  EXPECT_EQ(arbiter.submit(reading(0, kTargetPosition, 2), now).id, narrow) << "each joins its like";
}

TEST_F(ArbiterAdmission, a_joined_read_waits_as_long_as_the_one_that_waits_longest) {
  for (const bool hasty_first : {true, false}) {
    Order hasty = reading(0), patient = reading(0);
    hasty.start_by = now + 10ms;
    patient.start_by = now + 500ms;
    const OrderId id = submit(hasty_first ? hasty : patient);
    ASSERT_EQ(arbiter.submit(hasty_first ? patient : hasty, now).id, id);
    now += 499ms;
    EXPECT_THAT(endings(), IsEmpty()) << hasty_first;
    EXPECT_EQ(arbiter.waiting(), 1U) << hasty_first;
    now += 1ms;
    EXPECT_THAT(endings(), ElementsAre(Arbiter::Ending{id, 0, Errc::never_started})) << hasty_first;
  }
}

TEST_F(ArbiterAdmission, an_urgent_read_joins_none_that_is_less_urgent) {
  Order slow = setup(0);
  slow.read = {kStatusword, 2};
  submit(slow);
  Order urgent = slow;
  urgent.priority = Priority::interactive;
  submit(urgent);
  EXPECT_TRUE(arbiter.submit(slow, now).joined) << "but the other way round it gains";
}

TEST_F(ArbiterAdmission, a_read_that_outlives_a_stop_joins_none_that_does_not) {
  submit(reading(0));
  Order lasting = reading(0);
  lasting.survives_stop = true;
  submit(lasting);
}

TEST_F(ArbiterAdmission, the_bus_has_a_bound_for_stops_too) {
  for (std::size_t i = 0; i < bus::kMaxStopsPerBus; ++i) submit(stop(0, static_cast<bus::AxisSlot>(i % 32)));
  EXPECT_EQ(arbiter.submit(stop(1), now).code, Errc::queue_full);
}

TEST_F(ArbiterAdmission, an_ending_not_yet_taken_wants_attention_at_once) {
  submit(command(0));
  submit(stop(0));
  ASSERT_TRUE(arbiter.next(now));
  EXPECT_LE(arbiter.next_deadline(), now);
  EXPECT_THAT(endings(), testing::SizeIs(1));
  EXPECT_EQ(arbiter.next_deadline(), kNever);
}

TEST_F(ArbiterAdmission, the_ninth_command_of_an_axis_is_refused_and_the_other_axis_is_not) {
  for (std::size_t i = 0; i < bus::kMaxOrdersPerAxis; ++i) submit(command(0, 0));
  EXPECT_EQ(arbiter.submit(command(0, 0), now).code, Errc::queue_full);
  EXPECT_EQ(arbiter.statistics().refused, 1u);
  submit(command(0, 1));
  submit(command(1, 0));
}

TEST_F(ArbiterAdmission, the_bus_holds_64_orders_of_clients_and_still_takes_stops_and_setup) {
  for (std::size_t i = 0; i < bus::kMaxOrdersPerBus; ++i) submit(interactive(1));
  EXPECT_EQ(arbiter.submit(interactive(2), now).code, Errc::queue_full);
  EXPECT_EQ(arbiter.submit(command(2), now).code, Errc::queue_full);
  submit(stop(0));
  submit(setup(0));
}

TEST_F(ArbiterAdmission, stops_and_setup_have_bounds_of_their_own) {
  for (std::size_t i = 0; i < bus::kMaxStopsPerAxis; ++i) submit(stop(0));
  EXPECT_EQ(arbiter.submit(stop(0), now).code, Errc::queue_full);
  submit(stop(0, 1));
  for (std::size_t i = 0; i < bus::kMaxSetupsPerDrive; ++i) submit(setup(0));
  EXPECT_EQ(arbiter.submit(setup(0), now).code, Errc::queue_full);
}

TEST_F(ArbiterAdmission, a_stop_drops_what_waits_for_its_axis) {
  const OrderId move = submit(command(0));
  const OrderId mailbox = submit(interactive(0));
  const OrderId halt = submit(stop(0));
  EXPECT_THAT(endings(), ElementsAre(Arbiter::Ending{move, 0, Errc::dropped_by_stop},
                                     Arbiter::Ending{mailbox, 0, Errc::dropped_by_stop}));
  EXPECT_EQ(serve(), halt);
  EXPECT_EQ(serve(), std::nullopt);
}

TEST_F(ArbiterAdmission, a_stop_ends_the_command_under_way) {
  const OrderId move = submit(command(0));
  ASSERT_EQ(exchange(), move);
  const OrderId halt = submit(stop(0));
  EXPECT_THAT(endings(), ElementsAre(Arbiter::Ending{move, 0, Errc::dropped_by_stop}));
  EXPECT_EQ(serve(), halt);
}

TEST_F(ArbiterAdmission, a_stop_leaves_parameters_other_axes_other_stops_and_setup_alone) {
  Order parameters = command(0);
  parameters.survives_stop = true;
  submit(parameters);
  submit(command(0, 1));
  submit(command(1));
  submit(stop(0));
  submit(setup(0));
  submit(stop(0));
  EXPECT_THAT(endings(), IsEmpty());
}

TEST_F(ArbiterAdmission, a_stop_of_the_whole_drive_drops_what_waits_for_any_of_its_axes) {
  const OrderId first = submit(command(0, 0));
  const OrderId second = submit(command(0, 1));
  submit(stop(0, bus::kNoAxis));
  EXPECT_THAT(endings(), ElementsAre(Arbiter::Ending{first, 0, Errc::dropped_by_stop},
                                     Arbiter::Ending{second, 0, Errc::dropped_by_stop}));
}

TEST_F(ArbiterAdmission, a_stop_that_finds_no_room_still_drops_what_waits) {
  for (std::size_t i = 0; i < bus::kMaxStopsPerAxis; ++i) submit(stop(0));
  const OrderId move = submit(command(0));
  EXPECT_EQ(arbiter.submit(stop(0), now).code, Errc::queue_full);
  EXPECT_THAT(endings(), ElementsAre(Arbiter::Ending{move, 0, Errc::dropped_by_stop}));
}

TEST_F(ArbiterAdmission, a_drive_that_went_offline_takes_its_orders_along) {
  const OrderId started = submit(command(0, 0));
  ASSERT_EQ(exchange(), started);
  const OrderId waiting = submit(command(0, 1));
  const OrderId of_other = submit(command(1));
  arbiter.end_drive(0, Errc::offline, Errc::link_lost);
  EXPECT_THAT(endings(),
              ElementsAre(Arbiter::Ending{started, 0, Errc::link_lost}, Arbiter::Ending{waiting, 0, Errc::offline}));
  EXPECT_EQ(serve(), of_other);
}

TEST_F(ArbiterAdmission, a_lost_link_ends_everything_and_frees_the_wire) {
  const OrderId started = submit(command(0));
  ASSERT_TRUE(arbiter.next(now));
  const OrderId waiting = submit(stop(1));
  arbiter.end_all(Errc::offline, Errc::link_lost);
  EXPECT_FALSE(arbiter.wire_busy());
  EXPECT_THAT(endings(),
              ElementsAre(Arbiter::Ending{started, 0, Errc::link_lost}, Arbiter::Ending{waiting, 1, Errc::offline}));
  EXPECT_EQ(arbiter.waiting(), 0u);
}

TEST_F(ArbiterAdmission, an_order_finished_by_its_owner_is_not_ended_a_second_time) {
  const OrderId move = submit(command(0));
  ASSERT_EQ(exchange(), move);
  submit(stop(0));
  arbiter.finish(move);
  EXPECT_THAT(endings(), IsEmpty());
  arbiter.finish(move);
  arbiter.finish(4711);
  arbiter.wait(4711, now);
}

TEST_F(ArbiterAdmission, only_orders_not_yet_started_count_as_waiting) {
  const OrderId id = submit(command(0));
  submit(command(1));
  EXPECT_EQ(arbiter.waiting(), 2u);
  ASSERT_EQ(exchange(), id);
  EXPECT_EQ(arbiter.waiting(), 1u);
}

}  // namespace
}  // namespace axisgate::test
