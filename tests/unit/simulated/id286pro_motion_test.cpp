// The iD286pro's motion: every command of 0323, in manual time (iD286pro 5, 6).
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

constexpr int running = 3;
constexpr int stopped = 2;

RtuBench a_stepper(const Id286proOptions& options = {}) { return RtuBench(options); }

bool stands(RtuBench& bench, Time longest = std::chrono::seconds(60)) {
  return bench.pass_until([&] { return bench.word(109) == stopped; }, longest);
}

TEST(Id286proMotion, AnAbsoluteMoveEndsExactlyOnItsTargetWithTheSpeedItWasGiven) {
  RtuBench bench = a_stepper();
  bench.write(306, 2000);  // 20 rev/s
  bench.write_pair(313, -100000);
  EXPECT_EQ(bench.word(109), stopped);
  EXPECT_EQ(bench.write(323, 1), 0);
  EXPECT_EQ(bench.word(109), running);
  int fastest = 0;
  const Time begun = bench.now;
  EXPECT_TRUE(bench.pass_until([&] {
    fastest = std::min(fastest, static_cast<int>(static_cast<std::int16_t>(bench.word(119))));
    return bench.word(109) == stopped;
  }));
  EXPECT_EQ(bench.pair(117), -100000);
  EXPECT_EQ(fastest, -2000);  // direction by the target; the speed's sign is not asked
  // 10 revolutions at 20 rev/s with ramps of 500 rev/s^2: 0.5 s and 0.04 s.
  EXPECT_NEAR(static_cast<double>((bench.now - begun).count()), 0.54e9, 0.01e9);
  EXPECT_EQ(bench.word(119), 0);
}

TEST(Id286proMotion, TheSpeedBeginsAtTheStartFrequencyAndRisesWithTheAcceleration) {
  RtuBench bench = a_stepper();
  bench.write(301, 300);
  bench.write(303, 1000);
  bench.write(307, 2000);
  bench.write(323, 3);
  bench.pass(milliseconds(1));
  EXPECT_EQ(bench.word(119), 300);
  bench.pass(milliseconds(10));
  EXPECT_EQ(bench.word(119), 1300);  // 1000 rev/s^2 for 10 ms
  bench.pass(milliseconds(10));
  EXPECT_EQ(bench.word(119), 2000);
}

TEST(Id286proMotion, ATargetChangedOnTheWayTakesEffectInAnAbsoluteMoveAlone) {
  RtuBench absolute = a_stepper();
  absolute.write_pair(313, 50000);
  absolute.write(323, 1);
  absolute.pass(milliseconds(100));
  absolute.write_pair(313, -7000);
  ASSERT_TRUE(stands(absolute));
  EXPECT_EQ(absolute.pair(117), -7000);
  absolute.write_pair(313, 9000);  // standing: a target is no start
  absolute.pass(std::chrono::seconds(1));
  EXPECT_EQ(absolute.pair(117), -7000);

  RtuBench relative = a_stepper();
  relative.write_pair(313, 50000);
  relative.write(323, 2);
  relative.pass(milliseconds(100));
  relative.write_pair(313, -7000);
  ASSERT_TRUE(stands(relative));
  EXPECT_EQ(relative.pair(117), 50000);
}

TEST(Id286proMotion, RelativeMovesAddUpAndEveryWriteOf323IsANewTrigger) {
  RtuBench bench = a_stepper();
  bench.write_pair(313, -2500);
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(bench.write(323, 2), 0);
    ASSERT_TRUE(stands(bench));
    EXPECT_EQ(bench.pair(117), -2500 * i);
  }
  EXPECT_EQ(bench.id286pro().starts().size(), 3U);
}

TEST(Id286proMotion, ARelativeCommandWhileItMovesHasNoEffect) {
  RtuBench bench = a_stepper();
  bench.write_pair(313, 20000);
  bench.write(323, 2);
  bench.pass(milliseconds(50));
  EXPECT_EQ(bench.write(323, 2), 0);
  ASSERT_TRUE(stands(bench));
  EXPECT_EQ(bench.pair(117), 20000);
}

TEST(Id286proMotion, SpeedModeHasASignAndANewSpeedActsWithANewCommand) {
  RtuBench bench = a_stepper();
  bench.exchange(from_hex("01 06 01 33 FE 0C 38 5C"));  // -5 rev/s
  bench.exchange(from_hex("01 06 01 43 00 03 39 E3"));
  bench.pass(milliseconds(500));
  EXPECT_EQ(static_cast<std::int16_t>(bench.word(119)), -500);
  EXPECT_LT(bench.pair(117), 0);
  bench.write(307, 900);
  bench.pass(milliseconds(500));
  EXPECT_EQ(static_cast<std::int16_t>(bench.word(119)), -500);
  bench.write(323, 3);
  bench.pass(milliseconds(500));
  EXPECT_EQ(static_cast<std::int16_t>(bench.word(119)), 900);
  bench.write(307, 0);
  bench.write(323, 3);
  EXPECT_TRUE(stands(bench));
}

TEST(Id286proMotion, ANewSpeedActsAtOnceWhereThatIsChosen) {
  Id286proOptions options;
  options.speed_follows_register = true;
  RtuBench bench = a_stepper(options);
  bench.write(307, 500);
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.word(109), stopped);  // not while it stands
  bench.write(323, 3);
  bench.pass(milliseconds(100));
  bench.write(307, -700);
  bench.pass(milliseconds(200));
  EXPECT_EQ(static_cast<std::int16_t>(bench.word(119)), -700);
}

TEST(Id286proMotion, JogRunsBothWaysUntilAStop) {
  RtuBench bench = a_stepper();
  bench.write(308, 250);
  bench.write(323, 4);
  bench.pass(milliseconds(300));
  EXPECT_EQ(static_cast<std::int16_t>(bench.word(119)), 250);
  bench.write(323, 5);
  bench.pass(milliseconds(300));
  EXPECT_EQ(static_cast<std::int16_t>(bench.word(119)), -250);
  bench.write(323, 6);
  EXPECT_TRUE(stands(bench, milliseconds(100)));
}

TEST(Id286proMotion, ADeceleratedStopTakesItsRampAndAnEmergencyStopNone) {
  RtuBench bench = a_stepper();
  bench.write(307, 4000);
  bench.write(304, 100);
  bench.write(323, 3);
  bench.pass(std::chrono::seconds(1));
  bench.exchange(from_hex("01 06 01 43 00 06 F9 E0"));
  EXPECT_EQ(bench.word(109), running);
  const Time begun = bench.now;
  ASSERT_TRUE(stands(bench));
  EXPECT_NEAR(static_cast<double>((bench.now - begun).count()), 0.4e9, 0.02e9);  // 40 rev/s at 100 rev/s^2
  bench.write(323, 3);
  bench.pass(std::chrono::seconds(1));
  bench.exchange(from_hex("01 06 01 43 00 07 38 20"));
  EXPECT_EQ(bench.word(109), stopped);
  const std::int32_t here = bench.pair(117);
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.pair(117), here);
}

TEST(Id286proMotion, ThePositionIsSetOnlyWhileItStands) {
  RtuBench bench = a_stepper();
  bench.write_pair(321, 123456);
  EXPECT_EQ(bench.write(323, 8), 0);
  EXPECT_EQ(bench.pair(117), 123456);
  bench.write(323, 4);
  bench.pass(milliseconds(20));
  bench.write_pair(321, 0);
  EXPECT_EQ(bench.write(323, 8), 0);
  EXPECT_GT(bench.pair(117), 123000);
  EXPECT_EQ(bench.word(109), running);
}

TEST(Id286proMotion, ACommandAtTheWrongTimeIsAcknowledgedOrRefusedAsChosen) {
  Id286proOptions options;
  options.refuses_what_cannot_act = true;
  RtuBench bench = a_stepper(options);
  bench.write(323, 4);
  EXPECT_EQ(*bench.ask(write_pdu(323, 8)), (Bytes{0x86, 4}));
  EXPECT_EQ(*bench.ask(write_pdu(206, 3)), (Bytes{0x86, 4}));
  EXPECT_EQ(bench.write(323, 30), 3);
  EXPECT_EQ(bench.write(323, 6), 0);
}

TEST(Id286proMotion, MicrostepsScaleTheSpeed) {
  RtuBench bench = a_stepper();
  bench.write_pair(242, 200);
  bench.write(307, 1000);
  bench.write(323, 3);
  bench.pass(std::chrono::seconds(1));
  const std::int32_t before = bench.pair(117);
  bench.pass(std::chrono::seconds(1));
  EXPECT_NEAR(bench.pair(117) - before, 2000, 1);  // 10 rev/s of 200 pulses
}

TEST(Id286proMotion, TheCommandReadsBackOrClearsItself) {
  RtuBench bench = a_stepper();
  bench.write(323, 6);
  EXPECT_EQ(bench.word(323), 6);
  Id286proOptions options;
  options.command_reads_back = false;
  RtuBench clearing = a_stepper(options);
  clearing.write(323, 6);
  EXPECT_EQ(clearing.word(323), 0);
}

TEST(Id286proMotion, SetPointsAndStartInOneRequestActInTheirOrder) {
  RtuBench bench = a_stepper();
  // 0313..0323: target, unknown, limits, set position, command.
  EXPECT_EQ(bench.write_several(313, {3000, 0, 0, 0, 0x9400, 0x7735, 0x6C00, 0x88CA, 0, 0, 1}), 0);
  ASSERT_TRUE(stands(bench));
  EXPECT_EQ(bench.pair(117), 3000);
}

TEST(Id286proMotion, CommandsWithoutADescriptionDoNothing) {
  RtuBench bench = a_stepper();
  bench.write_pair(313, 5000);
  for (const int command : {0, 9, 10, 11, 14, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29}) {
    EXPECT_EQ(bench.write(323, command), 0) << command;
    bench.pass(milliseconds(10));
    EXPECT_EQ(bench.word(109), stopped) << command;
  }
  EXPECT_EQ(bench.pair(117), 0);
  EXPECT_TRUE(bench.id286pro().starts().empty());
}

TEST(Id286proMotion, StepsOfTimeDoNotMatter) {
  RtuBench coarse = a_stepper();
  RtuBench fine = a_stepper();
  for (RtuBench* bench : {&coarse, &fine}) {
    bench->write_pair(313, 123456);
    bench->write(323, 1);
  }
  coarse.pass(milliseconds(777));
  for (int i = 0; i < 7770; ++i) fine.pass(std::chrono::microseconds(100));
  EXPECT_EQ(coarse.pair(117), fine.pair(117));
  EXPECT_NE(coarse.pair(117), 0);
}

}  // namespace
}  // namespace axisgate::simulated
