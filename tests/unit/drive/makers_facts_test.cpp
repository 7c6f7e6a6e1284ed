// SPDX-License-Identifier: Apache-2.0
// What CiA 402 leaves to the makers is what the profile says of it: bits that make a drive follow its target, modes of
// its own, a velocity that lags.
#include <gtest/gtest.h>

#include "gateway/drive/state/axis_core.hpp"
#include "tests/unit/drive/kinco.hpp"

namespace axisgate::drive {
namespace {

using std::chrono::milliseconds;

/// A Kinco JD on CANopen, enabled in mode 1, with bit 12 of its controlword set.
class MakersFacts : public testing::Test {
 protected:
  MakersFacts() : model(kinco_jd()), store(model.objects) {
    store.begin_exchange();
    store.read(core.model.statusword, 0x0637, turn.now);
    store.read(core.model.controlword, 0x103F, turn.now);
    store.read(core.model.mode, 1, turn.now);
    store.read(core.model.mode_display, 1, turn.now);
  }

  model::DriveModel model;
  ObjectStore store;
  Turn turn{.now = kLongAgo, .link = LinkState::online};
  AxisRecord record;
  AxisCore core{model, model.axes[0], store, turn, Motion{model.axes[0].velocity_lag, record}};
};

TEST_F(MakersFacts, ATargetThatTheDriveWouldFollowIsHeldBack) {
  EXPECT_TRUE(core.held_back(Quantity::target_position));
  model.axes[0].cia402.follow_bits = 0x0800;
  EXPECT_FALSE(core.held_back(Quantity::target_position)) << "bit 12 is none of them";
}

TEST_F(MakersFacts, AModeOfItsOwnIsAVelocityModeWhereTheProfileSaysSo) {
  EXPECT_TRUE(core.is_continuous(-3));
  EXPECT_FALSE(core.is_continuous(-4)) << "that follows pulses";
  EXPECT_TRUE(core.is_continuous(3));
  store.read(core.model.mode_display, -3, turn.now);
  EXPECT_EQ(followed_target(core.facts()), Quantity::target_velocity);
  model.axes[0].cia402.velocity_modes = {};
  EXPECT_FALSE(core.is_continuous(-3));
  EXPECT_EQ(followed_target(core.facts()), std::nullopt);
}

TEST_F(MakersFacts, AVelocityIsBelievedWhenItsLagIsOver) {
  for (const Duration lag : {Duration{}, Duration(milliseconds(300))}) {
    Motion motion(lag, record);
    AxisFacts facts = core.facts();
    facts.mode = 3;
    motion.observe(facts, milliseconds(60000));
    motion.start(MotionKind::velocity, 1, facts.at, facts.statusword_exchange);
    motion.stop(false, facts.at);
    motion.observe(facts, milliseconds(60000));
    EXPECT_EQ(motion.at_rest(facts), lag == Duration{}) << "its sample may be of before";
    facts.moving_at = facts.at;
    facts.at += lag;
    motion.observe(facts, milliseconds(60000));
    EXPECT_EQ(motion.at_rest(facts), lag == Duration{}) << "nor does it tell more by growing old";
    facts.moving_at = facts.at;
    motion.observe(facts, milliseconds(60000));
    EXPECT_TRUE(motion.at_rest(facts));
  }
}

}  // namespace
}  // namespace axisgate::drive
