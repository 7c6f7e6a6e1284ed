// SPDX-License-Identifier: Apache-2.0
// Set-points are not starts, and what is not sent (design 3.4, 3.3 What is not sent).
#include <gmock/gmock.h>

#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using enum Situation;

constexpr std::uint16_t kProfileVelocity = 0x6081;

TEST(Unchanged, IsNotSentAgainAndAnsweredAtOnce) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  const WriteBatch block = setpoints({{Quantity::profile_velocity, 150'000}, {Quantity::profile_acceleration, 5'000}});
  ASSERT_EQ(rig.ask(block).outcome.code, Errc::ok);
  rig.mark();
  for (int i = 0; i < 5; ++i) {
    const auto place = rig.stage.begin(1, block);
    EXPECT_TRUE(place->has_value()) << "without waiting for the wire";
  }
  EXPECT_TRUE(rig.writes().empty());
}

TEST(Unchanged, AModeInForceIsNotSentAgain) {
  Rig rig(KincoType::md);
  rig.bring_to(enabled);
  ASSERT_EQ(rig.write(Quantity::mode, 3).outcome.code, Errc::ok);
  rig.mark();
  ASSERT_EQ(rig.write(Quantity::mode, 3).outcome.code, Errc::ok);
  EXPECT_TRUE(rig.writes().empty());
}

struct Invalidation {
  const char* what;
  std::function<void(Rig&)> happen;
};

TEST(Unchanged, IsSentAgainAfterAnythingThatMayHaveChangedIt) {
  const std::vector<Invalidation> invalidations{
      {"timeout",
       [](Rig& rig) {
         rig.faults().next(DriveFault::unresponsive);
         ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::suspect; }));
       }},
      {"mode change", [](Rig& rig) { ASSERT_EQ(rig.write(Quantity::mode, 3).outcome.code, Errc::ok); }},
      {"mailbox write", [](Rig& rig) { ASSERT_EQ(rig.mailbox_write(0x2010, 0x0F, 2, 4).outcome.code, Errc::ok); }},
      {"mailbox write of a quantity",
       [](Rig& rig) { ASSERT_EQ(rig.mailbox_write(0x6083, 0, 4, 99'999).outcome.code, Errc::ok); }},
      {"fault reset",
       [](Rig& rig) {
         rig.motor().inject_fault(1, 0x20);
         ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().has(AxisInput::fault); }));
         rig.motor().clear_fault_cause(1, 0x20);
         ASSERT_EQ(rig.command(Command::fault_reset).outcome.code, Errc::ok);
       }},
      {"set_position", [](Rig& rig) { ASSERT_EQ(rig.command(Command::set_position).outcome.code, Errc::ok); }},
  };
  for (const Invalidation& invalidation : invalidations) {
    SCOPED_TRACE(invalidation.what);
    Rig rig(KincoType::jd);
    rig.bring_to(enabled);
    const WriteBatch block = setpoints({{Quantity::profile_velocity, 150'000}});
    ASSERT_EQ(rig.ask(block).outcome.code, Errc::ok);
    rig.stage.run(300ms);
    invalidation.happen(rig);
    rig.mark();
    EXPECT_EQ(rig.ask(block).outcome.code, Errc::ok);
    EXPECT_EQ(rig.writes_of(kProfileVelocity).size(), 1U);
    // Read back since, it is known again.
    rig.stage.run(2s);
    rig.mark();
    EXPECT_EQ(rig.ask(block).outcome.code, Errc::ok);
    EXPECT_TRUE(rig.writes().empty());
  }
}

TEST(Waiting, ANewerBatchOfTheSameSetpointsSupersedesAWaitingOne) {
  Rig rig(KincoType::jd);
  rig.bring_to(disabled);
  const auto enable = rig.stage.begin(1, with_command(Command::enable));
  rig.stage.run(3ms);
  const auto old = rig.stage.begin(1, setpoints({{Quantity::profile_velocity, 100'000}}));
  const auto newer = rig.stage.begin(1, setpoints({{Quantity::profile_velocity, 200'000}}));
  const auto other = rig.stage.begin(1, with_command(Command::fault_reset, {{Quantity::profile_velocity, 250'000}}));
  const auto newest = rig.stage.begin(1, setpoints({{Quantity::profile_velocity, 300'000}}));
  rig.stage.run(900ms);
  EXPECT_EQ((*old)->outcome.code, Errc::superseded);
  EXPECT_EQ((*newer)->outcome.code, Errc::ok) << "a write batch of the axis was accepted between";
  EXPECT_EQ((*newest)->outcome.code, Errc::ok);
  EXPECT_EQ((*other)->outcome.code, Errc::ok) << "a command is more than its set-points";
  EXPECT_EQ(rig.writes_of(kProfileVelocity).size(), 3U);
  EXPECT_TRUE(enable->has_value());
}

TEST(TargetPosition, NeverMovesADriveThatFollowsIt) {
  Rig rig(KincoType::jd);
  rig.bring_to(enabled);
  ASSERT_EQ(rig.write(Quantity::target_position, 0).outcome.code, Errc::ok);
  ASSERT_EQ(rig.ask(with_controlword(0x103F)).outcome.code, Errc::ok);
  ASSERT_EQ(rig.write(Quantity::target_position, 40'000).outcome.code, Errc::ok);
  EXPECT_FALSE(rig.turns());
  // And a distance is not taken for a place.
  rig.stage.run(500ms);
  ASSERT_EQ(rig.ask(with_command(Command::move_absolute, {{Quantity::target_position, 10'000}})).outcome.code,
            Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
  ASSERT_EQ(rig.ask(with_command(Command::move_relative, {{Quantity::target_position, 10'000}})).outcome.code,
            Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }));
  rig.stage.run(300ms);
  EXPECT_NEAR(rig.motor().position(), 20'000, 5);
}

TEST(RelativeMove, ByAControlwordIsRefusedWhileItMoves) {
  Rig rig(KincoType::jd);
  rig.bring_to(moving);
  EXPECT_EQ(rig.ask(with_controlword(0x004F)).outcome.code, Errc::ok);
  EXPECT_EQ(rig.ask(with_controlword(0x005F)).outcome.code, Errc::busy);
  EXPECT_EQ(rig.count(kControlword, 0x5F), 0U);
}

TEST(EnableNeverMoves, InModeThreeWithAnOldVelocity) {
  Rig rig(KincoType::jd);
  rig.online();
  rig.motor().poke({0x6060, 0}, 3);
  rig.motor().poke({0x60FF, 0}, 500'000);
  rig.stage.run(1200ms);
  ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_FALSE(rig.turns());
  EXPECT_EQ(rig.object(kTargetVelocity), 0);
}

TEST(EnableNeverMoves, InModeFourWithAnOldCurrentOnAnAxisWithoutRatedCurrent) {
  GatewayStage stage({line_of(KincoType::jd, 1)});
  ASSERT_TRUE(stage.come_online());
  stage.drive(0).poke({0x6060, 0}, 4);
  stage.drive(0).poke({0x60F6, 8}, 300);
  stage.run(1200ms);
  ASSERT_EQ(stage.command(1, Command::enable).outcome.code, Errc::ok);
  const auto before = stage.drive(0).position();
  stage.run(500ms);
  EXPECT_EQ(stage.drive(0).position(), before);
}

TEST(EnableNeverMoves, InModeOneWithAnOldTarget) {
  Rig rig(KincoType::md);
  rig.online();
  rig.motor().poke({0x6060, 0}, 1);
  rig.motor().poke({0x607A, 0}, 900'000);
  rig.stage.run(1200ms);
  ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_FALSE(rig.turns());
  EXPECT_EQ(rig.object(kTargetPosition), rig.motor().position());
}

TEST(EnableNeverMoves, InTheFactorysPulseMode) {
  Rig rig(KincoType::jd);
  rig.online();
  ASSERT_EQ(rig.object(kMode), -4);
  ASSERT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_EQ(rig.object(kMode), 1);
  // Unless a client has chosen that mode itself, though it was in force already.
  Rig chosen(KincoType::jd);
  chosen.online();
  ASSERT_EQ(chosen.write(Quantity::mode, -4).outcome.code, Errc::ok);
  ASSERT_EQ(chosen.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_EQ(chosen.object(kMode), -4);
  // Before the drive restarted: what it comes up with nobody has chosen.
  ASSERT_EQ(chosen.command(Command::disable).outcome.code, Errc::ok);
  chosen.stage.link(0).line().restart(0, chosen.stage.link(0).time_of(chosen.stage.runtime().now()));
  ASSERT_TRUE(chosen.stage.run_until([&] { return chosen.axis().link_state == LinkState::offline; }));
  chosen.online();
  ASSERT_EQ(chosen.object(kMode), -4);
  ASSERT_EQ(chosen.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_EQ(chosen.object(kMode), 1);
}

}  // namespace
}  // namespace axisgate::test
