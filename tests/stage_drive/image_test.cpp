// SPDX-License-Identifier: Apache-2.0
// What an axis shows (design 3.1 and 3.2): one step of the sequence per reply that changes something, and nothing
// untrue.
#include <gmock/gmock.h>

#include "gateway/image/shown.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using enum Situation;

TEST(Sequence, StandsStillWhileNothingChanges) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  rig.stage.run(3s);
  const auto before = rig.axis().sequence;
  rig.stage.run(5s);
  EXPECT_EQ(rig.axis().sequence, before);
}

TEST(Sequence, StepsOnceForEachReplyThatChangesSomething) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  AxisImage before = rig.axis();
  std::uint32_t steps = 0, changes = 0;
  for (int i = 0; i < 2'000; ++i) {
    ASSERT_TRUE(rig.stage.runtime().fire_one(kNever - 1ms));
    const AxisImage& now = rig.axis();
    steps += now.sequence - before.sequence;
    changes += shows_the_same(before, now) ? 0U : 1U;
    EXPECT_LE(now.sequence - before.sequence, 1U);
    EXPECT_EQ(now.sequence != before.sequence, !shows_the_same(before, now));
    before = now;
  }
  EXPECT_EQ(steps, changes);
  EXPECT_GT(steps, 50U);
}

TEST(Values, TurnStaleAndKeepTheLastGoodNumber) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  const auto refused_reads = [&](bool to_drive, Bytes bytes) {
    const WireRequest r = decoded(kLongAgo, bytes);
    if (to_drive && r.index == 0x6063) rig.stage.link(0).fate = SimLink::Fate::refused;
  };
  rig.stage.run(100ms);
  rig.stage.link(0).on_traffic = refused_reads;
  rig.stage.run(1s);
  EXPECT_EQ(rig.axis().supported & bit(Quantity::position_actual), 0U) << "refused: what it has now";
  EXPECT_EQ(shown_value(rig.axis(), Quantity::position_actual), INT32_MIN);
  EXPECT_EQ(rig.axis().valid_bits() & bit(Quantity::position_actual), 0U);
  EXPECT_NE(rig.axis().valid_bits() & bit(Quantity::statusword), 0U) << "it spoils none of the others";
}

// 3.2: "A value ... not representable reads as the type's end". It kept the last number that had fitted.
TEST(Values, ThatDoNotFitTheirRegisterReadAsItsEnd) {
  RigOptions options;
  options.axis.units_per_rev = Rational{1'000'000'000};  // two turns are all that the register has
  Rig rig(KincoType::jd, options);
  rig.bring_to(running);
  rig.stage.run(5s);
  EXPECT_EQ(shown_value(rig.axis(), Quantity::position_actual), INT32_MIN);
  EXPECT_EQ(rig.axis().valid_bits() & bit(Quantity::position_actual), 0U);
  EXPECT_NE(rig.axis().supported & bit(Quantity::position_actual), 0U);
  EXPECT_NE(shown_value(rig.axis(), Quantity::velocity_actual), INT32_MIN) << "it spoils none of the others";
}

TEST(Values, OfASilentDriveAreNotValidLongerThanTheirStaleTime) {
  Rig rig(KincoType::jd);
  rig.bring_to(running);
  const auto last = rig.axis()[Quantity::position_actual].value;
  ASSERT_NE(rig.axis().valid_bits() & bit(Quantity::position_actual), 0U);
  rig.faults().set_rate(DriveFault::unresponsive, 1);
  rig.stage.run(310ms);
  EXPECT_EQ(rig.axis().valid_bits() & bit(Quantity::position_actual), 0U);
  EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::position_actual].value), static_cast<double>(last), 3'000);
  EXPECT_GE(elapsed_ms(rig.axis().oldest_cyclic, rig.stage.runtime().now()), 300);
}

// Bit 12 of a Kinco's controlword starts a move where bit 4 was set before (0x103F).
TEST(TargetReached, IsNotThatOfTheMoveBeforeWhereTheMakersBitAloneStarts) {
  for (const KincoType type : {KincoType::jd, KincoType::md}) {
    Rig rig(type);
    rig.bring_to(enabled);
    const auto reached = [&] {
      return rig.axis().has(AxisInput::target_reached) || (shown_value(rig.axis(), Quantity::statusword) & 0x0400) != 0;
    };
    ASSERT_EQ(rig.write(Quantity::mode, 1).outcome.code, Errc::ok);
    ASSERT_EQ(rig.write(Quantity::profile_velocity, 900'000).outcome.code, Errc::ok);
    ASSERT_EQ(rig.write(Quantity::target_position, 20'000).outcome.code, Errc::ok);
    ASSERT_EQ(rig.ask(with_controlword(0x003F)).outcome.code, Errc::ok);
    ASSERT_TRUE(rig.stage.run_until(reached));
    ASSERT_EQ(rig.write(Quantity::target_position, -5'000).outcome.code, Errc::ok);
    ASSERT_TRUE(reached());
    const auto place = rig.stage.begin(1, with_controlword(0x103F));
    while (!place->has_value()) {
      EXPECT_FALSE(reached()) << "from the acceptance until the reply";
      rig.stage.run(1ms);
    }
    EXPECT_FALSE(reached());
    ASSERT_TRUE(rig.stage.run_until(reached));
    EXPECT_NEAR(static_cast<double>(shown_value(rig.axis(), Quantity::position_actual)), -5'000, 20);
    ASSERT_EQ(rig.stage.begin(1, with_controlword(0x103F))->has_value(), false);
    EXPECT_TRUE(reached()) << "the same word again has no edge";
  }
}

TEST(TargetReached, ComesBackWhenTheStartIsRefusedOrDropped) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  rig.stage.run(200ms);
  ASSERT_TRUE(rig.axis().has(AxisInput::target_reached));
  EXPECT_EQ(rig.command(Command::home).outcome.code, Errc::bad_value);
  EXPECT_TRUE(rig.axis().has(AxisInput::target_reached));
  const auto enable = rig.stage.begin(1, setpoints({{Quantity::profile_velocity, 77'000}}));
  const auto move = rig.stage.begin(1, with_command(Command::move_absolute));
  EXPECT_FALSE(rig.axis().has(AxisInput::target_reached));
  rig.stage.link(0).unplug();
  rig.stage.run(10ms);
  rig.stage.link(0).plug();
  rig.online();
  rig.stage.run(100ms);
  EXPECT_TRUE(rig.axis().has(AxisInput::target_reached));
}

TEST(Reply, IsGivenOnlyWithAStatuswordSampledAfterTheLastAcknowledgement) {
  Rig rig(KincoType::md);
  rig.bring_to(enabled);
  for (int i = 0; i < 50; ++i) {
    rig.mark();
    rig.stage.run(std::chrono::microseconds(i * 700));
    rig.mark();
    ASSERT_EQ(rig.write(Quantity::profile_velocity, 100'000 + i * 1'000).outcome.code, Errc::ok);
    bool written = false, read = false;
    for (const WireRequest& r : rig.requests()) {
      read = read || (written && r.index == kStatusword);
      written = written || r.write;
    }
    EXPECT_TRUE(written && read);
  }
}

TEST(Alarms, TellOfEachThingThatWasFound) {
  RigOptions fresh;
  fresh.drive.factory_fresh = true;
  Rig jd(KincoType::jd, fresh);
  jd.online();
  EXPECT_NE(jd.axis().alarms & bit(AxisAlarm::local_control), 0U);
  EXPECT_NE(jd.axis().alarms & bit(AxisAlarm::limit_inputs_open), 0U);
  EXPECT_NE(jd.axis().alarms & bit(AxisAlarm::no_comm_watchdog), 0U);
  EXPECT_EQ(jd.axis().loss_stop_ms, kGoesOn);
  EXPECT_NE(jd.axis().alarms & bit(AxisAlarm::not_homed), 0U);
  EXPECT_FALSE(jd.axis().has(AxisInput::ready)) << "an enable would not be tried";
  EXPECT_EQ(jd.command(Command::enable).outcome.code, Errc::state_unsuitable);
  EXPECT_TRUE(jd.has_event(EventKind::warning, "DIN1"));
  Rig md(KincoType::md);
  md.online();
  EXPECT_NE(md.axis().alarms & bit(AxisAlarm::stop_options), 0U) << "605B is 0: the motor coasts";
  EXPECT_TRUE(md.has_event(EventKind::warning, "605B is 0")) << "the event names the check that found it";
  ASSERT_EQ(md.mailbox_write(0x605B, 0, 2, 1).outcome.code, Errc::ok);
  md.stage.run(2s);
  EXPECT_EQ(md.axis().alarms & bit(AxisAlarm::stop_options), 0U) << "judged anew";
}

}  // namespace
}  // namespace axisgate::test
