// SPDX-License-Identifier: Apache-2.0
// A drive that disables itself when it hears no command for a second: it is commanded again and again while somebody
// answers for its axis, with nothing that could move it anew, and not a moment longer.
#include <gmock/gmock.h>

#include "gateway/drive/device/keep_alive.hpp"
#include "tests/stage_drive/keya_rig.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::Each;
using testing::IsEmpty;

class KeyaKeepAlive : public testing::TestWithParam<Speech> {
 protected:
  [[nodiscard]] KeyaOptions options(std::int16_t mode = 3) const {
    return {.speech = GetParam(), .modes = {mode}, .keep_alive = kKeepAlivePeriod};
  }
};
INSTANTIATE_TEST_SUITE_P(Speeches, KeyaKeepAlive, testing::Values(Speech::single, Speech::composed),
                         [](const auto& p) { return p.param == Speech::single ? "single" : "composed"; });

TEST_P(KeyaKeepAlive, ARunningMotorGoesOnAtItsSpeedAsLongAsNobodyStopsIt) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  rig.mark();
  rig.motor(0).moves.clear();
  rig.run(20s);
  EXPECT_TRUE(rig.motor(0).enabled);
  EXPECT_TRUE(rig.enabled(0));
  EXPECT_THAT(rig.motor(0).moves, Each(kRaw150));
  EXPECT_LE(longest_gap(rig.heard(1)), kKeepAlivePeriod);
  EXPECT_LE(rig.writes().size(), 100U) << "at half its period, no oftener";
  EXPECT_EQ(rig.motor(0).enables, 1);
  EXPECT_EQ(rig.motor(1).enables, 0);
}

// Its run has ended for good (3.4): a speed that is repeated would start it again.
TEST_P(KeyaKeepAlive, AMotorThatAnotherMasterEnablesIsNotGivenTheSpeedOfBefore) {
  for (const Duration apart : {20ms, 200ms, 3000ms}) {
    SCOPED_TRACE(apart / 1ms);
    KeyaRig rig(options());
    rig.online();
    rig.enable_and_run(0);
    rig.motor(0).enabled = false;
    ASSERT_TRUE(rig.run_until([&] { return !rig.enabled(0); }, 1s));
    rig.run(apart);
    rig.motor(0).moves.clear();
    rig.motor(0).enabled = true;
    rig.run(3s);
    EXPECT_THAT(rig.motor(0).moves, IsEmpty());
  }
}

TEST_P(KeyaKeepAlive, APositionIsRepeatedWhichMovesNothing) {
  KeyaRig rig(options(1));
  rig.online();
  rig.enable(0);
  ASSERT_EQ(KeyaRig::code(rig.ask(0, KeyaRig::batch_of(Command::move_absolute, {{Quantity::target_position, 30'000}}))),
            Errc::ok);
  rig.run(3s);
  EXPECT_TRUE(rig.motor(0).enabled);
  EXPECT_EQ(rig.motor(0).position, 30'000);
  ASSERT_EQ(
      KeyaRig::code(rig.ask(0, KeyaRig::batch_of(Command::move_absolute, {{Quantity::target_position, 3'000'000}}))),
      Errc::ok);
  rig.run(100ms);
  ASSERT_EQ(KeyaRig::code(rig.command(0, Command::halt)), Errc::ok);
  const double stopped = rig.motor(0).position;
  EXPECT_LT(stopped, 1'000'000);
  rig.run(3s);
  EXPECT_TRUE(rig.motor(0).enabled);
  EXPECT_NEAR(rig.motor(0).position, stopped, 50'000) << "a halted move is not taken up again";
}

TEST_P(KeyaKeepAlive, AModeThatIsNotListedIsLeftToTheDrivesWatchdog) {
  KeyaRig rig(options(4));
  rig.online();
  rig.enable(0);
  rig.mark();
  rig.run(2s);
  EXPECT_THAT(rig.writes(), IsEmpty());
  EXPECT_FALSE(rig.motor(0).enabled);
  EXPECT_FALSE(rig.enabled(0));
}

TEST_P(KeyaKeepAlive, WritesOfClientsTakeItsPlace) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  rig.mark();
  for (int i = 1; i <= 30; ++i) {
    ASSERT_EQ(KeyaRig::code(rig.write(0, Quantity::target_velocity, i * 15'000)), Errc::ok);
    rig.run(150ms);
  }
  EXPECT_EQ(rig.writes().size(), 30U);
}

TEST_P(KeyaKeepAlive, NoResultAndNoOtherTraceOfItIsShownToClients) {
  KeyaRig rig(options());
  rig.online();
  rig.enable(0);
  WriteBatch run = KeyaRig::batch_of(Command::run_velocity, {{Quantity::target_velocity, kRpm150}});
  run.command_id = 77;
  ASSERT_EQ(KeyaRig::code(rig.ask(0, run)), Errc::ok);
  rig.run(300ms);
  const auto latest = rig.axis(0).latest;
  const std::uint16_t motion = rig.axis(0).motion_id;
  rig.mark();
  rig.run(5s);
  EXPECT_GE(rig.writes().size(), 10U);
  EXPECT_EQ(rig.axis(0).latest, latest);
  EXPECT_EQ(rig.axis(0).motion_id, motion);
  rig.mark();
  EXPECT_EQ(KeyaRig::code(rig.write(0, Quantity::target_velocity, kRpm150)), Errc::ok);
  EXPECT_THAT(rig.since_mark(), IsEmpty()) << "what the drive holds is answered without the wire";
}

TEST_P(KeyaKeepAlive, AMotorThatHasTrippedIsSentNothingMore) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  for (const int at : {0, 100, 249}) {
    rig.run(std::chrono::milliseconds(at));
    rig.motor(0).enabled = false;
    rig.motor(0).faults = 0x0040;
    const int enables = rig.motor(0).enables;
    rig.run(3s);
    EXPECT_EQ(rig.motor(0).enables, enables);
    rig.motor(0).faults = 0;
    rig.run(3s);
    EXPECT_EQ(rig.motor(0).enables, enables) << "nor when its fault has gone by itself";
    rig.enable_and_run(0);
  }
}

// Where one frame carries the enable of both motors, the state is looked at by the very exchange before it.
TEST(KeyaKeepAliveFrame, RightBeforeItTheStateIsAskedFor) {
  KeyaRig rig({.speech = Speech::composed, .keep_alive = kKeepAlivePeriod});
  rig.online();
  rig.enable_and_run(0);
  rig.mark();
  rig.run(5s);
  const auto sent = rig.since_mark();
  std::size_t frames = 0;
  for (std::size_t i = 1; i < sent.size(); ++i) {
    if (sent[i].exchange.access != bus::Access::write) continue;
    ++frames;
    EXPECT_EQ(sent[i - 1].exchange.object.index, kFaultQuery);
    EXPECT_EQ(sent[i - 1].exchange.more.size(), 1U) << "of both motors";
  }
  EXPECT_GE(frames, 10U);
}

TEST(KeyaKeepAliveFrame, AMotorThatTripsAnInstantBeforeIsNotTurnedOnAgain) {
  KeyaRig rig({.speech = Speech::composed, .keep_alive = kKeepAlivePeriod});
  rig.online();
  rig.enable_and_run(0);
  rig.enable_and_run(1);
  // Every query but that of the state is answered while B trips right before the look.
  rig.mark();
  ASSERT_TRUE(rig.run_until([&] { return !rig.writes().empty(); }));
  rig.motor(1).enabled = false;
  const int enables = rig.motor(1).enables;
  rig.run(3s);
  EXPECT_EQ(rig.motor(1).enables, enables);
  EXPECT_TRUE(rig.motor(0).enabled) << "the other one is kept";
}

TEST_P(KeyaKeepAlive, AStopThatWaitsOrIsUnderWayEndsIt) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  ASSERT_TRUE(rig.run_until([&] { return rig.motor(0).moves.size() > 6; })) << "repeated some times";
  rig.motor(0).moves.clear();
  rig.run(249ms);
  const auto stop = rig.begin(0, KeyaRig::batch_of(Command::quick_stop));
  rig.run(2s);
  ASSERT_TRUE(stop->has_value());
  const auto& moves = rig.motor(0).moves;
  const auto first_zero = std::find(moves.begin(), moves.end(), 0);
  EXPECT_TRUE(std::all_of(first_zero, moves.end(), [](std::int64_t value) { return value == 0; }));
  EXPECT_FALSE(rig.motor(0).enabled);
}

TEST(KeyaKeepAliveSingle, AMotorThatIsSlowToTurnOffIsNotToldItsSpeedWhileItIsToldTo) {
  KeyaRig rig({.keep_alive = kKeepAlivePeriod});
  rig.online();
  rig.enable_and_run(0);
  rig.wire->acted = [&](const bus::Exchange& e) {
    if (e.object.index == kDisable) rig.motor(0).enabled = true;
  };
  rig.motor(0).moves.clear();
  const auto stop = rig.begin(0, KeyaRig::batch_of(Command::disable));
  ASSERT_TRUE(rig.run_until([&] { return stop->has_value(); }));
  EXPECT_THAT(rig.motor(0).moves, Each(0));
  rig.run(3s);
  EXPECT_THAT(rig.motor(0).moves, Each(0)) << "between two attempts of the stop, which is owed by now";
}

TEST(KeyaKeepAliveSingle, AnUnsureSetPointIsNotRepeated) {
  KeyaRig rig({.keep_alive = kKeepAlivePeriod});
  rig.online();
  rig.enable_and_run(0);
  rig.wire->fate = [](const bus::Exchange& e) {
    return e.access == bus::Access::write ? Fate::reply_lost : Fate::answered;
  };
  EXPECT_EQ(KeyaRig::code(rig.write(0, Quantity::target_velocity, 2 * kRpm150)), Errc::timed_out);
  rig.wire->fate = {};
  rig.mark();
  rig.run(3s);
  EXPECT_THAT(rig.writes(), IsEmpty()) << "neither the old nor the new one";
  EXPECT_FALSE(rig.motor(0).enabled) << "by its watchdog";
}

TEST(KeyaKeepAliveSingle, ALostRepetitionIsTriedAgainInTime) {
  KeyaRig rig({.keep_alive = kKeepAlivePeriod});
  rig.online();
  rig.enable_and_run(0);
  int left = 2;
  rig.wire->fate = [&](const bus::Exchange& e) {
    return e.access == bus::Access::write && left-- > 0 ? Fate::muted : Fate::answered;
  };
  rig.mark();
  rig.run(3s);
  EXPECT_TRUE(rig.motor(0).enabled);
  EXPECT_GE(rig.writes().size(), 6U);
}

TEST(KeyaKeepAliveSingle, ARefusedRepetitionIsNotTriedAgainAtOnce) {
  KeyaRig rig({.keep_alive = kKeepAlivePeriod});
  rig.online();
  rig.enable_and_run(0);
  rig.wire->fate = [](const bus::Exchange& e) {
    return e.access == bus::Access::write ? Fate::refused : Fate::answered;
  };
  rig.mark();
  rig.run(900ms);
  EXPECT_GE(rig.writes().size(), 2U);
  EXPECT_LE(rig.writes().size(), 20U);
}

TEST_P(KeyaKeepAlive, ADriveFoundEnabledIsNotKeptSo) {
  KeyaRig rig(options());
  rig.motor(0).enabled = true;
  rig.motor(0).value = 3'000;
  rig.motor(0).commanded = rig.runtime.now();
  rig.online();
  rig.mark();
  rig.run(3s);
  EXPECT_THAT(rig.writes(), IsEmpty());
  EXPECT_FALSE(rig.motor(0).enabled) << "its master is gone, and it knows";
}

TEST_P(KeyaKeepAlive, ASilentDriveIsSentNothing) {
  KeyaRig rig(options());
  rig.online();
  rig.enable_and_run(0);
  rig.wire->fate = [](const bus::Exchange& e) { return e.access == bus::Access::read ? Fate::muted : Fate::answered; };
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(0).link_state == LinkState::suspect; }));
  rig.mark();
  rig.run(5s);
  EXPECT_THAT(rig.writes(), IsEmpty());
}

// --- The rule alone ------------------------------------------------------------------------------------------------

TEST(KeepAliveRule, IsDueAtHalfThePeriodAfterTheNewestControlWriteOfItsMotor) {
  const model::DriveModel model = keya_model({.keep_alive = kKeepAlivePeriod});
  const auto find = [&](const std::string& name) {
    const auto at =
        std::find_if(model.objects.begin(), model.objects.end(), [&](const auto& o) { return o.name == name; });
    return static_cast<model::ObjectId>(at - model.objects.begin());
  };
  drive::KeepAlive keep(model);
  const Instant start = Instant{} + 1h;
  keep.written(find("A.velocity"), start);
  keep.written(find("B.velocity"), start + 100ms);
  EXPECT_EQ(keep.due(0), start + kKeepAlivePeriod / 2);
  EXPECT_EQ(keep.due(1), start + 100ms + kKeepAlivePeriod / 2);
  keep.failed(0, start + kKeepAlivePeriod / 2);
  EXPECT_GT(keep.due(0), start + kKeepAlivePeriod / 2);
  EXPECT_LT(keep.due(0), start + kKeepAlivePeriod);
  keep.reset();
  EXPECT_EQ(keep.due(0), kLongAgo);
}

TEST(KeepAliveRule, AFrameOfBothMotorsCountsForBoth) {
  const model::DriveModel model = keya_model({.speech = Speech::composed, .keep_alive = kKeepAlivePeriod});
  drive::KeepAlive keep(model);
  const Instant start = Instant{} + 1h;
  keep.written(model.composed.front(), start);
  EXPECT_EQ(keep.due(0), start + kKeepAlivePeriod / 2);
  EXPECT_EQ(keep.due(1), start + kKeepAlivePeriod / 2);
}

// 3.4: "A fault ... end[s] every motion for good": a drive that goes on by itself once the cause is gone is disabled.
TEST_P(KeyaKeepAlive, AFaultThatPassesByItselfLeavesNoTorque) {
  KeyaRig rig({.speech = GetParam()});
  rig.online();
  rig.enable_and_run(0);
  rig.motor(0).faults = 0x0040;
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(0).has(AxisInput::fault); }));
  EXPECT_TRUE(rig.motor(0).enabled);
  rig.motor(0).faults = 0;
  EXPECT_TRUE(rig.run_until([&] { return !rig.motor(0).enabled; }));
  rig.run(1s);
  EXPECT_FALSE(rig.motor(0).enabled);
  EXPECT_FALSE(rig.enabled(0));
}

}  // namespace
}  // namespace axisgate::test
