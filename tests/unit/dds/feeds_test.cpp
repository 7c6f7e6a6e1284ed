// SPDX-License-Identifier: Apache-2.0
// Which axis is due when, and which events are still to be told.
#include <gmock/gmock.h>

#include "gateway/upstream/feed/axis_feed.hpp"
#include "gateway/upstream/feed/event_feed.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::feed {
namespace {

using namespace std::chrono_literals;
using test::kStart;
using testing::ElementsAre;
using testing::IsEmpty;

struct Fed : testing::Test {
  AxisFeed feed{10ms, 1000ms};
  void add(std::initializer_list<AxisNumber> axes) {
    for (const AxisNumber axis : axes) feed.add(axis, kStart);
  }
  std::vector<AxisNumber> sent(Duration after) {
    std::vector<AxisNumber> out;
    while (const auto axis = feed.next(kStart + after)) out.push_back(*axis);
    return out;
  }
  void changed(AxisNumber axis, Duration after) { feed.changed(axis, kStart + after); }
};

TEST_F(Fed, AllAxesAreDueAtFirstInTheirOrder) {
  add({1, 2, 499});
  EXPECT_THAT(sent(0ms), ElementsAre(1, 2, 499));
  EXPECT_THAT(sent(0ms), IsEmpty());
}

TEST_F(Fed, AChangeGoesOutAtOnceAndTheNextNotBeforeTheShortestPeriod) {
  add({1});
  EXPECT_THAT(sent(0ms), ElementsAre(1));
  changed(1, 50ms);
  EXPECT_EQ(feed.due(), kStart + 50ms);
  EXPECT_THAT(sent(50ms), ElementsAre(1));
  changed(1, 53ms);
  changed(1, 55ms);
  EXPECT_EQ(feed.due(), kStart + 60ms);
  EXPECT_THAT(sent(59ms), IsEmpty());
  EXPECT_THAT(sent(60ms), ElementsAre(1)) << "once for both";
  EXPECT_EQ(feed.due(), kStart + 1060ms);
}

TEST_F(Fed, AnAxisThatNeverChangesIsToldOnceEachLongestPeriod) {
  add({1});
  EXPECT_THAT(sent(0ms), ElementsAre(1));
  EXPECT_THAT(sent(999ms), IsEmpty());
  EXPECT_THAT(sent(1000ms), ElementsAre(1));
  EXPECT_THAT(sent(1999ms), IsEmpty());
  EXPECT_THAT(sent(2000ms), ElementsAre(1));
}

TEST_F(Fed, OneAxisThatChangesAllTheTimeKeepsNoOtherWaiting) {
  add({1, 2, 3});
  EXPECT_THAT(sent(0ms), ElementsAre(1, 2, 3));
  std::vector<AxisNumber> order;
  for (Duration at = 100ms; at < 130ms; at += 1ms) {
    for (const AxisNumber axis : std::initializer_list<AxisNumber>{1, 2, 3}) changed(axis, at);
    if (const auto axis = feed.next(kStart + at)) order.push_back(*axis);  // room for one record at a time
  }
  EXPECT_EQ(std::ranges::count(order, 1), 3);
  EXPECT_EQ(std::ranges::count(order, 2), 3);
  EXPECT_EQ(std::ranges::count(order, 3), 3);
}

TEST_F(Fed, WithRoomForLessThanAllEachHasItsTurn) {
  for (AxisNumber axis = 1; axis <= 64; ++axis) feed.add(axis, kStart);
  std::map<AxisNumber, int> count;
  for (int i = 0; i < 640; ++i) {
    for (AxisNumber axis = 1; axis <= 64; ++axis) changed(axis, i * 1ms);
    if (const auto axis = feed.next(kStart + i * 1ms)) ++count[*axis];
  }
  for (AxisNumber axis = 1; axis <= 64; ++axis) EXPECT_EQ(count[axis], 10) << axis;
}

TEST_F(Fed, ANewReaderGetsAllAgain) {
  add({1, 2});
  EXPECT_THAT(sent(0ms), ElementsAre(1, 2));
  feed.all_due(kStart + 1ms);
  EXPECT_THAT(sent(1ms), ElementsAre(1, 2)) << "whatever was sent to the one before";
}

TEST_F(Fed, CountsThoseThatAreDue) {
  add({1, 2, 3});
  EXPECT_EQ(feed.waiting(kStart), 3U);
  static_cast<void>(feed.next(kStart));
  EXPECT_EQ(feed.waiting(kStart), 2U);
  EXPECT_EQ(feed.waiting(kStart + 1000ms), 3U);
}

TEST_F(Fed, WhatIsNoAxisIsNeverDue) {
  EXPECT_EQ(feed.due(), kNever);
  changed(7, 0ms);
  EXPECT_EQ(feed.due(), kNever);
  EXPECT_THAT(sent(10s), IsEmpty());
}

struct Ring : testing::Test {
  EventRing ring;
  EventFeed feed{ring};
  void add(int count) {
    for (int i = 0; i < count; ++i)
      ring.add(kStart, 3, EventKind::fault, 0x8130, "event " + std::to_string(ring.added() + 1));
  }
  std::vector<std::uint64_t> numbers() {
    std::vector<std::uint64_t> out;
    while (const Event* const event = feed.next()) out.push_back(event->number);
    return out;
  }
};

TEST_F(Ring, EventsComeOnceInTheirOrderWithAllThatTheySay) {
  add(2);
  const Event* const first = feed.next();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->number, 1U);
  EXPECT_EQ(first->text, "event 1");
  EXPECT_THAT(numbers(), ElementsAre(2));
  EXPECT_FALSE(feed.waiting());
  add(1);
  EXPECT_TRUE(feed.waiting());
  EXPECT_THAT(numbers(), ElementsAre(3));
  EXPECT_EQ(feed.lost(), 0U);
}

TEST_F(Ring, OfABurstTheNewestAreKeptAndTheOthersCounted) {
  add(1);
  static_cast<void>(numbers());
  add(static_cast<int>(kMaxEventsWaiting) + 36);
  const auto got = numbers();
  ASSERT_EQ(got.size(), kMaxEventsWaiting);
  EXPECT_EQ(got.front(), 38U);
  EXPECT_EQ(got.back(), ring.added());
  EXPECT_EQ(feed.lost(), 36U);
}

TEST_F(Ring, ANewReaderGetsTheNewestAgainAndTheyAreNotLost) {
  add(1100);
  static_cast<void>(numbers());
  const std::uint32_t lost = feed.lost();
  feed.restart();
  const auto got = numbers();
  ASSERT_EQ(got.size(), kMaxEventsWaiting);
  EXPECT_EQ(got.back(), 1100U);
  EXPECT_EQ(feed.lost(), lost);
}

}  // namespace
}  // namespace axisgate::feed
