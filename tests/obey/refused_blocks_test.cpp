// SPDX-License-Identifier: Apache-2.0
// 3.3 Refused blocks: a block write that is answered 0x01, 0x02 or 0x03 tells in command_detail which row it was, also
// where only the drive's own limits, or the moment, say so.
#include <gtest/gtest.h>

#include <limits>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

constexpr std::int64_t kNoDrivesMode = 77;

class RefusedBlocks : public testing::TestWithParam<Subject> {
 protected:
  RefusedBlocks() { plant_.ready(); }
  void expect_refused(const Write& block, std::uint16_t row) {
    SCOPED_TRACE(text(block));
    EXPECT_EQ(a_.write(block), kBadValue);
    EXPECT_EQ(a_.result(), 0);
    EXPECT_EQ(a_.wide(shown::detail), 0x0A00'0000 + row);
  }
  Plant plant_{GetParam(), with_leases()};
  Client& a_ = plant_.a;
};
class RefusedModes : public RefusedBlocks {};
class RefusedNumbers : public RefusedBlocks {};
class RefusedLimits : public RefusedBlocks {};
class RefusedHomings : public RefusedBlocks {};

TEST_P(RefusedModes, AreToldByTheFirstRowThatIsBeyondTheDrive) {
  expect_refused(block(row::mode, row::profile_velocity + 1, {{row::mode, kNoDrivesMode}}), row::mode);
  expect_refused(block(row::homing_method - 2, row::homing_method, {{row::jog_velocity, 0}, {row::homing_method, 99}}),
                 row::homing_method);
  // Of two the first, whatever was looked at first.
  ASSERT_EQ(a_.command(0), kOk);
  expect_refused(block(row::mode, row::homing_method, {{row::mode, kNoDrivesMode}, {row::homing_method, 99}}),
                 row::mode);
}

TEST_P(RefusedModes, BesideAStopAreToldAndTheAxisStops) {
  ASSERT_TRUE(plant_.start_endless(a_));
  expect_refused(block(row::mode, row::command, {{row::mode, kNoDrivesMode}, {row::command, kQuickStop}}), row::mode);
  EXPECT_TRUE(plant_.comes_to_stand());
}

// The lowest number of its type is how a row reads that has no value: a program that copies what it has read writes it.
TEST_P(RefusedNumbers, ThatMeanNoValueBesideAStopAreToldAndTheAxisStops) {
  constexpr std::int64_t kNoValue = std::numeric_limits<std::int32_t>::min();
  ASSERT_TRUE(plant_.start_endless(a_));
  const std::uint16_t target = has_speeds(GetParam()) ? row::target_velocity : row::target_position;
  Rows rows = plant_.profile_rows();
  rows[target] = kNoValue;
  rows[row::command] = kQuickStop;
  expect_refused(block(target, row::command, rows), target);
  EXPECT_TRUE(plant_.comes_to_stand());
}

TEST_P(RefusedLimits, ThatCrossAreToldByTheFirstOfThem) {
  constexpr std::uint16_t kMin = 72, kMax = 74;
  expect_refused(block(kMin, kMax + 1, {{kMin, 1000}, {kMax, -1000}}), kMin);
}

// Each row of it could be; only at its turn is it known that no method was ever named.
TEST_P(RefusedHomings, WithoutAMethodAreToldByTheCommand) {
  ASSERT_EQ(a_.command(0, 1), kOk);
  expect_refused(block(row::target_torque, row::command_id, {{row::command, kHome}, {row::command_id, 2}}),
                 row::command);
}

INSTANTIATE_TEST_SUITE_P(Every, RefusedModes, testing::ValuesIn(subjects(has_homing)), named);
INSTANTIATE_TEST_SUITE_P(Every, RefusedNumbers, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, RefusedLimits, testing::ValuesIn(subjects([](Subject s) { return !is_keya(s); })),
                         named);
INSTANTIATE_TEST_SUITE_P(Every, RefusedHomings, testing::ValuesIn(subjects(has_homing)), named);

}  // namespace
}  // namespace axisgate::test::obey
