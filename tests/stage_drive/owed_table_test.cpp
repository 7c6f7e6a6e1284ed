// SPDX-License-Identifier: Apache-2.0
// What each motor on each protocol does with a stop that was asked for while its wire was cut, with a jog whose button
// was let go meanwhile, and with a lease that ran out: it stands, and stays where it is until it is enabled anew.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/stage_drive/owned_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

std::string in_ms(Duration time) { return std::to_string(time / 1ms) + "ms"; }

// --- A stop that was asked for ---------------------------------------------------------------------------------------

class StopInAGap : public testing::TestWithParam<std::tuple<Subject, Cut, Duration, Command>> {};

TEST_P(StopInAGap, StopsTheMotorAfterIt) {
  const auto& [subject, cut, gap, stop] = GetParam();
  OwnedRig axis(subject);
  axis.set_moving();
  axis.cut(cut);
  axis.run(20ms);
  const auto answer = axis.rig.stage.begin(1, with_command(stop));
  axis.run(gap);
  axis.mend();
  ASSERT_TRUE(axis.comes_to_rest());
  ASSERT_TRUE(axis.rig.stage.come_online());
  EXPECT_TRUE(axis.stays_at_rest());
  ASSERT_TRUE(answer->has_value());
  if (cut == Cut::reported) {
    EXPECT_EQ((*answer)->outcome.code, Errc::offline) << "nothing was sent";
  }
  if (stop == Command::quick_stop) {
    EXPECT_TRUE(axis.latched());
  }
  if (stop == Command::disable && subject != Subject::id286pro) {
    EXPECT_FALSE(axis.rig.powered());
  }
  axis.expect_usable();
}

INSTANTIATE_TEST_SUITE_P(Table, StopInAGap,
                         testing::Combine(testing::ValuesIn(kSubjects), testing::ValuesIn(kCuts),
                                          testing::Values(300ms, 950ms, 3s, 30s),
                                          testing::Values(Command::quick_stop, Command::halt, Command::disable)),
                         [](const auto& case_of) {
                           return name(std::get<0>(case_of.param)) + "_" + name(std::get<1>(case_of.param)) + "_" +
                                  in_ms(std::get<2>(case_of.param)) + "_" +
                                  std::string(text(std::get<3>(case_of.param)));
                         });

class Returning : public testing::TestWithParam<std::tuple<Subject, Cut>> {
 protected:
  [[nodiscard]] bool back() {
    const LinkState link = axis.rig.axis().link_state;
    return link != LinkState::offline && link != LinkState::link_down;
  }
  OwnedRig axis{std::get<Subject>(GetParam())};
};

TEST_P(Returning, OwedAStopItTakesNothingElseUntilItWasSeenToStop) {
  axis.set_moving();
  axis.cut(std::get<Cut>(GetParam()));
  const auto answer = axis.rig.stage.begin(1, with_command(Command::quick_stop));
  axis.run(800ms);
  axis.mend();
  ASSERT_TRUE(axis.rig.stage.run_until([&] { return back(); }));
  const auto motion = axis.rig.stage.begin(1, axis.rig.motion());
  const auto enable = axis.rig.stage.begin(1, with_command(Command::enable));
  const auto mode = axis.rig.stage.begin(1, setpoints({{Quantity::profile_acceleration, 100'000}}));
  for (const auto& each : {motion, enable, mode}) {
    ASSERT_TRUE(each->has_value());
    EXPECT_EQ(command_result((*each)->outcome.code), CommandResult::state_unsuitable);
    EXPECT_EQ(modbus_exception((*each)->outcome.code), ModbusException::server_device_busy);
  }
  ASSERT_TRUE(axis.comes_to_rest());
  axis.expect_usable();
}

TEST_P(Returning, ADriveThatHasRestartedStaysWithoutTorqueAndLatched) {
  axis.set_moving();
  axis.cut(std::get<Cut>(GetParam()));
  const auto answer = axis.rig.stage.begin(1, with_command(Command::quick_stop));
  axis.run(500ms);
  axis.rig.restart_the_drive();
  axis.run(3s);
  axis.mend();
  ASSERT_TRUE(axis.rig.stage.come_online());
  EXPECT_TRUE(axis.stays_at_rest());
  EXPECT_FALSE(axis.rig.powered());
  EXPECT_TRUE(axis.latched());
  axis.expect_usable();
}

INSTANTIATE_TEST_SUITE_P(Table, Returning, testing::Combine(testing::ValuesIn(kSubjects), testing::ValuesIn(kCuts)),
                         [](const auto& case_of) {
                           return name(std::get<0>(case_of.param)) + "_" + name(std::get<1>(case_of.param));
                         });

// --- A lease that ran out --------------------------------------------------------------------------------------------

class LeaseInAGap : public testing::TestWithParam<std::tuple<Subject, Cut, LeaseAction>> {
 protected:
  static constexpr Duration kGap = 1500ms;
  [[nodiscard]] static LeaseRules lease(Duration timeout) {
    return {.timeout = timeout, .on_expiry = std::get<LeaseAction>(GetParam())};
  }
  [[nodiscard]] static Subject subject() { return std::get<Subject>(GetParam()); }
  [[nodiscard]] static Cut cut() { return std::get<Cut>(GetParam()); }
};

TEST_P(LeaseInAGap, ItsEndStopsTheMotorAfterTheGap) {
  OwnedRig axis(subject(), lease(500ms));
  axis.set_moving();
  axis.cut(cut());
  axis.run(kGap, false);
  EXPECT_TRUE(axis.latched()) << "when the lease ends, not when the stop is sent";
  axis.mend();
  ASSERT_TRUE(axis.comes_to_rest());
  ASSERT_TRUE(axis.rig.stage.come_online());
  EXPECT_TRUE(axis.stays_at_rest());
  EXPECT_TRUE(axis.latched());
}

TEST_P(LeaseInAGap, WhileItRunsOnTheMotorGoesOnAndIsShownAsAdopted) {
  OwnedRig axis(subject(), lease(2s));
  axis.set_moving();
  axis.cut(cut());
  const Duration gap = axis.short_gap(cut());
  axis.run(gap);
  axis.mend();
  ASSERT_TRUE(axis.rig.stage.come_online());
  EXPECT_FALSE(axis.latched());
  if (!has_command_watchdog(subject())) {
    EXPECT_TRUE(axis.adopted() || gap < 800ms) << "it may never have been offline";
    axis.run(3s);
    EXPECT_TRUE(axis.rig.turns());
  }
  axis.run(2500ms, false);
  EXPECT_TRUE(axis.comes_to_rest()) << "its owner is still asked for";
}

INSTANTIATE_TEST_SUITE_P(Table, LeaseInAGap,
                         testing::Combine(testing::ValuesIn(kSubjects), testing::ValuesIn(kCuts),
                                          testing::Values(LeaseAction::quick_stop, LeaseAction::halt)),
                         [](const auto& case_of) {
                           return name(std::get<0>(case_of.param)) + "_" + name(std::get<1>(case_of.param)) + "_" +
                                  name(std::get<2>(case_of.param));
                         });

// --- A jog -----------------------------------------------------------------------------------------------------------

class JogInAGap : public testing::TestWithParam<std::tuple<Subject, Cut, bool>> {
 protected:
  static constexpr Duration kGap = 800ms;  // jog_timeout is 500 ms
  JogInAGap() : axis(std::get<Subject>(GetParam()), lease()) {
    EXPECT_EQ(axis.command(Command::enable), Errc::ok);
    WriteBatch speed;
    speed.jog_velocity = 300'000;
    EXPECT_EQ(axis.ask(speed), Errc::ok);
    EXPECT_EQ(axis.command(Command::jog_forward), Errc::ok);
    hold(1s);
    EXPECT_TRUE(axis.rig.turns());
    axis.cut(std::get<Cut>(GetParam()));
  }
  static std::optional<LeaseRules> lease() {
    return std::get<bool>(GetParam()) ? std::optional(LeaseRules{.timeout = 5s}) : std::nullopt;
  }
  /// The panel goes on writing 1.
  void hold(Duration time) {
    for (Duration done{}; done < time; done += 100ms) {
      WriteBatch again;
      again.jog_again = Command::jog_forward;
      // not_new: the drive's own watchdog has ended the jog, and the button is held in vain.
      EXPECT_THAT(axis.ask(again), testing::AnyOf(Errc::ok, Errc::not_new));
      axis.run(100ms);
    }
  }
  void expect_stopped() {
    ASSERT_TRUE(axis.comes_to_rest());
    ASSERT_TRUE(axis.rig.stage.come_online());
    EXPECT_TRUE(axis.stays_at_rest());
  }
  OwnedRig axis;
};

TEST_P(JogInAGap, APanelThatFellSilentHasLetGo) {
  axis.run(kGap);
  axis.mend();
  expect_stopped();
}

TEST_P(JogInAGap, AButtonLetGoInItStopsTheMotorAfterIt) {
  hold(300ms);
  static_cast<void>(axis.rig.stage.begin(1, [this] {
    WriteBatch end = with_command(Command::jog_end);
    end.client = axis.owner->id;
    end.life = axis.owner;
    return end;
  }()));
  axis.run(kGap - 300ms);
  axis.mend();
  expect_stopped();
}

TEST_P(JogInAGap, AButtonHeldAllTheTimeStillStopsTheMotorWhenItIsLetGo) {
  const Duration gap = axis.short_gap(std::get<Cut>(GetParam()));
  hold(gap);
  axis.mend();
  hold(3s);
  if (!has_command_watchdog(std::get<Subject>(GetParam()))) {
    EXPECT_TRUE(axis.rig.turns()) << "neither lease nor button has ended";
    EXPECT_TRUE(axis.adopted() || gap < kGap) << "it may never have been offline";
  }
  hold(200ms);
  static_cast<void>(axis.command(Command::jog_end));
  expect_stopped();
}

TEST_P(JogInAGap, AButtonHeldAllTheTimeAndAPanelThatFallsSilentAfterItStopTheMotor) {
  hold(axis.short_gap(std::get<Cut>(GetParam())));
  axis.mend();
  hold(3s);
  axis.run(600ms);
  expect_stopped();
}

INSTANTIATE_TEST_SUITE_P(Table, JogInAGap,
                         testing::Combine(testing::ValuesIn(subjects(has_speeds)), testing::ValuesIn(kCuts),
                                          testing::Bool()),
                         [](const auto& case_of) {
                           return name(std::get<0>(case_of.param)) + "_" + name(std::get<1>(case_of.param)) +
                                  (std::get<2>(case_of.param) ? "_leased" : "_unleased");
                         });

}  // namespace
}  // namespace axisgate::test
