// SPDX-License-Identifier: Apache-2.0
// 3.4 Stops: one acts if the command or the id differs from what is remembered, on an empty memory too, and in a
// single write always.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class Stops : public testing::TestWithParam<Subject> {
 protected:
  Stops() { plant_.ready(); }
  /// By ids, as a PLC's program does it; the last id is 2.
  void start_with_ids() {
    ASSERT_EQ(a_.command(0, 1), kOk);
    ASSERT_EQ(plant_.set_endless(a_), kOk);
    ASSERT_EQ(a_.command(plant_.endless_command(), 2), kOk);
    ASSERT_TRUE(plant_.keeps_turning());
  }
  void stopped_and_latched() {
    EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    plant_.run(300ms);
    EXPECT_EQ(a_.word(shown::axis_state), kStopLatched);
  }
  Plant plant_{GetParam()};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
};

TEST_P(Stops, WithTheIdOfTheCommandBefore) {
  for (const std::int64_t stop : {kHalt, kQuickStop, kDisable}) {
    SCOPED_TRACE(stop);
    ASSERT_EQ(b_.command(0), kOk);
    ASSERT_EQ(b_.command(kEnable), kOk);
    start_with_ids();
    EXPECT_EQ(a_.command(stop, 2), kOk);
    EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    plant_.run(300ms);
    if (stop != kDisable) {
      EXPECT_EQ(a_.word(shown::axis_state), stop == kHalt ? kStandstill : kStopLatched);
    }
    EXPECT_TRUE(stop != kDisable || !plant_.motor().enabled.value_or(false));
  }
}

TEST_P(Stops, OfTheSameQuickStopWithAnotherId) {
  start_with_ids();
  ASSERT_EQ(a_.command(kQuickStop, 3), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(b_.command(kEnable), kOk);
  ASSERT_TRUE(plant_.start_endless(b_));
  EXPECT_EQ(a_.command(kQuickStop, 4), kOk);
  stopped_and_latched();
}

TEST_P(Stops, ThatAScannerRepeatsDoNotStopWhatComesLater) {
  start_with_ids();
  ASSERT_EQ(a_.command(kQuickStop, 3), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(b_.command(kEnable), kOk);
  ASSERT_TRUE(plant_.start_endless(b_));
  plant_.scan(a_, block(row::command, row::command_id, {{row::command, kQuickStop}, {row::command_id, 3}}), 500ms);
  EXPECT_TRUE(plant_.keeps_turning());
}

TEST_P(Stops, OfAClientThatHasWrittenNothingBefore) {
  constexpr std::int64_t kSomeId = 77;
  const std::vector<std::pair<const char*, Write>> ways{
      {"with an id", block(row::command, row::command_id, {{row::command, kQuickStop}, {row::command_id, kSomeId}})},
      {"in a block without an id", block(row::command, row::command_id, {{row::command, kQuickStop}})},
      {"in a block 40 to 56", block(row::controlword, row::heartbeat, {{row::command, kQuickStop}})},
      {"by FC 23", block(row::command, row::command, {{row::command, kQuickStop}}, fc::read_write)},
      {"alone", one(row::command, kQuickStop)},
      {"by FC 22", one(row::command, kQuickStop, fc::mask_write)},
      {"by its coil", one_coil(coil::quick_stop, true)},
      {"in a row of coils", coil_block(coil::enable, {0, 0, 1, 0})},
  };
  std::uint8_t host = 100;
  for (const auto& [way, write] : ways) {
    SCOPED_TRACE(way);
    ASSERT_EQ(a_.command(0), kOk);
    ASSERT_EQ(a_.command(kEnable), kOk);
    ASSERT_TRUE(plant_.start_endless(a_));
    plant_.run(200ms);
    const auto stranger = plant_.connection_from(host++);
    EXPECT_EQ(stranger->write(write), kOk);
    EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    plant_.run(300ms);
    EXPECT_EQ(a_.word(shown::axis_state), kStopLatched);
  }
}

// 3.4: a controlword that takes the torque; what a scanner's block has carried all the time is no reason to ignore it.
TEST_P(Stops, ByASingleWordAlsoWhereABlockOfTheSameClientCarriesIt) {
  ASSERT_EQ(a_.command(0), kOk);
  ASSERT_EQ(a_.command(kEnable), kOk);
  Rows rows = plant_.endless_target();
  rows.merge(plant_.profile_rows());
  rows[row::command] = plant_.endless_command();
  rows[row::command_id] = 7;
  ASSERT_EQ(a_.command(0, 6), kOk);
  const Write scanned = block(row::controlword, row::heartbeat, rows);
  ASSERT_EQ(a_.write(scanned), kOk);
  ASSERT_TRUE(plant_.turns_within(1s));
  for (int i = 0; i < 10; ++i) {
    plant_.run(50ms);
    ASSERT_EQ(a_.write(scanned), kOk);
  }
  EXPECT_EQ(a_.row(row::controlword, 0), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
}

TEST_P(Stops, AlwaysInASingleWrite) {
  const std::vector<Write> ways{one(row::command, kQuickStop), one(row::command, kQuickStop, fc::mask_write),
                                one_coil(coil::quick_stop, true), one_coil(coil::quick_stop, true, fc::write_coils),
                                one_coil(coil::halt, true)};
  for (const Write& way : ways) {
    SCOPED_TRACE(text(way));
    for (int time = 0; time < 2; ++time) {
      ASSERT_EQ(a_.command(0), kOk);
      ASSERT_EQ(a_.command(kEnable), kOk);
      ASSERT_EQ(a_.coil(coil::halt, false), kOk);
      ASSERT_TRUE(plant_.start_endless(a_));
      EXPECT_EQ(b_.write(way), kOk);
      EXPECT_TRUE(plant_.comes_to_stand()) << "time " << time << ": " << plant_.velocity();
    }
  }
}

// What was asked for last is what register 25 tells of, whichever ends first.
TEST_P(Stops, ThatEndAfterALaterCommandWasRefusedLeaveItsResult) {
  ASSERT_EQ(plant_.set_endless(a_), kOk);
  a_.begin(block(row::controlword, row::command_id,
                 {{row::controlword, 6}, {row::command, kQuickStop}, {row::command_id, 1}}));
  EXPECT_EQ(a_.command(plant_.endless_command()), kFailed);
  plant_.run(300ms);
  EXPECT_EQ(a_.result(), kNoState);
}

TEST_P(Stops, AreDoneWhenTheMotorWasSeenToObey) {
  start_with_ids();
  EXPECT_EQ(a_.command(kQuickStop, 3), kOk);
  EXPECT_EQ(a_.result(), 2);
  EXPECT_EQ(a_.word(shown::axis_state), kStopLatched);
}

// 3.4: until an enable that is accepted after the stop. What the words of stop_latched tell people to do is done here.
TEST_P(Stops, StayLatchedThroughADisable) {
  constexpr std::uint16_t kRowOfAlarms = 34;
  constexpr unsigned kLatchAlarm = 7;
  constexpr std::int64_t kReset = 5, kEnableOperation = 15;
  const auto bit = [&](std::uint16_t row, std::int64_t number) {
    return (static_cast<std::uint32_t>(a_.wide(row)) >> number & 1U) != 0;
  };
  const auto latched = [&] { return bit(kRowOfAlarms, kLatchAlarm); };
  const auto expect_latched = [&] {
    EXPECT_TRUE(latched());
    for (std::int64_t command = kMove; command <= kSetPosition; ++command) {
      if (!bit(shown::supported_commands, command)) continue;
      EXPECT_EQ(a_.command(0), kOk);
      EXPECT_EQ(a_.command(command), kFailed) << command;
      EXPECT_EQ(a_.result(), kNoState) << command;
    }
    EXPECT_EQ(plant_.velocity(), 0);
  };
  start_with_ids();
  ASSERT_EQ(a_.command(kQuickStop, 3), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  expect_latched();
  EXPECT_EQ(a_.command(kDisable), kOk);
  expect_latched();
  EXPECT_EQ(a_.coil(coil::enable, false), kOk);
  expect_latched();
  // A fault reset clears faults, and a 15 without a 6 or 7 before it enables nobody.
  EXPECT_EQ(a_.command(kReset), kOk);
  EXPECT_FALSE(a_.row(row::controlword, kEnableOperation).ok());
  expect_latched();
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_FALSE(latched());
  // "command 0 first if the last command was 1"
  ASSERT_EQ(b_.command(kQuickStop), kOk);
  ASSERT_TRUE(latched());
  EXPECT_EQ(a_.command(kEnable), kNotNow);
  EXPECT_TRUE(latched());
  EXPECT_EQ(a_.command(0), kOk);
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_FALSE(latched());
  // "coil 0: first 0"
  ASSERT_EQ(a_.coil(coil::enable, true), kOk);
  ASSERT_EQ(b_.command(kQuickStop), kOk);
  EXPECT_EQ(a_.coil(coil::enable, true), kNotNow);
  EXPECT_TRUE(latched());
  EXPECT_EQ(a_.coil(coil::enable, false), kOk);
  EXPECT_TRUE(latched());
  EXPECT_EQ(a_.coil(coil::enable, true), kOk);
  EXPECT_FALSE(latched());
}

// A drive that was away may have restarted: a 6 or 7 of before is no step out of the latch any more.
TEST_P(Stops, StayLatchedWhereTheDriveWasGoneBetweenTheTwoStepsOutOfIt) {
  constexpr std::int64_t kSwitchOn = 7, kEnableOperation = 15;
  start_with_ids();
  ASSERT_EQ(a_.command(kQuickStop, 3), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(a_.row(row::controlword, kSwitchOn), kOk);
  plant_.unplug();
  plant_.run(1s);
  plant_.restart_drive();
  plant_.plug();
  ASSERT_TRUE(plant_.stage.run_until([&] { return plant_.stage.axis(1).link_state == LinkState::online; }, 90s));
  EXPECT_EQ(a_.row(row::controlword, kEnableOperation), kFailed);
  plant_.run(1s);
  EXPECT_EQ(a_.word(shown::axis_state), kStopLatched);
  EXPECT_FALSE(plant_.motor().enabled.value_or(false));
}

// A homing that was halted is over, and can be begun anew at once; the mode is what it was.
class HaltedHoming : public Stops {
 protected:
  void SetUp() override { ASSERT_EQ(a_.row(row::homing_method, kHomeSwitch), kOk); }
  void home_and_halt() {
    ASSERT_EQ(a_.command(kHome), kOk);
    ASSERT_TRUE(plant_.turns_within(1s));
    ASSERT_EQ(a_.command(kHalt), kOk);
    ASSERT_TRUE(plant_.comes_to_stand());
  }
  [[nodiscard]] std::int64_t mode() { return plant_.stage.axis(1)[Quantity::mode_display].value; }
  static constexpr std::int64_t kHomeSwitch = 19, kHome = 10, kHalt = 4, kMove = 6, kHomingMode = 6;
};

TEST_P(HaltedHoming, CanBeBegunAnew) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_NO_FATAL_FAILURE(home_and_halt());
    EXPECT_EQ(mode(), kHomingMode);
  }
  EXPECT_EQ(a_.row(row::target_position, kNear), kOk);
  EXPECT_EQ(a_.command(kMove), kOk);
  EXPECT_TRUE(plant_.turns_within(1s));
}

TEST_P(HaltedHoming, LeavesTheModeWhereTheHaltEnds) {
  ASSERT_NO_FATAL_FAILURE(home_and_halt());
  EXPECT_EQ(a_.coil(coil::halt, true), kOk);
  EXPECT_EQ(a_.coil(coil::halt, false), kOk);
  plant_.run(300ms);
  EXPECT_EQ(mode(), kHomingMode);
  EXPECT_TRUE(plant_.stands());
  EXPECT_EQ(a_.command(kHome), kOk);
  EXPECT_TRUE(plant_.turns_within(1s));
}

TEST_P(HaltedHoming, ByRawWordsIsNoMoveToAnOlderTarget) {
  constexpr std::int64_t kOn = 0x0F, kGo = 0x1F, kHalted = 0x11F, kHoming = 4;
  ASSERT_EQ(a_.row(row::target_position, kFar), kOk);
  ASSERT_EQ(a_.row(row::mode, kHomingMode), kOk);
  ASSERT_EQ(a_.row(row::controlword, kOn), kOk);
  ASSERT_EQ(a_.row(row::controlword, kGo), kOk);
  ASSERT_TRUE(plant_.turns_within(1s));
  ASSERT_EQ(a_.row(row::controlword, kHalted), kOk);
  ASSERT_TRUE(plant_.comes_to_stand());
  ASSERT_EQ(a_.row(row::controlword, kOn), kOk);
  plant_.run(300ms);
  EXPECT_TRUE(plant_.stands());
  EXPECT_EQ(mode(), kHomingMode);
  ASSERT_EQ(a_.row(row::controlword, kGo), kOk);
  EXPECT_TRUE(plant_.turns_within(1s));
  EXPECT_EQ(a_.word(shown::axis_state), kHoming);
}

// Of two drives on a line each has its stops, and what stands beside them, for itself.
class StopsOfTheSecondDrive : public testing::TestWithParam<Subject> {
 protected:
  StopsOfTheSecondDrive() {
    plant_.ready();
    EXPECT_EQ(write({{row::controlword, 0x000F}}), kOk) << "only remembered";
    EXPECT_EQ(plant_.set_endless(a_), kOk);
    EXPECT_EQ(a_.command(plant_.endless_command()), kOk);
    EXPECT_TRUE(plant_.turns_within(1s));
  }
  Answer write(const Rows& rows) { return a_.rows(row::controlword, row::target_velocity + 1, rows); }
  Plant plant_{GetParam(), {.neighbour = true, .neighbour_first = true}};
  Client& a_ = plant_.a;
  Client& b_ = plant_.b;
};

// The word 0 is a stop; what stands beside it goes on as a command, of the same drive.
TEST_P(StopsOfTheSecondDrive, CarryOutWhatStandsBesideThem) {
  ASSERT_EQ(b_.command(kHalt), kOk);
  const bool speeds = has_speeds(GetParam());
  Rows rows{{row::controlword, 0}};
  rows[speeds ? row::target_velocity : row::target_position] = speeds ? kOtherSpeed : kEndless;
  EXPECT_EQ(write(rows), kOk);
  EXPECT_TRUE(plant_.comes_to_stand());
  EXPECT_EQ(b_.coil(coil::fault_reset, true), kOk) << "nothing is left that it would wait for";
  EXPECT_EQ(a_.command(kEnable), kOk);
  EXPECT_EQ(a_.command(plant_.endless_command()), kOk);
  EXPECT_TRUE(plant_.keeps_turning());
  EXPECT_TRUE(!speeds || plant_.reaches(kOtherSpeed)) << plant_.velocity();
}

// A JD has no halt but the quick stop.
INSTANTIATE_TEST_SUITE_P(Every, HaltedHoming,
                         testing::Values(Subject::md_serial, Subject::md_rtu, Subject::md_can, Subject::leadshine),
                         named);
INSTANTIATE_TEST_SUITE_P(Every, Stops, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, StopsOfTheSecondDrive, testing::ValuesIn(subjects(may_have_neighbour)), named);

}  // namespace
}  // namespace axisgate::test::obey
