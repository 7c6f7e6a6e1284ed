// SPDX-License-Identifier: Apache-2.0
// What the judge (tests/judged) has found in the gateway: the shortest sequence of each, on every drive that can do it.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kJogSpeed = 45'000;
constexpr std::int64_t kResetFault = 5;

class Found : public testing::TestWithParam<Subject> {
 protected:
  void ready(bool leases = false) {
    plant_.emplace(GetParam(), leases ? with_leases() : PlantOptions{});
    plant_->ready();
  }
  /// Both wait for their answers at once.
  std::pair<Answer, Answer> at_once(const Write& first, const Write& second) {
    const RequestNumber one = plant_->a.begin(first);
    const RequestNumber two = plant_->a.begin(second);
    plant_->stage.run_until([&] { return plant_->a.answer_of(one) && plant_->a.answer_of(two); });
    return {plant_->a.answer_of(one).value_or(Answer{0xFF}), plant_->a.answer_of(two).value_or(Answer{0xFF})};
  }
  void press(Client& client) {
    ASSERT_EQ(client.row(row::jog_velocity, kJogSpeed), kOk);
    ASSERT_EQ(client.coil(coil::jog_forward, false), kOk);
    ASSERT_EQ(client.coil(coil::jog_forward, true), kOk);
    ASSERT_TRUE(plant_->reaches(kJogSpeed, 400ms)) << plant_->velocity();
  }
  std::optional<Plant> plant_;
};

class FoundSpeeds : public Found {};
class FoundPositions : public Found {};
class FoundWithDisable : public Found {};
class FoundRawVelocity : public Found {};
class FoundTurning : public Found {};  // a drive that goes on without its master

// The button's time ended the run of the same client, and the run had the jog's speed.
TEST_P(FoundSpeeds, ARunAfterAJogNeedsNoButtonAndHasItsOwnSpeed) {
  ready();
  Client& a = plant_->a;
  ASSERT_EQ(a.row(row::target_velocity, kOtherSpeed), kOk);
  press(a);
  ASSERT_EQ(a.command(kRun), kOk);
  EXPECT_TRUE(plant_->reaches(kOtherSpeed)) << plant_->velocity();
  plant_->run(2s);
  EXPECT_TRUE(plant_->reaches(kOtherSpeed, 1ms)) << plant_->velocity();
}

TEST_P(FoundSpeeds, ATargetWrittenBesideAJogWaitsForItsRun) {
  ready();
  Client& a = plant_->a;
  press(a);
  ASSERT_EQ(a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(a.coil(coil::jog_forward, true), kOk);
  plant_->run(200ms);
  EXPECT_TRUE(plant_->reaches(kJogSpeed, 1ms)) << plant_->velocity();
  ASSERT_EQ(a.command(kRun), kOk);
  EXPECT_TRUE(plant_->reaches(kSpeed)) << plant_->velocity();
}

// The motor ran at the speed of a jog that had been refused.
TEST_P(FoundSpeeds, ARefusedJogLeavesNoSpeedBehind) {
  ready();
  Client& a = plant_->a;
  ASSERT_EQ(a.row(row::jog_velocity, kJogSpeed), kOk);
  ASSERT_EQ(a.command(kQuickStop), kOk);
  ASSERT_EQ(plant_->b.coil(coil::jog_forward, false), kOk);
  ASSERT_EQ(plant_->b.coil(coil::jog_forward, true), kFailed);
  ASSERT_EQ(a.command(kEnable), kOk);
  EXPECT_EQ(a.command(kRun), kFailed) << "it has no target";
  EXPECT_FALSE(plant_->turns_within(1s)) << plant_->velocity();
}

// Coil 7 = 0 of a client that does not own the axis was refused, and the motor ran on.
TEST_P(FoundSpeeds, AStrangersCoilSevenEndsARun) {
  ready(true);
  Client& a = plant_->a;
  ASSERT_EQ(a.row(row::target_velocity, kSpeed), kOk);
  ASSERT_EQ(a.command(kRun), kOk);
  ASSERT_TRUE(plant_->turns_within(1s));
  EXPECT_EQ(plant_->b.coil(coil::run_velocity, false), kOk);
  EXPECT_TRUE(plant_->comes_to_stand(1500ms)) << plant_->velocity();
  EXPECT_EQ(a.word(shown::owner), kMe);
}

// The set-points beside the stop and the next request waited for each other; both were told 0x0B after 0.9 s.
TEST_P(Found, ABlockWithAStopAndTheNextOneAreBothDone) {
  ready();
  // The stop has set-points beside it that are not in the drive yet.
  std::int64_t speed = 500'000;
  const auto both = [&](std::int64_t command) {
    Rows rows = plant_->endless_target();
    for (const auto& [offset, value] : plant_->profile_rows()) rows[offset] = value;
    if (rows.contains(row::profile_velocity)) rows[row::profile_velocity] = speed -= 10'000;
    rows[row::command] = command;
    return block(row::target_position, row::command_id, rows);
  };
  ASSERT_EQ(plant_->a.write(both(0)), kOk);  // a block on an empty memory only remembers
  const auto [stop, next] = at_once(both(kQuickStop), both(kEnable));
  EXPECT_EQ(stop, kOk);
  EXPECT_EQ(next, kOk);
  if (is_kinco(GetParam()) && !is_md(GetParam())) return;  // its halt of a move is a quick stop, which latches
  const auto [halt, start] = at_once(both(kHalt), both(plant_->endless_command()));
  EXPECT_EQ(halt, kOk);
  EXPECT_EQ(start, kOk);
  EXPECT_TRUE(plant_->keeps_turning());
}

// The controlword was dropped, and the torque stayed on.
TEST_P(FoundWithDisable, ADisablingControlwordBesideAHaltIsNotLost) {
  ready();
  const auto word = [](std::int64_t value, std::int64_t command) {
    return block(row::controlword, row::command_id, {{row::controlword, value}, {row::command, command}});
  };
  ASSERT_EQ(plant_->a.write(word(6, 0)), kOk);
  ASSERT_EQ(plant_->a.write(word(7, kHalt)), kOk);
  plant_->run(500ms);
  EXPECT_EQ(plant_->motor().enabled, false);
}

// An enable of an axis that was enabled already ended the raw run for the gateway, and not for the motor: what was
// written afterwards was answered, kept, and never sent.
TEST_P(FoundRawVelocity, AnEnableInARawRunLeavesItsTargetAlive) {
  ready();
  ASSERT_EQ(plant_->a.row(row::mode, kVelocityMode), kOk);
  ASSERT_EQ(plant_->a.row(row::target_velocity, kOtherSpeed), kOk);
  ASSERT_TRUE(plant_->reaches(kOtherSpeed));
  ASSERT_EQ(plant_->b.command(kEnable), kOk);
  ASSERT_EQ(plant_->a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_TRUE(plant_->reaches(kSpeed)) << plant_->velocity();
}

// As long as the drive had not shown yet that it moves, the stop was answered and nothing was sent.
TEST_P(FoundRawVelocity, CoilSevenEndsARawRunThatHasJustBegun) {
  ready();
  ASSERT_EQ(plant_->a.row(row::mode, kVelocityMode), kOk);
  ASSERT_EQ(plant_->a.row(row::target_velocity, kSpeed), kOk);
  EXPECT_EQ(plant_->a.coil(coil::run_velocity, false), kOk);
  EXPECT_TRUE(plant_->comes_to_stand(1500ms)) << plant_->velocity();
}

// A Leadshine stays in quick stop active: a controlword 6 was never seen to act, told 0x0B, and blocked the next
// enable.
TEST_P(FoundWithDisable, AControlwordSixAfterAQuickStopIsDone) {
  ready();
  ASSERT_EQ(plant_->a.command(kQuickStop), kOk);
  ASSERT_TRUE(plant_->comes_to_stand());
  EXPECT_EQ(plant_->a.row(row::controlword, 6), kOk);
  EXPECT_EQ(plant_->b.command(kEnable), kOk);
  EXPECT_EQ(plant_->motor().enabled, true);
}

// The axis was enabled, nobody owned it, and nothing ran out.
TEST_P(FoundWithDisable, AReleaseBesideAnEnableLeavesALease) {
  plant_.emplace(GetParam(), with_leases());
  plant_->ready_but_disabled();
  const auto [enable, release] = at_once(one(row::command, kEnable), one(row::command, kRelease));
  EXPECT_EQ(enable, kOk);
  EXPECT_EQ(release, kOk);
  plant_->run(2500ms);
  EXPECT_EQ(plant_->motor().enabled, false);
}

// 3.3 Not new: "A single write that asks for what is so already (enable on an enabled axis, the same absolute move to
// the same target) is answered normally": it got 0x06 after somebody's command that had ended nothing.
TEST_P(Found, AnEnableOfAnEnabledAxisIsAnsweredNormally) {
  ready();
  Client &a = plant_->a, &b = plant_->b;
  ASSERT_EQ(a.command(kDisable), kOk);
  ASSERT_EQ(a.command(kEnable), kOk);
  ASSERT_EQ(b.command(kEnable), kOk);
  EXPECT_EQ(a.command(kEnable), kOk);
  EXPECT_EQ(a.coil(coil::enable, true), kOk);
  EXPECT_EQ(b.command(kEnable), kOk);
}

TEST_P(FoundPositions, TheSameMoveToTheSameTargetIsAnsweredNormally) {
  for (const bool under_way : {true, false}) {
    ready();
    Client &a = plant_->a, &b = plant_->b;
    ASSERT_EQ(a.row(row::target_position, under_way ? kFar : 2000), kOk);
    ASSERT_EQ(a.command(kMove), kOk);
    if (!under_way) plant_->run(600ms);
    EXPECT_EQ(a.command(kMove), kOk);
    ASSERT_EQ(b.command(kEnable), kOk);
    EXPECT_EQ(a.command(kMove), kOk) << "after another client's enable";
    ASSERT_EQ(b.command(kResetFault), kOk);
    EXPECT_EQ(a.command(kMove), kOk) << "after another client's fault reset";
    if (!under_way) continue;
    ASSERT_EQ(b.command(kRelative), kNotNow);
    EXPECT_EQ(a.command(kMove), kOk) << "after another client's relative move, which was refused";
  }
}

// What ends it is told as before.
TEST_P(FoundPositions, AMoveThatAnotherClientHasReplacedIsNotNew) {
  ready();
  Client &a = plant_->a, &b = plant_->b;
  ASSERT_EQ(a.row(row::target_position, kFar), kOk);
  ASSERT_EQ(a.command(kMove), kOk);
  ASSERT_EQ(b.row(row::target_position, kAway), kOk);
  ASSERT_EQ(b.command(kMove), kOk);
  EXPECT_EQ(a.command(kMove), kNotNow);
  EXPECT_EQ(a.result(), kNotNew);
}

// The one accepted last is the one that is carried out last.
TEST_P(FoundPositions, AMoveThatCameAfterAnothersIsNotEndedByIt) {
  ready();
  Client &a = plant_->a, &b = plant_->b;
  ASSERT_EQ(a.row(row::target_position, kFar), kOk);
  const RequestNumber first = b.begin(one(row::command, kMove)), second = a.begin(one(row::command, kMove));
  plant_->stage.run_until([&] { return b.answer_of(first) && a.answer_of(second); });
  ASSERT_EQ(b.answer_of(first).value_or(Answer{0xFF}), kOk);
  ASSERT_EQ(a.answer_of(second).value_or(Answer{0xFF}), kOk);
  EXPECT_EQ(a.command(kMove), kOk);
  EXPECT_EQ(b.command(kMove), kNotNow);
}

// 3.3: 0x03 says that a value is wrong. As long as the drive's own limits and scales are not known nobody knows that.
TEST_P(Found, NoValueIsCalledWrongBeforeTheDriveIsKnown) {
  constexpr std::uint8_t kNoPath = 0x0A;
  for (const bool there : {true, false}) {
    ready();
    Rows rows = plant_->profile_rows();
    rows.merge(plant_->endless_target());
    plant_->crash_gateway();
    if (!there) plant_->cut_wire();
    plant_->start_gateway();
    plant_->a.connect();
    for (Duration moment{}; moment < 600ms; moment += 7ms, plant_->run(7ms))
      for (const auto& [offset, value] : rows) {
        const Answer answer = plant_->a.row(offset, value);
        ASSERT_TRUE((there && answer == kOk) || answer == kNotNow || answer == kNoPath)
            << "row " << offset << " after " << moment / 1ms << " ms: " << testing::PrintToString(answer);
      }
    const Answer jog = plant_->a.coil(coil::jog_forward, false);
    EXPECT_NE(jog, kBadValue) << testing::PrintToString(jog);
  }
}

// Command 13 gives the lease back: what stands beside it in the request takes none.
TEST_P(Found, AReleaseBesideSetpointsTakesNoLease) {
  const auto release = [this](std::int64_t value) {
    Rows rows = plant_->endless_target();
    rows.begin()->second = value;
    rows[row::command] = kRelease;
    return block(rows.begin()->first, row::command, rows);
  };
  plant_.emplace(GetParam(), with_leases());
  plant_->ready_but_disabled();
  Client &a = plant_->a, &b = plant_->b;
  ASSERT_EQ(a.command(0), kOk);
  EXPECT_EQ(a.write(release(1000)), kOk);
  EXPECT_EQ(b.word(shown::owner), kNobody);
  // One that fails, too.
  ASSERT_EQ(a.command(0), kOk);
  plant_->cut_wire();
  EXPECT_EQ(a.write(release(2000)).ok(), is_keya(GetParam())) << "a Keya is not asked while it is disabled";
  EXPECT_EQ(b.word(shown::owner), kNobody);
  plant_->mend_wire();
  plant_->run(4s);
  // An owner's lease is given back.
  ASSERT_EQ(a.command(0), kOk);
  ASSERT_EQ(plant_->set_endless(a), kOk);
  ASSERT_EQ(b.word(shown::owner), kAnother);
  EXPECT_EQ(a.write(release(3000)), kOk);
  EXPECT_EQ(b.word(shown::owner), kNobody);
  // Another's is not.
  ASSERT_EQ(plant_->set_endless(b), kOk);
  ASSERT_EQ(a.command(0), kOk);
  EXPECT_EQ(a.write(release(4000)), kNotNow);
  EXPECT_EQ(b.word(shown::owner), kMe);
}

// 3.5 Signs of life: "an orphan lease is taken over by any write ... of the same address and role, whatever it asks".
TEST_P(Found, AReleaseGivesBackWhatTheConnectionBeforeHasLeft) {
  for (const bool alone : {true, false}) {
    plant_.emplace(GetParam(), with_leases());
    plant_->ready_but_disabled();
    Client &a = plant_->a, &b = plant_->b;
    ASSERT_EQ(plant_->set_endless(a), kOk);
    a.disconnect();
    a.connect();
    ASSERT_EQ(b.word(shown::owner), kAnother);
    if (!alone) {
      ASSERT_EQ(a.command(0), kOk);
    }
    Rows rows = plant_->endless_target();
    rows[row::command] = kRelease;
    EXPECT_EQ(alone ? a.command(kRelease) : a.write(block(rows.begin()->first, row::command, rows)), kOk);
    EXPECT_EQ(b.word(shown::owner), kNobody);
  }
}

// The axis is enabled and nobody's: its time runs on, whoever writes beside a release.
TEST_P(FoundWithDisable, AReleaseBesideSetpointsDoesNotProlongAnOpenLease) {
  ready(true);
  Client& a = plant_->a;
  std::int64_t value = 1000;
  for (int i = 0; i < 8; ++i, value += 1000) {
    ASSERT_EQ(a.command(0), kOk);
    Rows rows = plant_->endless_target();
    rows.begin()->second = value;
    rows[row::command] = kRelease;
    ASSERT_EQ(a.write(block(rows.begin()->first, row::command, rows)), kOk) << i;
    plant_->run(300ms);
    if (plant_->b.word(shown::axis_state) == kStopLatched) return;
  }
  ADD_FAILURE() << "nothing has run out";
}

INSTANTIATE_TEST_SUITE_P(Every, FoundPositions, testing::ValuesIn(subjects(has_positions)), named);
INSTANTIATE_TEST_SUITE_P(Every, Found, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, FoundSpeeds, testing::ValuesIn(subjects(has_speeds)), named);
INSTANTIATE_TEST_SUITE_P(Every, FoundWithDisable,
                         testing::ValuesIn(subjects([](Subject s) { return s != Subject::id286pro; })), named);
// Nobody tells a new gateway that an iD286pro runs, and does not move: both were answered as done, and it ran on.
TEST_P(FoundTurning, ByANewGatewayIsStoppedByCoil7AndByATargetVelocityOf0) {
  for (const Write& stop : {one_coil(coil::run_velocity, false), one(row::target_velocity, 0)}) {
    SCOPED_TRACE(text(stop));
    ready();
    ASSERT_EQ(plant_->set_endless(plant_->a), kOk);
    ASSERT_EQ(plant_->a.command(kRun), kOk);
    ASSERT_TRUE(plant_->turns_within(1s));
    plant_->crash_gateway();
    plant_->run(100ms);
    plant_->start_gateway();
    ASSERT_TRUE(plant_->stage.run_until([&] { return plant_->stage.axis(1).link_state == LinkState::online; }));
    plant_->run(300ms);
    ASSERT_NE(plant_->velocity(), 0);
    const auto client = plant_->connection_from(77);
    EXPECT_EQ(client->write(stop), kOk);
    EXPECT_TRUE(plant_->comes_to_stand()) << plant_->velocity();
  }
}

INSTANTIATE_TEST_SUITE_P(Every, FoundTurning,
                         testing::ValuesIn(subjects([](Subject s) { return has_speeds(s) && !minds_silence(s); })),
                         named);
INSTANTIATE_TEST_SUITE_P(Every, FoundRawVelocity,
                         testing::ValuesIn(subjects([](Subject s) { return is_cia402(s) && has_speeds(s); })), named);

}  // namespace
}  // namespace axisgate::test::obey
