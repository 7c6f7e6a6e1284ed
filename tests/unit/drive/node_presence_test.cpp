// SPDX-License-Identifier: Apache-2.0
// When a drive counts as gone, how one that is gone is looked for, and when a node's start counts as lost.
#include "gateway/drive/device/node_presence.hpp"

#include <gtest/gtest.h>

#include "gateway/drive/device/node_start.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
using bus::NodeState;
using Look = NodePresence::Look;

constexpr Instant kBegin = kLongAgo + 1h;
constexpr Duration kTimeout = 50ms;

TEST(NodePresence, IsLostWithTheThirdTimeoutInARow) {
  NodePresence presence(false, kTimeout);
  EXPECT_FALSE(presence.timed_out());
  EXPECT_FALSE(presence.timed_out());
  presence.answered();
  EXPECT_FALSE(presence.timed_out());
  EXPECT_FALSE(presence.timed_out());
  EXPECT_TRUE(presence.timed_out());
}

TEST(NodePresence, ADriveThatIsNoNodeIsAskedAlways) {
  NodePresence presence(false, kTimeout);
  presence.on_link(true, kBegin);
  EXPECT_EQ(presence.look_due(), kBegin);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(presence.look(true), Look::ask);
    presence.asked();
  }
}

TEST(NodePresence, ANodeThatNeverSpokeIsAskedOnceThenCalledAndGivenUpWithTheThirdTimeout) {
  NodePresence presence(true, kTimeout);
  presence.on_link(true, kBegin);
  ASSERT_EQ(presence.look(true), Look::ask);
  presence.asked();
  ASSERT_FALSE(presence.timed_out());
  ASSERT_EQ(presence.look(true), Look::call);
  presence.called(kBegin);
  ASSERT_EQ(presence.look(true), Look::call) << "one call is unanswered: the second timeout";
  presence.called(kBegin + 1s);
  EXPECT_EQ(presence.look(true), Look::give_up);
}

TEST(NodePresence, ANodeThatIsGoneIsAskedAgainAfterFourCalls) {
  NodePresence presence(true, kTimeout);
  presence.on_link(true, kBegin);
  presence.asked();
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < NodePresence::kCallsPerQuestion; ++i) {
      ASSERT_EQ(presence.look(false), Look::call);
      presence.called(kBegin);
    }
    ASSERT_EQ(presence.look(false), Look::ask) << "a node may know neither guarding nor heartbeat";
    presence.asked();
  }
}

TEST(NodePresence, TheSearchGrowsSlowerUntilTheDriveIsFound) {
  NodePresence presence(false, kTimeout);
  presence.look_later(kBegin);
  EXPECT_EQ(presence.look_due(), kBegin + 500ms);
  presence.look_later(kBegin);
  EXPECT_EQ(presence.look_due(), kBegin + 1s);
  presence.found();
  presence.look_later(kBegin);
  EXPECT_EQ(presence.look_due(), kBegin + 500ms);
}

TEST(NodePresence, AfterALossOfTheLinkTheSearchBeginsAnew) {
  NodePresence presence(true, kTimeout);
  presence.look_later(kBegin);
  ASSERT_FALSE(presence.timed_out());
  ASSERT_FALSE(presence.timed_out());
  static_cast<void>(presence.on_present(NodeState::stopped));
  presence.on_link(false, kBegin);
  EXPECT_EQ(presence.look_due(), kNever);
  presence.on_link(true, kBegin + 1s);
  EXPECT_EQ(presence.look_due(), kBegin + 1s);
  EXPECT_EQ(presence.look(true), Look::ask) << "what it told before the loss does not count";
  presence.look_later(kBegin + 1s);
  EXPECT_EQ(presence.look_due(), kBegin + 1s + 500ms);
  EXPECT_FALSE(presence.timed_out());
}

TEST(NodePresence, AStoppedNodeIsWokenAndAskedOnceItHasLeftThatState) {
  NodePresence presence(true, kTimeout);
  presence.on_link(true, kBegin);
  EXPECT_TRUE(presence.on_present(NodeState::stopped));
  EXPECT_EQ(presence.look(true), Look::wake);
  EXPECT_FALSE(presence.on_present(NodeState::stopped)) << "a sign like the one before";
  EXPECT_TRUE(presence.on_present(NodeState::pre_operational));
  EXPECT_EQ(presence.look(true), Look::ask);
}

TEST(NodePresence, ANodeWhoseSignsOfLifeHaveCeasedIsCalled) {
  NodePresence presence(true, kTimeout);
  presence.on_link(true, kBegin);
  presence.asked();
  presence.on_started();
  EXPECT_EQ(presence.look(false), Look::ask);
  presence.on_gone(true);
  EXPECT_EQ(presence.look(false), Look::call);
  EXPECT_TRUE(presence.on_present(NodeState::pre_operational)) << "the first sign after it was gone";
}

TEST(NodePresence, ADuplicateNodeIdIsShownForAMinuteAfterItsLastSign) {
  NodePresence presence(true, kTimeout);
  EXPECT_FALSE(presence.duplicated(kBegin));
  presence.on_duplicate(kBegin);
  presence.on_duplicate(kBegin + 30s);
  EXPECT_EQ(presence.duplicate_due(kBegin + 30s), kBegin + 90s);
  EXPECT_TRUE(presence.duplicated(kBegin + 89s));
  EXPECT_FALSE(presence.duplicated(kBegin + 90s));
}

TEST(NodeStart, AHeartbeatOfBeforeTheStartSaysNothing) {
  NodeStart start(kTimeout);
  start.begin();
  start.commanded(kBegin);
  EXPECT_FALSE(start.has_left(NodeState::pre_operational, kBegin + NodeStart::kNmtSettles));
  EXPECT_TRUE(start.has_left(NodeState::pre_operational, kBegin + NodeStart::kNmtSettles + 1ms));
  EXPECT_TRUE(start.has_left(NodeState::stopped, kBegin + 1s));
  EXPECT_FALSE(start.has_left(NodeState::operational, kBegin + 1s));
  EXPECT_FALSE(start.has_left(NodeState::unknown, kBegin + 1s));
}

TEST(NodeStart, ANodeThatHasLeftIsStartedAnewAfterAPauseAndToldOfOnce) {
  NodeStart start(kTimeout);
  start.begin();
  start.commanded(kBegin);
  ASSERT_EQ(start.deadline(kBegin), kNever);
  EXPECT_EQ(start.leave(kBegin + 1s), 500ms);
  EXPECT_FALSE(start.has_left(NodeState::stopped, kBegin + 2s)) << "told already";
  EXPECT_FALSE(start.is_due(kBegin + 1s));
  EXPECT_EQ(start.deadline(kBegin + 1s), kBegin + 1s + 500ms);
  EXPECT_TRUE(start.is_due(kBegin + 1s + 500ms));
  EXPECT_EQ(start.deadline(kBegin + 2s), kNever);
  start.begin();
  EXPECT_FALSE(start.is_due(kBegin + 2s));
}

TEST(NodeStart, ThePauseGrowsUntilAStartHasHeld) {
  NodeStart start(kTimeout);
  start.commanded(kBegin);
  EXPECT_EQ(start.leave(kBegin + 1s), 500ms);
  start.commanded(kBegin + 2s);
  EXPECT_EQ(start.leave(kBegin + 3s), 1s);
  start.commanded(kBegin + 5s);
  EXPECT_EQ(start.leave(kBegin + 5s + NodeStart::kStartHeld), 2s);
  start.commanded(kBegin + 1min);
  EXPECT_EQ(start.leave(kBegin + 1min + NodeStart::kStartHeld + 1ms), 500ms);
}

}  // namespace
}  // namespace axisgate::drive
