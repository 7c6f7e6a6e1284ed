// SPDX-License-Identifier: Apache-2.0
// Limits whatever the way in, the object mailbox's raw units, homing and set_position (design 3.1, 3.3, 3.4).
#include <gmock/gmock.h>

#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using enum Situation;

RigOptions limited() {
  RigOptions options;
  options.axis.limits.position = Range{-20'000, 20'000};
  options.axis.limits.velocity = 1'000'000;
  return options;
}

TEST(Limits, HoldForEveryWayIn) {
  Rig rig(KincoType::jd, limited());
  rig.bring_to(enabled);
  EXPECT_EQ(rig.write(Quantity::target_position, 20'001).outcome.code, Errc::bad_value);
  EXPECT_EQ(rig.write(Quantity::target_velocity, -1'000'001).outcome.code, Errc::bad_value);
  EXPECT_EQ(rig.mailbox_write(0x607A, 0, 4, 20'001).outcome.code, Errc::bad_value);
  EXPECT_EQ(rig.mailbox_write(0x607A, 0, 2, 100).outcome.code, Errc::bad_value) << "another width would cut the value";
  EXPECT_EQ(rig.mailbox_write(0x6060, 0, 1, 99).outcome.code, Errc::bad_value);
  EXPECT_TRUE(rig.writes().empty());
  ASSERT_EQ(rig.ask(with_command(Command::move_absolute, {{Quantity::target_position, 15'000}})).outcome.code,
            Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
  rig.mark();
  EXPECT_EQ(rig.ask(with_command(Command::move_relative, {{Quantity::target_position, 6'000}})).outcome.code,
            Errc::bad_value);
  EXPECT_TRUE(rig.writes_of(kControlword).empty()) << "known before sending";
  ASSERT_EQ(rig.ask(with_controlword(0x004F)).outcome.code, Errc::ok);
  EXPECT_EQ(rig.ask(with_controlword(0x005F)).outcome.code, Errc::bad_value);
  ASSERT_EQ(rig.command(Command::disable).outcome.code, Errc::ok);
  ASSERT_EQ(rig.ask(with_controlword(0x0006)).outcome.code, Errc::ok);
  EXPECT_EQ(rig.ask(with_controlword(0x005F)).outcome.code, Errc::bad_value) << "it may start as it enables";
  EXPECT_EQ(rig.count(kControlword, 0x5F), 0U);
  EXPECT_EQ(rig.ask(with_controlword(0x000F)).outcome.code, Errc::ok);
}

// 3.4: command 7 goes "by target_position from the set-point position": a distance is no position.
TEST(Limits, OfThePositionAreThoseOfWhereARelativeMoveEnds) {
  RigOptions options;
  options.axis.limits.position = Range{1'000, 50'000};
  Rig rig(KincoType::jd, options);
  rig.bring_to(enabled);
  const auto move = [&](Command command, std::int64_t target) {
    const Errc code = rig.ask(with_command(command, {{Quantity::target_position, target}})).outcome.code;
    rig.stage.run_until([&] { return rig.axis().motion_state != MotionState::active; });
    return code;
  };
  const auto position = [&] { return rig.axis()[Quantity::position_actual].value; };
  ASSERT_EQ(move(Command::move_absolute, 40'000), Errc::ok);
  EXPECT_EQ(move(Command::move_relative, -500), Errc::ok);
  EXPECT_NEAR(static_cast<double>(position()), 39'500, 10);
  EXPECT_EQ(move(Command::move_relative, 10'501), Errc::bad_value);
  EXPECT_EQ(move(Command::move_relative, -38'501), Errc::bad_value);
  EXPECT_EQ(move(Command::move_absolute, -500), Errc::bad_value);
  EXPECT_EQ(rig.command(Command::move_absolute).outcome.code, Errc::bad_value) << "the distance is no place either";
  rig.stage.run(1s);
  EXPECT_NEAR(static_cast<double>(position()), 39'500, 10);
}

// 3.3: 0x03 for a "value outside the axis's, profile's or drive's limits (known before sending)": such a move never
// ends.
TEST(Limits, ThatTheDriveHoldsItselfHoldToo) {
  for (const KincoType type : {KincoType::jd, KincoType::md}) {
    Rig rig(type);
    rig.bring_to(enabled);
    ASSERT_EQ(rig.write(Quantity::target_position, 9'000).outcome.code, Errc::ok) << "it has none yet";
    ASSERT_EQ(rig.ask(setpoints({{Quantity::position_limit_min, -8'000}, {Quantity::position_limit_max, 8'000}}))
                  .outcome.code,
              Errc::ok);
    rig.stage.run(1s);
    EXPECT_EQ(rig.command(Command::move_absolute).outcome.code, Errc::bad_value) << "accepted before";
    EXPECT_EQ(rig.write(Quantity::target_position, 9'000).outcome.code, Errc::bad_value);
    EXPECT_EQ(rig.ask(with_command(Command::move_relative, {{Quantity::target_position, -8'001}})).outcome.code,
              Errc::bad_value);
    EXPECT_FALSE(rig.turns());
    EXPECT_EQ(rig.ask(with_command(Command::run_velocity,
                                   {{Quantity::target_position, 9'000}, {Quantity::target_velocity, 60'000}}))
                  .outcome.code,
              Errc::ok)
        << "it merely stands in the block";
    EXPECT_EQ(rig.command(Command::halt).outcome.code, Errc::ok);
    EXPECT_TRUE(rig.stage.run_until([&] { return !rig.turns(); }));
    EXPECT_EQ(rig.ask(with_command(Command::move_absolute,
                                   {{Quantity::position_limit_max, 10'000}, {Quantity::target_position, 9'000}}))
                  .outcome.code,
              Errc::ok)
        << "wide enough from now on";
    EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
  }
}

TEST(Limits, OfATargetThatTheDriveHoldsFromElsewhereHoldToo) {
  Rig rig(KincoType::jd, limited());
  rig.motor().poke({0x607A, 0}, 500'000);
  rig.online();
  ASSERT_EQ(rig.write(Quantity::mode, 1).outcome.code, Errc::ok);
  ASSERT_EQ(rig.ask(with_controlword(0x0006)).outcome.code, Errc::ok);
  ASSERT_EQ(rig.ask(with_controlword(0x000F)).outcome.code, Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.motor_enabled(); }));
  rig.stage.run(100ms);
  ASSERT_EQ(rig.ask(with_controlword(0x002F)).outcome.code, Errc::ok);
  EXPECT_EQ(rig.ask(with_controlword(0x003F)).outcome.code, Errc::bad_value);
  EXPECT_EQ(rig.command(Command::move_absolute).outcome.code, Errc::bad_value);
  EXPECT_FALSE(rig.turns());
}

// Nobody has written what a drive holds from its maker or from elsewhere, so nobody was refused.
TEST(Limits, OfSpeedsThatTheDriveHoldsFromElsewhereHoldInEveryKindOfMotion) {
  struct Held {
    Command command;
    std::int16_t mode;
    std::uint16_t raw_start;  // none where 15 itself starts
    simulated::ObjectKey at;
    std::int64_t poked;  // none where its maker's own is beyond
    Quantity shown;
  };
  constexpr std::int64_t kVelocity = 30'000, kAcceleration = 20'000, kMuch = 40'000'000;
  constexpr std::array kHeld{
      Held{Command::move_absolute, 1, 0x3F, {0x6081, 0}, 0, Quantity::profile_velocity},
      Held{Command::run_velocity, 3, 0, {0x6083, 0}, kMuch, Quantity::profile_acceleration},
      Held{Command::run_velocity, 3, 0, {0x6084, 0}, kMuch, Quantity::profile_deceleration},
      Held{Command::run_torque, 4, 0, {0x6080, 0}, 0, Quantity::max_velocity},
      Held{Command::home, 6, 0x1F, {0x6099, 1}, kMuch, Quantity::homing_speed_switch},
      Held{Command::home, 6, 0x1F, {0x6099, 2}, kMuch, Quantity::homing_speed_zero},
      Held{Command::home, 6, 0x1F, {0x609A, 0}, kMuch, Quantity::homing_acceleration},
  };
  for (const Held& held : kHeld) {
    for (const bool raw : {false, true}) {
      SCOPED_TRACE(testing::Message() << row(held.shown).name << (raw ? ", raw" : ""));
      RigOptions options;
      options.axis.limits.velocity = kVelocity;
      options.axis.limits.acceleration = kAcceleration;
      options.axis.homing_method = 19;
      Rig rig(KincoType::jd, options);
      if (held.poked != 0) rig.motor().poke(held.at, held.poked);
      rig.bring_to(enabled);
      rig.stage.run(1s);
      const bool ramp = held.at.index == 0x6083 || held.at.index == 0x6084 || held.at.index == 0x609A;
      const std::int64_t limit = ramp ? kAcceleration : kVelocity;
      ASSERT_GT(rig.axis()[held.shown].value, limit);
      ASSERT_EQ(rig.ask(setpoints({{Quantity::target_position, 500'000},
                                   {Quantity::target_velocity, 10'000},
                                   {Quantity::target_torque, 100}}))
                    .outcome.code,
                Errc::ok);
      if (raw) {
        ASSERT_EQ(rig.write(Quantity::mode, held.mode).outcome.code, Errc::ok);
        ASSERT_EQ(rig.ask(with_controlword(0x000F)).outcome.code, Errc::ok);
        if (held.raw_start != 0) {
          ASSERT_EQ(rig.ask(with_controlword(held.raw_start)).outcome.code, Errc::ok);
        }
      } else {
        ASSERT_EQ(rig.command(held.command).outcome.code, Errc::ok);
      }
      EXPECT_TRUE(rig.turns());
      rig.stage.run(1s);
      EXPECT_LE(std::abs(rig.axis()[Quantity::velocity_actual].value), kVelocity + kVelocity / 20);
      EXPECT_LE(rig.axis()[held.shown].value, limit);
      EXPECT_GT(rig.axis()[held.shown].value, limit * 9 / 10);
    }
  }
}

// Further names of a speed, an enable or a motion: no limit, latch or owner stands before them.
TEST(Mailbox, OnlyReadsWhatWouldGoPastTheRegisters) {
  struct Way {
    std::uint16_t index;
    std::uint8_t sub, size;
    std::uint32_t data;
  };
  constexpr std::array kWays{Way{0x2FF0, 0x05, 1, 1},   Way{0x2FF0, 0x06, 2, 2'000}, Way{0x2FF0, 0x07, 2, 2'000},
                             Way{0x2FF0, 0x09, 2, 100}, Way{0x2FF0, 0x0C, 2, 11},    Way{0x6071, 0, 2, 100}};
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  for (const Way& way : kWays) {
    SCOPED_TRACE(testing::Message() << std::hex << way.index << "." << int{way.sub});
    EXPECT_EQ(rig.mailbox_write(way.index, way.sub, way.size, way.data).outcome.code, Errc::bad_value);
    EXPECT_TRUE(rig.writes().empty());
  }
  WriteBatch read;
  read.object = ObjectRequest{false, 0x6071, 0, 2, 0};
  EXPECT_EQ(rig.ask(read).outcome.code, Errc::ok);
}

TEST(Limits, ThePairIsCheckedTogetherAndNeverStandsTheWrongWayRound) {
  Rig rig(KincoType::md);
  rig.bring_to(disabled);
  const Quantity low = Quantity::position_limit_min, high = Quantity::position_limit_max;
  EXPECT_EQ(rig.ask(setpoints({{low, 5'000}, {high, 4'000}})).outcome.code, Errc::bad_value);
  ASSERT_EQ(rig.ask(setpoints({{low, -1'000}, {high, 1'000}})).outcome.code, Errc::ok);
  EXPECT_EQ(rig.write(high, -2'000).outcome.code, Errc::bad_value);
  rig.mark();
  ASSERT_EQ(rig.ask(setpoints({{low, 2'000}, {high, 3'000}})).outcome.code, Errc::ok);
  const auto writes = rig.writes();
  ASSERT_EQ(writes.size(), 2U);
  EXPECT_EQ(writes[0].sub, 1) << "the upper one first";
}

TEST(Limits, AreJudgedAgainWhenTheTurnHasCome) {
  Rig rig(KincoType::md);
  rig.bring_to(disabled);
  ASSERT_EQ(
      rig.ask(setpoints({{Quantity::position_limit_min, 0}, {Quantity::position_limit_max, 10'000}})).outcome.code,
      Errc::ok);
  const auto first = rig.stage.begin(1, setpoints({{Quantity::position_limit_max, 1'000}}));
  const auto second = rig.stage.begin(1, setpoints({{Quantity::position_limit_min, 5'000}}));
  rig.stage.run(300ms);
  EXPECT_EQ((*first)->outcome.code, Errc::ok);
  EXPECT_EQ((*second)->outcome.code, Errc::bad_value);
}

TEST(Mailbox, AWriteOfAQuantitysObjectReachesTheWireExactly) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  // 123456 DEC is no whole number of 0.001 rpm: the raw number must not take the way through register units.
  ASSERT_EQ(rig.mailbox_write(0x6081, 0, 4, 123'456).outcome.code, Errc::ok);
  EXPECT_EQ(rig.object(0x6081), 123'456);
  ASSERT_EQ(rig.write(Quantity::mode, 3).outcome.code, Errc::ok);
  rig.mark();
  ASSERT_EQ(rig.mailbox_write(0x60FF, 0, 4, 7'777).outcome.code, Errc::ok);
  EXPECT_EQ(rig.object(0x60FF), 7'777) << "a raw mode runs: it acts at once";
  ASSERT_EQ(rig.command(Command::halt).outcome.code, Errc::ok);
  ASSERT_EQ(rig.mailbox_write(0x60FF, 0, 4, 8'888).outcome.code, Errc::ok);
  EXPECT_EQ(rig.object(0x60FF), 0) << "kept: the halt has ended the run";
  ASSERT_EQ(rig.command(Command::run_velocity).outcome.code, Errc::ok);
  EXPECT_EQ(rig.object(0x60FF), 8'888);
}

TEST(Mailbox, AControlwordObeysTheLatch) {
  Rig rig(KincoType::jd);
  rig.bring_to(latched);
  EXPECT_EQ(rig.mailbox_write(0x6040, 0, 2, 0x0F).outcome.code, Errc::state_unsuitable);
  EXPECT_TRUE(rig.writes().empty());
}

TEST(Mailbox, AReadGivesTheDrivesBytesAndARefusalItsCode) {
  Rig rig(KincoType::jd);
  rig.bring_to(disabled);
  WriteBatch batch;
  batch.object = ObjectRequest{false, 0x6063, 0, 4, 0};
  BatchResult result = rig.ask(batch);
  EXPECT_EQ(result.outcome.code, Errc::ok);
  EXPECT_EQ(result.object_size, 4);
  batch.object = ObjectRequest{false, 0x5F00, 0, 4, 0};
  result = rig.ask(batch);
  EXPECT_EQ(result.outcome.code, Errc::refused_by_drive);
  EXPECT_EQ(result.outcome.detail, 0x06020000U);
}

TEST(Clamping, IsFoundByReadingBackAndTold) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  // As a drive that clamps (JD 1.4): it acknowledges one number and holds another.
  rig.stage.link(0).on_traffic = [&](bool to_drive, Bytes bytes) {
    const WireRequest r = decoded(kLongAgo, bytes);
    if (to_drive && !r.write && r.index == 0x6081) rig.motor().poke({0x6081, 0}, 1'000);
  };
  ASSERT_EQ(rig.write(Quantity::profile_velocity, 900'000).outcome.code, Errc::ok);
  rig.stage.run(500ms);
  EXPECT_NE(rig.axis().alarms & bit(AxisAlarm::clamped), 0U);
  EXPECT_LT(rig.axis()[Quantity::profile_velocity].value, 900'000) << "what the drive holds is shown";
  rig.stage.link(0).on_traffic = [](bool, Bytes) {};
  ASSERT_EQ(rig.write(Quantity::profile_velocity, 300'000).outcome.code, Errc::ok);
  rig.stage.run(500ms);
  EXPECT_EQ(rig.axis().alarms & bit(AxisAlarm::clamped), 0U);
}

TEST(Homing, NeedsAMethodThatSomebodyChose) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  EXPECT_EQ(rig.command(Command::home).outcome.code, Errc::bad_value) << "the drive's own is nobody's choice";
  EXPECT_EQ(rig.write(Quantity::homing_method, 15).outcome.code, Errc::bad_value) << "not in the profile's list";
  EXPECT_TRUE(rig.writes().empty());
  RigOptions options;
  options.axis.homing_method = 35;
  Rig configured(KincoType::jd, options);
  configured.bring_to(enabled);
  EXPECT_EQ(configured.command(Command::home).outcome.code, Errc::ok);
  EXPECT_EQ(configured.object(0x6098), 35);
  EXPECT_TRUE(configured.stage.run_until([&] { return configured.axis().motion_state == MotionState::completed; }));
  configured.stage.run(50ms);
  EXPECT_TRUE(configured.axis().has(AxisInput::homed));
  EXPECT_EQ(configured.axis().alarms & bit(AxisAlarm::not_homed), 0U);
  EXPECT_TRUE(configured.has_event(EventKind::homed, "homed"));
}

TEST(Homing, ThatTakesTooLongIsHalted) {
  for (const KincoType type : {KincoType::jd, KincoType::md}) {
    RigOptions options;
    options.axis.homing_timeout = 2s;
    Rig rig(type, options);
    rig.bring_to(homing);
    ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::failed; }, 3s));
    const Instant failed = rig.stage.runtime().now();
    ASSERT_TRUE(rig.stage.run_until([&] { return !rig.writes_of(kControlword).empty(); }, 1s));
    EXPECT_LE(rig.stage.runtime().now() - failed, 30ms) << "at once";
    EXPECT_TRUE(rig.stage.run_until([&] { return !rig.turns(); }, 3s));
    EXPECT_EQ(rig.axis().motion_state, MotionState::failed);
    EXPECT_TRUE(rig.has_event(EventKind::warning, "homing"));
  }
}

TEST(SetPosition, IsZeroOnlyAndPutsEverythingBack) {
  Rig rig(KincoType::md);
  rig.bring_to(enabled);
  ASSERT_EQ(rig.ask(setpoints({{Quantity::homing_method, 19}, {Quantity::homing_offset, 700}})).outcome.code, Errc::ok);
  const auto offset = rig.object(0x607C);
  WriteBatch batch = with_command(Command::set_position);
  batch.set_position_value = 500;
  EXPECT_EQ(rig.ask(batch).outcome.code, Errc::bad_value);
  batch.set_position_value = 0;
  EXPECT_EQ(rig.ask(batch).outcome.code, Errc::ok);
  EXPECT_NEAR(static_cast<double>(rig.axis()[Quantity::position_actual].value), 0, 5);
  EXPECT_EQ(rig.object(0x6098), 19);
  EXPECT_EQ(rig.object(0x607C), offset);
  EXPECT_EQ(rig.object(kMode), 1);
  EXPECT_TRUE(rig.motor_enabled());
  EXPECT_FALSE(rig.turns());
}

TEST(SetPosition, ThatFailedHalfWayDoesNotSpoilTheNextHoming) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  ASSERT_EQ(rig.ask(setpoints({{Quantity::homing_method, 19}, {Quantity::homing_offset, 700}})).outcome.code, Errc::ok);
  const auto offset = rig.object(0x607C);
  rig.stage.run(300ms);
  rig.stage.link(0).on_traffic = [&](bool to_drive, Bytes bytes) {
    const WireRequest r = decoded(kLongAgo, bytes);
    if (to_drive && r.write && r.index == kControlword && r.data == 0x1F)
      rig.stage.link(0).fate = SimLink::Fate::refused;
  };
  EXPECT_EQ(rig.command(Command::set_position).outcome.code, Errc::refused_by_drive);
  EXPECT_EQ(rig.object(0x6098), 35);
  rig.stage.link(0).on_traffic = [](bool, Bytes) {};
  ASSERT_EQ(rig.command(Command::home).outcome.code, Errc::ok);
  EXPECT_EQ(rig.object(0x6098), 19);
  EXPECT_EQ(rig.object(0x607C), offset);
}

}  // namespace
}  // namespace axisgate::test
