// SPDX-License-Identifier: Apache-2.0
// 3.4 Stops: one in a block of which another row or coil is refused stops the motor all the same, and nothing else of
// that block acts.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

class RefusedStops : public testing::TestWithParam<Subject> {
 protected:
  RefusedStops() {
    plant_.ready();
    a_.be(Role::operator_);
    a_.connect();
  }
  void expect_stop(const Write& write, std::uint8_t exception, std::uint32_t row) {
    SCOPED_TRACE(text(write));
    EXPECT_EQ(a_.write(write), exception);
    EXPECT_EQ(a_.result(), 0);
    EXPECT_EQ(static_cast<std::uint32_t>(a_.wide(shown::detail)), 0x0A00'0000U + row);
    EXPECT_TRUE(plant_.comes_to_stand()) << plant_.velocity();
    EXPECT_EQ(a_.word(shown::axis_state), kStopLatched);
  }
  Plant plant_{GetParam(), with_leases()};
  Client& a_ = plant_.a;
};

TEST_P(RefusedStops, BesideHalfOfARow) {
  ASSERT_TRUE(plant_.start_endless(a_));
  expect_stop(block(row::command - 1, row::command, {{row::command, kQuickStop}}), kNoSuchRow,
              row::profile_deceleration);
}

TEST_P(RefusedStops, BesideAReservedCoil) {
  constexpr std::uint16_t kReserved = 11;
  std::vector<std::uint16_t> coils(kReserved + 1, 0);
  coils[coil::enable] = coils[coil::quick_stop] = coils[kReserved] = 1;
  ASSERT_TRUE(plant_.start_endless(a_));
  expect_stop(coil_block(0, coils), kNoSuchRow, kReserved);
}

class RefusedStopsOfOperators : public RefusedStops {};

TEST_P(RefusedStopsOfOperators, BesideARowOfAnEngineer) {
  Rows rows{{row::command, kQuickStop}, {row::quick_stop_deceleration, 12'345}};
  ASSERT_TRUE(plant_.start_endless(a_));
  expect_stop(block(row::command, row::quick_stop_deceleration + 1, rows), 1, row::quick_stop_deceleration);
}

INSTANTIATE_TEST_SUITE_P(Every, RefusedStops, testing::ValuesIn(kSubjects), named);
INSTANTIATE_TEST_SUITE_P(Every, RefusedStopsOfOperators, testing::ValuesIn(subjects(has_homing)), named);

}  // namespace
}  // namespace axisgate::test::obey
