// What ends or forbids the iD286pro's motion beside a stop: limits, run mode, enable (iD286pro 1, 4, 6).
#include <gtest/gtest.h>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

constexpr int stopped = 2;
constexpr int disabled = 1;

RtuBench a_stepper(const Id286proOptions& options = {}) { return RtuBench(options); }

bool stands(RtuBench& bench, Time longest = std::chrono::seconds(60)) {
  return bench.pass_until([&] { return bench.word(109) == stopped; }, longest);
}

TEST(Id286proStops, TheSoftLimitsEndTheWay) {
  RtuBench bench = a_stepper();
  bench.write_pair(317, 15000);
  bench.write_pair(319, -4000);
  bench.write_pair(313, 50000);
  bench.write(323, 1);
  ASSERT_TRUE(stands(bench));
  EXPECT_EQ(bench.pair(117), 15000);
  bench.write(323, 5);
  ASSERT_TRUE(stands(bench));
  EXPECT_EQ(bench.pair(117), -4000);
  bench.write(323, 5);
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.pair(117), -4000);
  bench.write(323, 4);
  bench.pass(milliseconds(10));
  EXPECT_GT(bench.pair(117), -4000);
}

TEST(Id286proStops, ALimitInputStopsAtOnceInItsDirectionAlone) {
  Id286proOptions options;
  options.mechanics.positive_limit = 8000;
  options.stored = {{400, 9}};
  RtuBench bench = a_stepper(options);
  bench.write(323, 4);
  ASSERT_TRUE(stands(bench, std::chrono::seconds(5)));
  const std::int32_t here = bench.pair(117);
  EXPECT_GE(here, 8000);
  EXPECT_LT(here, 8200);
  bench.write(323, 4);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.pair(117), here);
  bench.write(323, 5);
  bench.pass(milliseconds(500));
  EXPECT_LT(bench.pair(117), 8000);
}

TEST(Id286proStops, WithExternalPulsesMotionCommandsAreAcknowledgedAndIgnored) {
  Id286proOptions options;
  options.internal_pulses = false;
  RtuBench bench = a_stepper(options);
  bench.write_pair(313, 5000);
  for (const int command : {1, 2, 3, 4, 5, 12}) {
    EXPECT_EQ(bench.write(323, command), 0);
    bench.pass(milliseconds(50));
    EXPECT_EQ(bench.word(109), stopped);
  }
  EXPECT_EQ(bench.pair(117), 0);
  EXPECT_EQ(bench.write(296, 1), 0);
  bench.write(323, 1);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.pair(117), 0);  // not before a restart
  EXPECT_EQ(bench.write(206, 3), 0);
  bench.pass(std::chrono::seconds(2));
  bench.write_pair(313, 5000);
  bench.write(323, 1);
  ASSERT_TRUE(stands(bench));
  EXPECT_EQ(bench.pair(117), 5000);
}

TEST(Id286proStops, TheHardWiredEnableStopsAndFrees) {
  RtuBench bench = a_stepper();
  bench.write(323, 4);
  bench.pass(milliseconds(50));
  bench.id286pro().set_enable_switch(false);
  EXPECT_EQ(bench.word(109), disabled);
  const std::int32_t here = bench.pair(117);
  EXPECT_EQ(bench.write(323, 4), 0);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.pair(117), here);
  bench.id286pro().set_enable_switch(true);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.word(109), stopped);  // nothing goes on by itself
}

TEST(Id286proStops, AJammedRotorIsNotSeenByAnOpenLoopDrive) {
  RtuBench bench = a_stepper();
  bench.id286pro().jam(true);
  bench.write_pair(313, 5000);
  bench.write(323, 1);
  ASSERT_TRUE(stands(bench));
  EXPECT_EQ(bench.pair(117), 5000);
  EXPECT_EQ(counts_of(bench.id286pro().axis().physical()), 0);
}

TEST(Id286proStops, TheDirectionBitTurnsTheMotorAndNotTheNumbers) {
  RtuBench bench = a_stepper();
  bench.write(201, 1);
  bench.write_pair(313, 5000);
  bench.write(323, 1);
  ASSERT_TRUE(stands(bench));
  EXPECT_EQ(bench.pair(117), 5000);
  EXPECT_EQ(counts_of(bench.id286pro().axis().physical()), -5000);
}

}  // namespace
}  // namespace axisgate::simulated
