// Profiles, torque, limits and counting of the simulated motor (JD 5, JD 6.3, MD 7).
#include <gtest/gtest.h>

#include "tests/simulated/trapezoid.hpp"
#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

TEST(Trapezoid, EndsExactlyOnEveryTargetFromEverySpeed) {
  Random random(3);
  for (int run = 0; run < 2000; ++run) {
    const auto maximum = static_cast<Dec>(1 + random.below(1000000));
    const auto acceleration = static_cast<Dec>(1 + random.below(50000));
    const auto deceleration = static_cast<Dec>(1 + random.below(50000));
    const auto target = static_cast<FinePosition>(random.below(20000000)) - 10000000;
    FinePosition position = 0;
    Dec speed = 0;
    std::int64_t steps = 0;
    while (position != target || speed != 0) {
      const Dec next = approach(speed, target - position, maximum, acceleration, deceleration);
      ASSERT_LE(std::abs(next), maximum);
      ASSERT_LE(std::abs(next) - std::abs(speed), acceleration);
      ASSERT_LE(std::abs(speed) - std::abs(next), deceleration);
      position += next;
      ASSERT_LE(std::abs(position), std::abs(target)) << "beyond the target";
      speed = next;
      ASSERT_LT(++steps, 30000000);
    }
  }
}

TEST(Trapezoid, RampsThroughZeroWithoutASkip) {
  Dec speed = 100;
  for (int i = 0; i < 3; ++i) speed = ramp(speed, -50, 20, 40);
  EXPECT_EQ(speed, 0);
  for (int i = 0; i < 3; ++i) speed = ramp(speed, -50, 20, 40);
  EXPECT_EQ(speed, -50);
}

TEST(Motion, AccelerationIsAsTheSheetConvertsIt) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6060, 0, 3);
  bench.write(0x6083, 0, 16384);  // 100 rps/s at 10000 counts
  bench.write(0x60FF, 0, speed_dec(600, 10000));
  bench.control(0x0F);
  bench.pass(milliseconds(50));
  EXPECT_NEAR(static_cast<double>(bench.read(0x60F9, 0x19)), 30000, 1000);  // 300 rpm after 50 ms
  bench.pass(milliseconds(52));
  EXPECT_EQ(bench.read(0x60F9, 0x19), 32767);  // 600 rpm do not fit 0.01 rpm in 16 bits
  EXPECT_EQ(bench.read(0x60F9, 0x1A), 100);
}

TEST(Motion, A16BitEncoderTurnsAtThePrintedSpeedsOverSixty) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x6060, 0, 3);
  bench.exchange(from_hex("01 23 FF 60 00 00 40 06 00 37"));  // "150 rpm" at 10000 counts
  bench.control(0x0F);
  bench.pass(std::chrono::seconds(61));
  EXPECT_NEAR(static_cast<double>(bench.read(0x6063)) / 65536, 22.9 * 61 / 60, 0.1);  // MD 10.1: 22.9 rpm
}

TEST(Motion, SpeedLimit6080BoundsEveryMode) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6080, 0, 200);
  bench.write(0x6060, 0, 4);
  bench.write(0x60F6, 0x08, 1000);
  bench.control(0x0F);
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.read(0x606C), 200);
  EXPECT_EQ(bench.read(0x60F6, 0x17), 1000);
  bench.write(0x60FF, 0, speed_dec(1000, 10000));
  bench.write(0x6060, 0, 3);
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.read(0x606C), 200);
}

TEST(Motion, EnablingInAVelocityModeRunsAtOnce) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6060, 0, -3);
  bench.write(0x60FF, 0, speed_dec(-100, 10000));
  EXPECT_EQ(bench.read(0x60FF), -273067);
  bench.control(0x0F);
  bench.pass(milliseconds(300));
  EXPECT_EQ(bench.read(0x606C), -100);
}

TEST(Motion, SoftwareLimitsEndEveryMotion) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x607D, 0x01, 5000);
  bench.write(0x607D, 0x02, -5000);
  bench.write(0x6060, 0, 1);
  bench.control(0x0F);
  bench.write(0x607A, 0, 100000);
  bench.control(0x2F);
  bench.control(0x3F);
  bench.pass(std::chrono::seconds(3));
  EXPECT_EQ(bench.read(0x6063), 5000);
  EXPECT_NE(bench.status() & 0x0800, 0);
  EXPECT_EQ(bench.status() & 0x0400, 0);
  bench.write(0x60FF, 0, speed_dec(-300, 10000));
  bench.write(0x6060, 0, 3);
  bench.pass(std::chrono::seconds(3));
  EXPECT_NEAR(static_cast<double>(bench.read(0x6063)), -5000, 2);
}

TEST(Motion, ThePositionCounterWrapsAt32Bits) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6060, 0, 6);
  bench.write(0x6098, 0, 35);
  bench.write(0x607C, 0, -2147480000);  // the home position then reads 2147480000
  bench.control(0x0F);
  bench.control(0x1F);
  ASSERT_TRUE(bench.wait_for(0x8000));
  EXPECT_EQ(bench.read(0x6063), 2147480000);
  bench.write(0x60FF, 0, speed_dec(600, 10000));
  bench.write(0x6060, 0, 3);
  bench.pass(milliseconds(200));
  EXPECT_LT(bench.read(0x6063), -2147000000);
}

TEST(Motion, WithoutBit5ASecondSetPointWaitsForTheFirst) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6060, 0, 1);
  bench.control(0x0F);
  bench.write(0x607A, 0, 4000);
  bench.control(0x1F);
  bench.control(0x0F);
  bench.write(0x607A, 0, 1000);
  bench.control(0x1F);
  bool was_there = false;
  for (int i = 0; i < 3000; ++i) {
    bench.pass(milliseconds(1));
    was_there = was_there || bench.drive().position() == 4000;
  }
  EXPECT_TRUE(was_there);
  EXPECT_EQ(bench.read(0x6063), 1000);
}

TEST(Motion, TheSimplifiedObjectsAreOtherViews) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x2FF0, 0x09, 200);
  EXPECT_EQ(bench.read(0x60FF), 546133);
  bench.write(0x2FF0, 0x06, 610);
  EXPECT_EQ(bench.read(0x6083), 99942);
  bench.write(0x2FF0, 0x0E, 50);
  EXPECT_EQ(bench.read(0x6065), 5000);
  bench.write(0x2FF0, 0x05, 1);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  bench.write(0x2FF0, 0x05, 0);
  EXPECT_EQ(bench.status() & 0x6F, 0x21);
}

TEST(Motion, ADisabledMotorCoastsAndItsNextMoveStartsWhereItStands) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x6060, 0, 3);
  bench.write(0x60FF, 0, speed_dec(600, 10000));
  bench.control(0x0F);
  bench.pass(milliseconds(500));
  bench.control(0x06);
  bench.pass(std::chrono::seconds(2));
  bench.write(0x6060, 0, 1);
  bench.control(0x0F);
  const auto there = bench.read(0x6063);
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.read(0x6063), there);
}

TEST(Motion, InvertedCountingTurnsTheMotorTheOtherWay) {
  Bench bench(a_drive(KincoType::md));
  bench.write(0x607E, 0, 1);
  bench.write(0x6060, 0, 1);
  bench.control(0x0F);
  bench.write(0x607A, 0, 5000);
  bench.control(0x2F);
  bench.control(0x3F);
  ASSERT_TRUE(bench.wait_for(0x0400));
  bench.pass(milliseconds(20));
  EXPECT_EQ(bench.read(0x6063), 5000);
  EXPECT_EQ(counts_of(bench.drive().axis().physical()), -5000);
}

}  // namespace
}  // namespace axisgate::simulated
