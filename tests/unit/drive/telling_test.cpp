// SPDX-License-Identifier: Apache-2.0
// Which requests are told: each command, a stream when it begins, and never more than the bounds.
#include "gateway/drive/axis/telling.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

WriteBatch command_of(ClientId client, Command command) {
  WriteBatch batch;
  batch.client = client;
  batch.command = command;
  return batch;
}

WriteBatch value_of(ClientId client, Quantity quantity, std::int64_t value = 0) {
  WriteBatch batch;
  batch.client = client;
  batch.setpoints.push_back({quantity, value});
  return batch;
}

class TellingTest : public testing::Test {
 protected:
  [[nodiscard]] bool told(const WriteBatch& batch) { return telling_.asked(batch, now_).has_value(); }
  Telling telling_;
  Instant now_ = Instant{} + 1h;
};

TEST_F(TellingTest, EachCommandIsToldAlsoTheSameOne) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(told(command_of(1, Command::move_absolute)));
    EXPECT_TRUE(told(command_of(1, Command::quick_stop)));
  }
}

TEST_F(TellingTest, AStreamIsToldWhenItBeginsAndOnceAMinute) {
  std::uint64_t lines = 0, counted = 0;
  for (int i = 0; i < 180'000; ++i, now_ += 1ms)
    if (const auto left_out = telling_.asked(value_of(1, Quantity::target_velocity, i), now_)) {
      ++lines;
      counted += *left_out + 1;
    }
  EXPECT_EQ(lines, 3U);
  EXPECT_EQ(counted, 120'001U) << "each is in a line, or will be in the next one";
  now_ += kStreamPause;
  EXPECT_TRUE(told(value_of(1, Quantity::target_velocity))) << "a new one";
}

TEST_F(TellingTest, AnotherClientAndAnotherValueAreOtherStreams) {
  for (int i = 0; i < 100; ++i) {
    const bool first = i == 0;
    EXPECT_EQ(told(value_of(1, Quantity::target_velocity)), first);
    EXPECT_EQ(told(value_of(2, Quantity::target_velocity)), first);
    EXPECT_EQ(told(value_of(1, Quantity::target_torque)), first);
    WriteBatch run = value_of(1, Quantity::target_velocity);
    run.command = Command::run_velocity;
    EXPECT_EQ(told(run), first) << "a DDS writer commands with each sample";
    now_ += 10ms;
  }
}

TEST_F(TellingTest, WhatIsRefusedInALoopIsToldOnceAMinute) {
  std::uint64_t lines = 0;
  for (int i = 0; i < 100; ++i, now_ += 5s)
    lines += telling_.refused(command_of(2, Command::enable), Errc::not_owner, now_).has_value();
  EXPECT_EQ(lines, 9U) << "500 s";
  EXPECT_TRUE(telling_.refused(command_of(2, Command::enable), Errc::state_unsuitable, now_).has_value());
}

TEST_F(TellingTest, AFloodOfOneKindHidesNoOther) {
  std::int64_t lines = 0;
  for (int i = 0; i < 10'000; ++i, now_ += 1ms) lines += told(command_of(1, Command::move_relative));
  EXPECT_LE(lines, LineBucket::kBurst + 10s / LineBucket::kEach);
  EXPECT_TRUE(told(command_of(1, Command::disable)));
  EXPECT_TRUE(told(value_of(1, Quantity::target_position)));
  EXPECT_TRUE(telling_.refused(command_of(2, Command::enable), Errc::not_owner, now_).has_value());
  now_ += LineBucket::kEach;
  const auto next = telling_.asked(command_of(1, Command::move_relative), now_);
  ASSERT_TRUE(next.has_value());
  EXPECT_GT(*next, 0U);
}

TEST_F(TellingTest, ManyStreamsMakeWayForOneAnotherWithinTheBucket) {
  std::int64_t lines = 0;
  for (int i = 0; i < 10'000; ++i, now_ += 1ms)
    lines += told(value_of(static_cast<ClientId>(i % 20 + 1), Quantity::target_velocity));
  EXPECT_GE(lines, 20);
  EXPECT_LE(lines, LineBucket::kBurst + 10s / LineBucket::kEach + 1);
}

}  // namespace
}  // namespace axisgate::drive
