// What the iD286pro stores, what a restart loses, its faults (iD286pro 4, 6, 7).
#include <gmock/gmock.h>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr int stopped = 2;
constexpr int disabled = 1;

void restart(RtuBench& bench) {
  bench.line().restart(0, bench.now);
  bench.pass(std::chrono::seconds(2));
}

TEST(Id286proEeprom, EachWriteOfAStoredRegisterCountsEvenOfTheSameValue) {
  RtuBench bench(Id286proOptions{});
  for (int i = 0; i < 3; ++i) bench.write(305, 1);
  bench.write_pair(317, 1000);
  bench.write(241, 4000);
  EXPECT_THAT(bench.id286pro().registers().stored_writes(), ElementsAre(Pair(241, 1), Pair(305, 3), Pair(317, 1)));
}

TEST(Id286proEeprom, HighlightedRegistersCostNothing) {
  RtuBench bench(Id286proOptions{});
  bench.write(303, 600);
  bench.write(304, 600);
  bench.write(306, 600);
  bench.write(307, 600);
  bench.write_pair(321, 600);
  bench.write(323, 6);
  EXPECT_THAT(bench.id286pro().registers().stored_writes(), IsEmpty());
  EXPECT_THAT(bench.id286pro().registers().unknown_writes(), IsEmpty());
  EXPECT_EQ(bench.id286pro().registers().writes(306), 1U);
}

TEST(Id286proEeprom, ThoseWhoseHighlightingIsLostAreCountedApart) {
  RtuBench bench(Id286proOptions{});
  for (std::uint16_t row = 308; row <= 310; ++row) bench.write(row, 900);
  for (std::uint16_t row = 311; row <= 315; row += 2) bench.write_pair(row, 900);
  bench.write_pair(313, 901);
  EXPECT_THAT(bench.id286pro().registers().stored_writes(), IsEmpty());
  EXPECT_THAT(bench.id286pro().registers().unknown_writes(),
              ElementsAre(Pair(308, 1), Pair(309, 1), Pair(310, 1), Pair(311, 1), Pair(313, 2), Pair(315, 1)));
}

TEST(Id286proEeprom, ReadsAndRefusedWritesCostNothing) {
  RtuBench bench(Id286proOptions{});
  bench.read(298, 26);
  bench.write(305, 9);
  EXPECT_THAT(bench.id286pro().registers().stored_writes(), IsEmpty());
}

TEST(Id286proEeprom, ARestartKeepsWhatIsStoredAndLosesTheRest) {
  RtuBench bench(Id286proOptions{});
  bench.write(301, 150);
  bench.write(306, 2500);
  bench.write(308, 300);
  bench.write_pair(313, 4000);
  bench.write(323, 1);
  bench.pass(std::chrono::seconds(1));
  ASSERT_EQ(bench.pair(117), 4000);
  restart(bench);
  EXPECT_EQ(bench.word(301), 150);
  EXPECT_EQ(bench.word(306), 1000);
  EXPECT_EQ(bench.word(308), 300);
  EXPECT_EQ(bench.word(323), 0);
  EXPECT_EQ(bench.pair(117), 0);
  EXPECT_EQ(bench.word(109), stopped);
  EXPECT_EQ(bench.id286pro().restarts(), 1U);
}

TEST(Id286proEeprom, WhatIsUnknownMayBeLost) {
  Id286proOptions options;
  options.unknown_are_stored = false;
  RtuBench bench(options);
  bench.write(308, 300);
  restart(bench);
  EXPECT_EQ(bench.word(308), 1000);
}

TEST(Id286proEeprom, TheSegmentAreaIsSavedByItsCommand) {
  RtuBench bench(Id286proOptions{});
  bench.write_several(1024, {7, 8});
  restart(bench);
  EXPECT_THAT(bench.read(1024, 2), ElementsAre(0, 0));
  bench.write_several(1024, {7, 8});
  bench.write(323, 15);
  EXPECT_EQ(bench.id286pro().registers().area_saves(), 1U);
  restart(bench);
  EXPECT_THAT(bench.read(1024, 2), ElementsAre(7, 8));
}

TEST(Id286proUserCommand, OneResetsTheParameters) {
  RtuBench bench(Id286proOptions{});
  bench.write(301, 150);
  bench.write(306, 2500);
  EXPECT_EQ(bench.write(206, 1), 0);
  EXPECT_EQ(bench.word(301), 100);
  EXPECT_EQ(bench.word(306), 1000);
  EXPECT_EQ(bench.word(296), 0);
  EXPECT_TRUE(bench.id286pro().internal_pulses());  // until the restart
  restart(bench);
  EXPECT_FALSE(bench.id286pro().internal_pulses());
}

TEST(Id286proUserCommand, ThreeRestartsAfterTheAnswerAndOnlyWhileItStands) {
  RtuBench bench(Id286proOptions{});
  bench.write(323, 4);
  EXPECT_EQ(bench.write(206, 3), 0);
  bench.pass(milliseconds(200));
  EXPECT_EQ(bench.id286pro().restarts(), 0U);
  bench.write(323, 7);
  EXPECT_EQ(bench.write(206, 3), 0);  // answered
  bench.pass(milliseconds(100));
  EXPECT_TRUE(bench.read(109).empty());
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.word(109), stopped);
  EXPECT_EQ(bench.id286pro().restarts(), 1U);
}

TEST(Id286proRestart, NothingThatIsOnAtPowerUpTriggers) {
  Id286proOptions options;
  options.stored = {{400, 4}, {410, 1}};
  RtuBench bench(options);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.word(109), stopped);
  restart(bench);
  EXPECT_EQ(bench.word(109), stopped);
  EXPECT_TRUE(bench.id286pro().starts().empty());
}

class Id286proFault : public testing::TestWithParam<int> {};

TEST_P(Id286proFault, StopsTheMotorAndIsClearedByEitherCommand) {
  const auto code = static_cast<std::uint16_t>(GetParam());
  RtuBench bench(Id286proOptions{});
  for (const auto& [reg, command] : std::vector<std::pair<std::uint16_t, int>>{{323, 13}, {206, 2}}) {
    bench.write(323, 4);
    bench.pass(milliseconds(100));
    bench.id286pro().inject_fault(code);
    EXPECT_EQ(bench.word(108), code);
    EXPECT_EQ(bench.word(109), disabled);
    const std::int32_t here = bench.pair(117);
    bench.write(323, 4);
    bench.pass(milliseconds(50));
    EXPECT_EQ(bench.pair(117), here);
    bench.write(reg, command);
    EXPECT_EQ(bench.word(108), code);  // its cause is still there
    bench.id286pro().clear_fault_cause();
    bench.pass(milliseconds(50));
    EXPECT_EQ(bench.word(108), code);  // and it does not go by itself
    bench.write(reg, command);
    EXPECT_EQ(bench.word(108), 0);
    bench.pass(milliseconds(50));
    EXPECT_EQ(bench.word(109), stopped);  // nothing goes on by itself
  }
}

TEST_P(Id286proFault, OfTheHardwareNeedsThePowerOff) {
  const auto code = static_cast<std::uint16_t>(GetParam());
  RtuBench bench(Id286proOptions{});
  bench.id286pro().inject_fault(code, false);
  bench.id286pro().clear_fault_cause();
  bench.write(323, 13);
  bench.write(206, 2);
  EXPECT_EQ(bench.word(108), code);
  restart(bench);
  EXPECT_EQ(bench.word(108), 0);
  EXPECT_EQ(bench.word(109), stopped);
}

INSTANTIATE_TEST_SUITE_P(Codes, Id286proFault, testing::Values(10, 11, 13, 14));

TEST(Id286proFaults, AFaultWhoseCauseStaysIsThereAgainAfterARestart) {
  RtuBench bench(Id286proOptions{});
  bench.id286pro().inject_fault(13);
  restart(bench);
  EXPECT_EQ(bench.word(108), 13);
}

}  // namespace
}  // namespace axisgate::simulated
