// The simulated Keya itself: its watchdog, its motors, its faults, and each point the manual leaves open.
#include <gmock/gmock.h>

#include "tests/unit/simulated/keya_bench.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint16_t enable = 0x200D, disable = 0x200C, speed = 0x2000, torque = 0x2001, position = 0x2002;
constexpr std::int64_t absolute_mode = 3, relative_mode = 4;

std::map<int, std::int64_t> both_in(std::int64_t mode) { return {{20, mode}, {50, mode}}; }

TEST(KeyaWatchdog, OnCanItTripsAfterAThousandMillisecondsWithoutACommandAndNotBefore) {
  KeyaCanBench bench(a_keya());
  ASSERT_TRUE(bench.write(enable, 1));
  ASSERT_TRUE(bench.write(speed, 1, 5000));
  bench.pass(milliseconds(999));
  EXPECT_EQ(bench.drive().faults(motor_a), 0);
  ASSERT_TRUE(bench.write(speed, 1, 5000));
  bench.pass(milliseconds(1000));
  EXPECT_EQ(bench.drive().trips(), 0U);
  bench.pass(milliseconds(1));
  EXPECT_EQ(bench.drive().trips(), 1U);
  EXPECT_EQ(bench.drive().faults(motor_a), 0x4001);
  EXPECT_EQ(bench.drive().faults(motor_b), 0x4001);
  EXPECT_FALSE(bench.drive().enabled(motor_a));
  EXPECT_EQ(bench.ask("40 12 21 01 00 00 00 00"), from_hex("60 12 21 01 40 01 40 01"));
}

TEST(KeyaWatchdog, AfterItACommandMovesNothingUntilANewEnable) {
  KeyaCanBench bench(a_keya());
  ASSERT_TRUE(bench.write(enable, 1));
  ASSERT_TRUE(bench.write(speed, 1, 5000));
  bench.pass(milliseconds(5000));
  EXPECT_EQ(bench.drive().at(motor_a).rpm(), 0);
  EXPECT_TRUE(bench.write(speed, 1, 5000));
  bench.pass(milliseconds(500));
  EXPECT_EQ(bench.drive().at(motor_a).rpm(), 0);
  EXPECT_TRUE(bench.write(enable, 1));
  EXPECT_EQ(bench.drive().faults(motor_a), 0);
  bench.pass(milliseconds(500));
  EXPECT_EQ(bench.drive().at(motor_a).rpm(), 0);  // the old value is gone
  EXPECT_TRUE(bench.write(speed, 1, 5000));
  bench.pass(milliseconds(500));
  EXPECT_GT(bench.drive().at(motor_a).rpm(), 0);
  EXPECT_EQ(bench.drive().trips(), 1U);
}

TEST(KeyaWatchdog, ACommandToOneMotorFeedsBoth) {
  KeyaCanBench bench(a_keya());
  ASSERT_TRUE(bench.write(enable, 1));
  ASSERT_TRUE(bench.write(enable, 2));
  for (int i = 0; i < 5; ++i) {
    bench.pass(milliseconds(900));
    ASSERT_TRUE(bench.write(speed, 2, 0));
  }
  EXPECT_TRUE(bench.drive().enabled(motor_a));
  EXPECT_EQ(bench.drive().trips(), 0U);
}

TEST(KeyaWatchdog, QueriesFeedItOnlyWhereATestWantsThat) {
  for (const bool feed : {false, true}) {
    KeyaOptions options = a_keya();
    options.queries_feed_watchdog = feed;
    KeyaCanBench bench(options);
    ASSERT_TRUE(bench.write(enable, 1));
    for (int i = 0; i < 20; ++i) {
      bench.pass(milliseconds(100));
      ASSERT_TRUE(bench.ask("40 03 21 01 00 00 00 00"));
    }
    EXPECT_EQ(bench.drive().enabled(motor_a), feed);
    EXPECT_EQ(bench.drive().trips(), feed ? 0U : 1U);
  }
}

TEST(KeyaWatchdog, ItSleepsWhileNoMotorIsEnabled) {
  KeyaCanBench bench(a_keya());
  ASSERT_TRUE(bench.write(enable, 1));
  ASSERT_TRUE(bench.write(disable, 1));
  bench.pass(milliseconds(10000));
  EXPECT_EQ(bench.drive().trips(), 0U);
  EXPECT_EQ(bench.drive().faults(motor_a), 0x0001);
}

TEST(KeyaWatchdog, OnRs232ItIsFaultSixteenAndOnRs485ThereIsNone) {
  KeyaBench rs232(KeyaWiring::rs232, {a_keya()});
  rs232.control(3, 1000, 1000);
  rs232.pass(milliseconds(999));
  EXPECT_EQ(rs232.drive().trips(), 0U);
  rs232.pass(milliseconds(2));
  EXPECT_EQ(rs232.drive().faults(motor_a), 0x8001);
  EXPECT_EQ(rs232.drive().faults(motor_b), 0x8001);
  KeyaBench rs485(KeyaWiring::rs485, {a_keya()});
  rs485.control_at(1, 3, 1000, 1000);
  rs485.pass(std::chrono::seconds(60));
  EXPECT_EQ(rs485.drive().faults(motor_a), 0);
  EXPECT_EQ(rs485.drive().at(motor_a).rpm(), 150);
}

TEST(KeyaWatchdog, TheMotorCoastsOrRampsDownAndTheBrakeFalls) {
  std::map<KeyaStop, std::int32_t> ways;
  for (const KeyaStop stop : {KeyaStop::coast, KeyaStop::ramp}) {
    KeyaOptions options = a_keya({{13, 1}, {30, 2}, {27, 10}});  // 0.1 s up, 0.2 s down, brake after 1 s
    options.loss_stop = stop;
    options.mechanics.coasting_rps_per_s = 5;
    KeyaCanBench bench(options);
    ASSERT_TRUE(bench.write(enable, 1));
    ASSERT_TRUE(bench.write(speed, 1, 10000));
    bench.pass(milliseconds(1001));
    ASSERT_EQ(bench.drive().trips(), 1U);
    const std::int32_t from = bench.drive().at(motor_a).count();
    bench.pass(milliseconds(900));
    EXPECT_EQ(bench.drive().at(motor_a).rpm() == 0, stop == KeyaStop::ramp);
    bench.pass(milliseconds(200));
    EXPECT_EQ(bench.drive().at(motor_a).rpm(), 0);  // 25 turns/s at 5 turns/s^2 would have taken 5 s
    ways[stop] = bench.drive().at(motor_a).count() - from;
  }
  EXPECT_GT(ways[KeyaStop::coast], 3 * ways[KeyaStop::ramp]);
}

TEST(KeyaMotion, ASpeedRampsUpInTheTimeOfParameter0013) {
  KeyaCanBench bench(a_keya({{13, 10}, {2, 3000}}));
  ASSERT_TRUE(bench.write(enable, 1));
  ASSERT_TRUE(bench.write(speed, 1, -10000));
  bench.pass(milliseconds(500));
  EXPECT_NEAR(bench.drive().at(motor_a).rpm(), -1500, 10);
  bench.pass(milliseconds(490));
  ASSERT_TRUE(bench.write(speed, 1, -10000));
  bench.pass(milliseconds(20));
  EXPECT_EQ(bench.drive().at(motor_a).rpm(), -3000);
}

TEST(KeyaMotion, TorqueTurnsAMotorThatIsInTorqueModeAlone) {
  KeyaCanBench bench(a_keya({{20, 2}}));
  ASSERT_TRUE(bench.write(enable, 1));
  ASSERT_TRUE(bench.write(enable, 2));
  ASSERT_TRUE(bench.write(torque, 1, -8000));
  ASSERT_TRUE(bench.write(torque, 2, -8000));
  ASSERT_TRUE(bench.write(speed, 1, 5000));  // of another mode: without effect
  bench.pass(milliseconds(100));
  EXPECT_LT(bench.drive().at(motor_a).rpm(), 0);
  EXPECT_EQ(bench.drive().at(motor_a).current(), 12);
  EXPECT_EQ(bench.drive().at(motor_b).rpm(), 0);
}

TEST(KeyaMotion, AbsolutePositionsAreReachedExactlyAndRepeatingThemMovesNothing) {
  KeyaCanBench bench(a_keya(both_in(absolute_mode)));
  bench.drive().at(motor_a).set_count(-500);
  ASSERT_TRUE(bench.write(enable, 1));
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(bench.write(position, 1, 50000));
    bench.pass(milliseconds(500));
  }
  EXPECT_EQ(bench.drive().at(motor_a).count(), 50000);
  EXPECT_EQ(bench.drive().moves(motor_a), 1U);
}

TEST(KeyaMotion, TheSameRelativePositionAgainIsAnotherMoveUnlessATestSaysNo) {
  for (const bool again : {true, false}) {
    KeyaOptions options = a_keya(both_in(relative_mode));
    options.repeated_move_moves = again;
    KeyaCanBench bench(options);
    ASSERT_TRUE(bench.write(enable, 2));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(bench.write(position, 2, -18000));
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(bench.write(position, 1, 0));  // feeds, for a motor that is disabled
      bench.pass(milliseconds(500));
    }
    EXPECT_EQ(bench.drive().at(motor_b).count(), again ? -54000 : -18000);
    EXPECT_EQ(bench.drive().moves(motor_b), again ? 3U : 1U);
  }
}

TEST(KeyaSerialEnable, AZeroInTheEnablingFrameIsAMoveToZeroUnlessATestSaysNo) {
  for (const bool moves : {true, false}) {
    KeyaOptions options = a_keya(both_in(absolute_mode));
    options.enable_with_zero_moves = moves;
    KeyaBench bench(KeyaWiring::rs485, {options});
    bench.drive().at(motor_a).set_count(7000);
    bench.control_at(1, 1);
    bench.pass(milliseconds(5000));
    EXPECT_EQ(bench.drive().at(motor_a).count(), moves ? 0 : 7000);
    bench.control_at(1, 1, 0);  // a second one is a command in either reading
    bench.pass(milliseconds(5000));
    EXPECT_EQ(bench.drive().at(motor_a).count(), 0);
  }
}

TEST(KeyaSerialEnable, CodeOneDisablesMotorBUnlessATestSaysNo) {
  for (const bool disables : {true, false}) {
    KeyaOptions options = a_keya();
    options.code_disables_other = disables;
    KeyaBench bench(KeyaWiring::rs232, {options});
    bench.control(3, 1000, 2000);
    bench.control(1, 1000, 2000);
    EXPECT_TRUE(bench.drive().enabled(motor_a));
    EXPECT_EQ(bench.drive().enabled(motor_b), !disables);
    bench.control(2, 1000, 2000);
    EXPECT_EQ(bench.drive().enabled(motor_a), !disables);
    EXPECT_TRUE(bench.drive().enabled(motor_b));
    bench.control(0);
    EXPECT_FALSE(bench.drive().enabled(motor_a));
    EXPECT_FALSE(bench.drive().enabled(motor_b));
  }
}

TEST(KeyaMixedMode, ExecutesTheNineRowsOfTheManual) {
  struct Row {
    std::int32_t given_a, given_b, motor_1, motor_2;
  };
  const Row rows[] = {{0, 0, 0, 0},
                      {1000, 0, 1000, 1000},
                      {1000, 500, 1500, 500},
                      {1000, -500, 500, 1500},
                      {0, 5000, 5000, -5000},
                      {0, -8000, -8000, 8000},
                      {8000, -8000, 0, 10000},
                      {10000, 2000, 10000, 8000},
                      {-10000, 2000, -8000, -10000}};
  for (const Row& row : rows) {
    KeyaCanBench can(a_keya({{17, 1}}));
    ASSERT_TRUE(can.write(enable, 1));
    EXPECT_TRUE(can.drive().enabled(motor_b));  // motor A enables both
    ASSERT_TRUE(can.write(speed, 1, row.given_a));
    ASSERT_TRUE(can.write(speed, 2, row.given_b));
    EXPECT_EQ(can.drive().at(motor_a).value(), row.motor_1);
    EXPECT_EQ(can.drive().at(motor_b).value(), row.motor_2);
    KeyaBench serial(KeyaWiring::rs232, {a_keya({{17, 1}})});
    serial.control(1, row.given_a, row.given_b);
    EXPECT_EQ(serial.drive().at(motor_a).value(), row.motor_1);
    EXPECT_EQ(serial.drive().at(motor_b).value(), row.motor_2);
  }
}

TEST(KeyaMixedMode, TheFaultOfOneMotorStopsBoth) {
  KeyaCanBench bench(a_keya({{17, 1}}));
  ASSERT_TRUE(bench.write(enable, 1));
  bench.drive().inject_fault(motor_b, 0x0800);
  EXPECT_EQ(bench.drive().faults(motor_b), 0x0801);
  EXPECT_EQ(bench.drive().faults(motor_a), 0x0201);
}

TEST(KeyaFaults, EachGoesInTheWayTheManualSays) {
  KeyaCanBench bench(a_keya());
  const auto word = [&] { return bench.drive().faults(motor_a); };
  ASSERT_TRUE(bench.write(enable, 1));
  bench.drive().inject_fault(motor_a, 0x0856);  // overvoltage, hardware overcurrent, undervoltage, overcurrent, Hall
  EXPECT_EQ(word(), 0x0857);
  EXPECT_EQ(bench.drive().faults(motor_b), 0x0001);
  EXPECT_TRUE(bench.write(enable, 1));  // acknowledged, without effect
  EXPECT_FALSE(bench.drive().enabled(motor_a));
  EXPECT_TRUE(bench.write(disable, 1));
  EXPECT_EQ(word(), 0x0857);  // the causes are still there
  bench.drive().clear_fault_cause(motor_a, 0x0856);
  EXPECT_EQ(word(), 0x0845);  // the voltage's go by themselves
  EXPECT_TRUE(bench.write(disable, 1));
  EXPECT_EQ(word(), 0x0005);
  EXPECT_TRUE(bench.write(enable, 1));
  EXPECT_FALSE(bench.drive().enabled(motor_a));  // this one wants the power off
  bench.line().restart(0, bench.now);
  bench.pass(milliseconds(1001));
  EXPECT_EQ(word(), 0x0001);
  EXPECT_TRUE(bench.write(enable, 1));
  EXPECT_TRUE(bench.drive().enabled(motor_a));
}

TEST(KeyaRestart, DisablesBothIsSilentWhileItBootsAndForgetsTheCountsUnlessATestSaysNo) {
  for (const bool keeps : {false, true}) {
    KeyaOptions options = a_keya();
    options.keeps_counts = keeps;
    KeyaCanBench bench(options);
    bench.drive().at(motor_a).set_count(1234);
    ASSERT_TRUE(bench.write(enable, 1));
    ASSERT_TRUE(bench.write(enable, 2));
    bench.line().restart(0, bench.now);
    EXPECT_FALSE(bench.write(enable, 1));
    bench.pass(milliseconds(1001));
    EXPECT_EQ(bench.drive().faults(motor_a), 0x0001);
    EXPECT_EQ(bench.drive().faults(motor_b), 0x0001);
    EXPECT_EQ(bench.drive().at(motor_a).count(), keeps ? 1234 : 0);
    EXPECT_TRUE(bench.write(enable, 1));
    EXPECT_EQ(bench.drive().restarts(), 1U);
  }
}

TEST(KeyaParameters, RefusesWhatTheManualDoesNotHave) {
  EXPECT_THROW(KeyaDrive(a_keya({{20, 5}}), KeyaInterface::can), std::invalid_argument);
  EXPECT_THROW(KeyaDrive(a_keya({{99, 1}}), KeyaInterface::can), std::invalid_argument);
  EXPECT_EQ(KeyaDrive(a_keya(), KeyaInterface::rs485).parameters().get(19), 7);
}

}  // namespace
}  // namespace axisgate::simulated
