// SPDX-License-Identifier: Apache-2.0
// What the gateway says of its axes, as a Fast DDS subscriber receives it.
#include <gmock/gmock.h>
#include <time.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "tests/dds_process/child.hpp"
#include "tests/dds_process/peer.hpp"

namespace axisgate::dds::test {
namespace {

constexpr ReaderSettings kLastState{.transient_local = true};
const double kNone = std::nan("");

std::int64_t now_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::int64_t ns(const Time& time) { return std::int64_t{time.sec()} * 1'000'000'000 + time.nanosec(); }

StateRecord state_of(std::uint16_t axis, std::uint32_t sequence) {
  return {.axis = axis,
          .name = "lift " + std::to_string(axis),
          .at = now_ns(CLOCK_MONOTONIC),
          .sequence = sequence,
          .statusword = 0x1637,
          .mode = -3,
          .position = 12.5 * axis,
          .velocity = -0.25,
          .torque = 33.0,
          .current = 1.75,
          .following_error = kNone,
          .error_code = 0x8130,
          .vendor_error = 0xDEADBEEF,
          .inputs = 0x8001,
          .outputs = 0x0010,
          .drive_temperature = 41.5,
          .motor_temperature = kNone,
          .voltage = 48.1,
          .axis_state = 2,
          .motion_state = 1,
          .motion_id = 65535,
          .alarms = 0x80000001,
          .link_state = 2,
          .supported = 0xFFFFFFFF,
          .valid = 0x7FFFFFFF};
}

TEST(PublishedState, HasTheValuesOfTheRecord) {
  Child child;
  Peer peer;
  auto states = peer.reader<AxisState>("axisgate/axis_state", kLastState);
  const StateRecord sent = state_of(7, 4'000'000'000);
  child.send(sent);

  const std::optional<AxisState> got = states->next();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->axis(), sent.axis);
  EXPECT_EQ(got->name().to_string(), "lift 7");
  EXPECT_EQ(got->sequence_number(), sent.sequence);
  EXPECT_EQ(got->statusword(), sent.statusword);
  EXPECT_EQ(got->mode(), sent.mode);
  EXPECT_EQ(got->position(), sent.position);
  EXPECT_EQ(got->velocity(), sent.velocity);
  EXPECT_EQ(got->torque(), sent.torque);
  EXPECT_EQ(got->current(), sent.current);
  EXPECT_TRUE(std::isnan(got->following_error()));
  EXPECT_EQ(got->error_code(), sent.error_code);
  EXPECT_EQ(got->vendor_error(), sent.vendor_error);
  EXPECT_EQ(got->inputs(), sent.inputs);
  EXPECT_EQ(got->outputs(), sent.outputs);
  EXPECT_EQ(got->drive_temperature(), sent.drive_temperature);
  EXPECT_TRUE(std::isnan(got->motor_temperature()));
  EXPECT_EQ(got->voltage(), sent.voltage);
  EXPECT_EQ(got->axis_state(), sent.axis_state);
  EXPECT_EQ(got->motion_state(), sent.motion_state);
  EXPECT_EQ(got->motion_id(), sent.motion_id);
  EXPECT_EQ(got->alarms(), sent.alarms);
  EXPECT_EQ(got->link_state(), sent.link_state);
  EXPECT_EQ(got->supported(), sent.supported);
  EXPECT_EQ(got->valid(), sent.valid);
}

TEST(PublishedState, IsStampedWithTheTimeOfDayAtWhichItsValueWasReceived) {
  Child child;
  Peer peer;
  auto states = peer.reader<AxisState>("axisgate/axis_state", kLastState);
  StateRecord sent = state_of(1, 1);
  constexpr std::int64_t kAge = 5'000'000'000;
  sent.at -= kAge;
  const std::int64_t before = now_ns(CLOCK_REALTIME);
  child.send(sent);
  const std::optional<AxisState> got = states->next();
  ASSERT_TRUE(got);
  constexpr std::int64_t kClocksReadApart = 1'000'000'000;
  EXPECT_NEAR(static_cast<double>(ns(got->stamp()) - (before - kAge)), 0, kClocksReadApart);
}

TEST(PublishedState, OfAValueThatWasNeverReceivedHasNoStamp) {
  Child child;
  Peer peer;
  auto states = peer.reader<AxisState>("axisgate/axis_state", kLastState);
  StateRecord sent = state_of(1, 1);
  sent.at = 0;
  child.send(sent);
  const std::optional<AxisState> got = states->next();
  ASSERT_TRUE(got);
  EXPECT_EQ(ns(got->stamp()), 0);
}

TEST(PublishedState, LastOneOfEachAxisReachesALateJoiner) {
  constexpr std::uint16_t kAxes = 64;
  Child child;
  for (std::uint32_t sequence = 1; sequence <= 3; ++sequence) {
    for (std::uint16_t axis = 1; axis <= kAxes; ++axis) child.send(state_of(axis, sequence));
  }
  Peer peer;
  auto early = peer.reader<AxisState>("axisgate/axis_state", {.transient_local = true, .depth = 0});
  for (std::optional<AxisState> got; !got || got->axis() != kAxes || got->sequence_number() != 3;) {
    got = early->next();
    ASSERT_TRUE(got);
  }
  auto states = peer.reader<AxisState>("axisgate/axis_state", kLastState);
  std::map<std::uint16_t, std::uint32_t> newest;
  while (newest.size() < kAxes) {
    const std::optional<AxisState> got = states->next();
    ASSERT_TRUE(got) << newest.size();
    EXPECT_EQ(got->sequence_number(), 3U);
    newest[got->axis()] = got->sequence_number();
  }
}

TEST(PublishedState, Of64AxesAHundredTimesASecondArrivesWithoutGaps) {
  constexpr std::uint16_t kAxes = 64;
  constexpr std::uint32_t kRounds = 100;
  Child child;
  Peer peer;
  auto states = peer.reader<AxisState>("axisgate/axis_state", {.transient_local = true, .depth = 0});
  // The reader is there when it has the first state of all.
  for (std::uint16_t axis = 1; axis <= kAxes; ++axis) child.send(state_of(axis, 0));
  for (std::uint16_t axis = 1; axis <= kAxes; ++axis) ASSERT_TRUE(states->next());

  std::map<std::uint16_t, std::uint32_t> newest;
  std::uint32_t received = 0;
  for (std::uint32_t round = 1; round <= kRounds; ++round) {
    for (std::uint16_t axis = 1; axis <= kAxes; ++axis) child.send(state_of(axis, round));
    // Each round is awaited, so that keep last 1 has nothing to drop however slow this machine is.
    for (std::uint16_t axis = 1; axis <= kAxes; ++axis, ++received) {
      const std::optional<AxisState> got = states->next();
      ASSERT_TRUE(got) << received;
      EXPECT_EQ(got->sequence_number(), newest[got->axis()] + 1) << "axis " << got->axis();
      newest[got->axis()] = got->sequence_number();
    }
  }
  EXPECT_EQ(received, kRounds * kAxes);
}

TEST(PublishedEvents, LastSixteenOfEachAxisReachALateJoiner) {
  Child child;
  for (std::uint64_t number = 1; number <= 20; ++number) {
    child.send(EventRecord{
        .axis = 3, .at = now_ns(CLOCK_MONOTONIC), .number = number, .kind = 2, .code = 0x8130, .text = "lost"});
  }
  child.send(EventRecord{.axis = 0, .at = now_ns(CLOCK_MONOTONIC), .number = 21, .kind = 5, .code = 0, .text = "up"});
  Peer peer;
  auto early = peer.reader<AxisEvent>("axisgate/axis_event", {.transient_local = true, .depth = 0});
  for (std::optional<AxisEvent> got; !got || got->number() != 21;) {
    got = early->next();
    ASSERT_TRUE(got);
  }
  auto events = peer.reader<AxisEvent>("axisgate/axis_event", {.transient_local = true, .depth = 16});
  std::vector<std::uint64_t> numbers;
  std::uint64_t of_gateway = 0;
  for (int i = 0; i < 17; ++i) {
    const std::optional<AxisEvent> got = events->next();
    ASSERT_TRUE(got) << i;
    if (got->axis() == 0) {
      EXPECT_EQ(got->text().to_string(), "up");
      of_gateway = got->number();
      continue;
    }
    EXPECT_EQ(got->kind(), 2);
    EXPECT_EQ(got->code(), 0x8130U);
    EXPECT_EQ(got->text().to_string(), "lost");
    numbers.push_back(got->number());
  }
  EXPECT_EQ(of_gateway, 21U);
  EXPECT_THAT(numbers, testing::ElementsAre(5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20));
}

TEST(PublishedGateway, HasItsBusesAndReachesALateJoiner) {
  Child child;
  GatewayRecord sent{
      .state = 1, .axis_count = 3, .axes_online = 2, .uptime_s = 77, .alarms = 0x81, .events_lost = 4, .buses = {}};
  sent.buses.push_back({.name = "lift-serial",
                        .link = 1,
                        .load_permille = 375,
                        .cycle_ms = 12,
                        .queue_depth = 3,
                        .counters = {10, 9, 8, 7, 6, 5, 4, 3, 2, 1}});
  sent.buses.push_back({.name = "can0"});
  child.send(sent);
  Peer peer;
  auto reader = peer.reader<GatewayState>("axisgate/gateway_state", kLastState);
  const std::optional<GatewayState> got = reader->next();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->state(), 1);
  EXPECT_EQ(got->axis_count(), 3);
  EXPECT_EQ(got->axes_online(), 2);
  EXPECT_EQ(got->uptime_s(), 77U);
  EXPECT_EQ(got->alarms(), 0x81);
  EXPECT_EQ(got->events_lost(), 4U);
  ASSERT_EQ(got->buses().size(), 2U);
  const BusState& bus = got->buses()[0];
  EXPECT_EQ(bus.name().to_string(), "lift-serial");
  EXPECT_EQ(bus.link(), 1);
  EXPECT_DOUBLE_EQ(bus.load(), 0.375);
  EXPECT_EQ(bus.cycle_ms(), 12);
  EXPECT_EQ(bus.queue_depth(), 3);
  EXPECT_THAT((std::array{bus.requests(), bus.replies(), bus.timeouts(), bus.bad_frames(), bus.late_replies(),
                          bus.dropped_bytes(), bus.refused(), bus.coalesced(), bus.superseded(), bus.reconnects()}),
              testing::ElementsAre(10, 9, 8, 7, 6, 5, 4, 3, 2, 1));
  EXPECT_EQ(got->buses()[1].name().to_string(), "can0");
}

TEST(PublishedReplies, AreWrittenForAnyAxisNumber) {
  constexpr std::uint16_t kMoreThanAGatewayHas = 600;
  Child child({"--commands"});
  Peer peer;
  auto replies = peer.reader<CommandReply>("axisgate/command_reply", {.depth = 0});
  // Volatile: it is sent again until the two know each other.
  for (std::uint64_t id = 0; !replies->next_within(std::chrono::milliseconds(100)); ++id) {
    ASSERT_LT(id, 300U);
    child.send(ReplyRecord{.axis = 0, .request_id = id});
  }
  for (std::uint16_t axis = 1; axis <= kMoreThanAGatewayHas; ++axis) {
    child.send(ReplyRecord{.axis = axis});
    std::optional<CommandReply> reply;
    do {
      reply = replies->next();
      ASSERT_TRUE(reply) << "axis " << axis;
    } while (reply->axis() != axis);
  }
}

TEST(PublishedJoints, AreAllAxesInOneMessageOnceAPeriod) {
  Child child({"--ros2", "--min-period-ms=200"});
  Peer peer;
  auto joints = peer.reader<sensor_msgs::msg::dds_::JointState_>("rt/joint_states", {.depth = 100});
  StateRecord second = state_of(2, 1);
  second.velocity = kNone;
  StateRecord lost = state_of(3, 1);  // its last values stand in it, and none of them is valid
  lost.valid = 0;
  child.send(state_of(1, 1));
  child.send(second);
  child.send(lost);
  child.send(GatewayRecord{});
  // Volatile, as ROS 2 has it: it is sent again until the reader is there.
  const auto begun = std::chrono::steady_clock::now();
  int got = 0;
  for (std::uint32_t sequence = 2; got < 5; ++sequence) {
    ASSERT_LT(sequence, 10'000U);
    child.send(state_of(1, sequence));
    child.send(second);
    const auto message = joints->next_within(std::chrono::milliseconds(10));
    if (!message) continue;
    ++got;
    EXPECT_THAT(message->name(), testing::ElementsAre("lift 1", "lift 2", "lift 3"));
    EXPECT_THAT(message->position(), testing::ElementsAre(12.5, 25.0, testing::IsNan()));
    EXPECT_THAT(message->velocity(), testing::ElementsAre(-0.25, testing::IsNan(), testing::IsNan()));
    EXPECT_THAT(message->effort(), testing::IsEmpty());
    EXPECT_EQ(message->header().frame_id(), "");
    EXPECT_GT(message->header().stamp().sec(), 0);
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(600));
}

}  // namespace
}  // namespace axisgate::dds::test
