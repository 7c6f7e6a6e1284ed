// SPDX-License-Identifier: Apache-2.0
// A stop is done when the drive shows it, and what was read before it went out shows neither it nor what came after it.
#include <gtest/gtest.h>

#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

class AfterAGap : public testing::TestWithParam<Subject> {};

// On a line that was silent for a moment the owed stop of some drives takes the torque as well. An enable that comes
// right behind it must not be told by what the drive showed before.
TEST_P(AfterAGap, AnEnableBehindTheOwedStopIsDoneWhenTheMotorHasTorque) {
  for (const Duration behind : {0ms, 2ms, 4ms, 7ms, 12ms, 30ms}) {
    SCOPED_TRACE(behind / 1ms);
    Plant plant(GetParam());
    plant.ready();
    ASSERT_EQ(plant.set_endless(plant.a), kOk);
    ASSERT_EQ(plant.a.command(plant.endless_command()), kOk);
    ASSERT_TRUE(plant.keeps_turning());
    plant.cut_wire();
    plant.run(100ms);
    plant.a.begin(one(row::command, kHalt));
    plant.run(200ms);
    const std::uint64_t heard = plant.requests_heard();
    plant.mend_wire();
    static_cast<void>(plant.stage.run_until([&] { return plant.requests_heard() > heard && !plant.motor().enabled.value_or(true); }, 1s));
    plant.run(behind);
    const Answer answer = plant.b.command(kEnable);
    plant.run(50ms);
    if (answer.ok()) {
      EXPECT_TRUE(plant.motor().enabled.value_or(true));
    }
    ASSERT_TRUE(plant.stage.run_until([&] { return plant.b.command(kEnable).ok(); }, 5s));
    plant.run(50ms);
    EXPECT_TRUE(plant.motor().enabled.value_or(true));
  }
}

INSTANTIATE_TEST_SUITE_P(All, AfterAGap, testing::ValuesIn(kSubjects), named);

}  // namespace
}  // namespace axisgate::test::obey
