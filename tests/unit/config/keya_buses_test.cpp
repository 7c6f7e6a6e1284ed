// SPDX-License-Identifier: Apache-2.0
// What a bus with Keya drives is planned with, by the shipped profile: one query for the values of both motors, control
// frames that nobody answers, keep-alives and heartbeats; and what `check` says of it.
#include <gmock/gmock.h>

#include "gateway/check/check.hpp"
#include "tests/unit/config/one_bus.hpp"

namespace axisgate::config {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string keya(int node) {
  return R"({"profile": "keya-kydas4860-2e", "node": )" + std::to_string(node) + R"(, "axes": [{"axis": )" +
         std::to_string(2 * node) + R"(}, {"axis": )" + std::to_string(2 * node + 1) + "}]}";
}

LoadedConfig load_keya(const std::string& adapter, const std::string& drives, const std::string& more = "") {
  return load_one_bus(R"("name": "agv", "device": "agv0", "adapter": ")" + adapter + '"' + more, drives);
}

TEST(KeyaBus, AFrameOnCanIsCountedWithEveryBitThatStuffingCanAdd) {
  EXPECT_EQ(extended_frame_time(1000000, 8), microseconds(160));
  EXPECT_EQ(extended_frame_time(250000, 8), microseconds(640));
  EXPECT_EQ(extended_frame_time(1000000, 0), microseconds(80));
}

TEST(KeyaBus, HasTheRatesOfItsFactoryWhereNoneAreGiven) {
  EXPECT_EQ(bus_of(load_keya("keya-can", keya(1))).bitrate, 250000U);
  EXPECT_EQ(bus_of(load_keya("keya-rs232", keya(1))).baud, 115200U);
  EXPECT_EQ(bus_of(load_keya("keya-rs485", keya(1))).baud, 115200U);
  EXPECT_EQ(bus_of(load_keya("keya-can", keya(1), R"(, "bitrate": 500000)")).bitrate, 500000U);
  EXPECT_EQ(bus_of(load_keya("keya-rs485", keya(1), R"(, "baud": 9600)")).baud, 9600U);
}

TEST(KeyaBus, NeedsNoNodeWhereFramesCarryNone) {
  const LoadedConfig loaded =
      load_keya("keya-rs232", R"({"profile": "keya-kydas4860-2e", "axes": [{"axis": 1}, {"axis": 2}]})");
  EXPECT_EQ(loaded.models.at(0).at(0).node, 1);
}

TEST(KeyaBus, AnExchangeIsTwoFramesAndAControlFrameIsOne) {
  const BusTiming serial = timing_of(bus_of(load_keya("keya-rs485", keya(1), R"(, "baud": 9600)")));
  EXPECT_EQ(serial.on_wire, milliseconds(25));
  EXPECT_EQ(serial.control, microseconds(12500));
  const BusTiming can = timing_of(bus_of(load_keya("keya-can", keya(1))));
  EXPECT_EQ(can.on_wire, microseconds(1280));
  EXPECT_EQ(can.control, Duration{}) << "a write is acknowledged on CAN";
}

TEST(KeyaBus, SilencePartsFramesOnASerialLineAndNotOnCan) {
  EXPECT_EQ(bus_of(load_keya("keya-rs485", keya(1), R"(, "baud": 9600)")).min_gap, Duration(milliseconds(25)) / 6);
  EXPECT_EQ(bus_of(load_keya("keya-rs485", keya(1), R"(, "min_gap_ms": 3)")).min_gap, milliseconds(3));
  EXPECT_EQ(bus_of(load_keya("keya-rs485", keya(1))).settle, milliseconds(10));
  EXPECT_EQ(bus_of(load_keya("keya-can", keya(1))).min_gap, Duration{});
  EXPECT_EQ(bus_of(load_keya("keya-can", keya(1))).settle, Duration{});
}

TEST(KeyaBus, ItsTimeoutIsTheLineAndWhatTheProfileStates) {
  EXPECT_EQ(bus_of(load_keya("keya-rs485", keya(1), R"(, "baud": 9600)")).timeout, milliseconds(125));
  EXPECT_EQ(bus_of(load_keya("keya-can", keya(1))).timeout, milliseconds(102));
  EXPECT_EQ(bus_of(load_keya("keya-can", keya(1), R"(, "timeout_ms": 40)")).timeout, milliseconds(40));
}

TEST(KeyaBus, OneQueryBringsTheValuesOfBothMotors) {
  const BusBudget both = plan_of(load_keya("keya-rs485", keya(1)));
  const BusBudget one =
      plan_of(load_keya("keya-rs485", R"({"profile": "keya-kydas4860-2e", "node": 1, "axes": [{"axis": 1}]})"));
  ASSERT_GT(one.classes[0].reads, 0);
  for (std::size_t i = 0; i < both.classes.size(); ++i) EXPECT_EQ(both.classes[i].reads, one.classes[i].reads) << i;
}

TEST(KeyaBus, KeepAlivesAreLoadOneWriteForEachAxis) {
  const LoadedConfig rs232 = load_keya("keya-rs232", keya(1));
  const BusBudget serial = plan_of(rs232);
  const Duration every = rs232.models[0][0].keep_alive;
  ASSERT_GT(every, Duration{});
  EXPECT_EQ(serial.kept_alive.reads, 2);
  EXPECT_EQ(serial.kept_alive.period, every);
  const BusTiming timing = timing_of(bus_of(rs232));
  EXPECT_EQ(serial.kept_alive.answered, 2 * (timing.control + timing.min_gap)) << "nobody answers a control frame";

  const LoadedConfig on_can = load_keya("keya-can", keya(1) + ", " + keya(2));
  const BusBudget can = plan_of(on_can);
  EXPECT_EQ(can.kept_alive.reads, 4);
  EXPECT_EQ(can.kept_alive.answered, 4 * (timing_of(bus_of(on_can)).on_wire + kAssumedAnswer));
  EXPECT_GT(can.load_fixed(), can.load_confirmed());
}

TEST(KeyaBus, NothingKeepsADriveEnabledWhereItHasNoWatchdog) {
  EXPECT_EQ(plan_of(load_keya("keya-rs485", keya(1))).kept_alive.reads, 0);
}

TEST(KeyaBus, HeartbeatsAreLoadWhereTheDriveSendsThem) {
  // 640 us of each second, in 0.1 %, rounded up; two drives send two.
  EXPECT_EQ(plan_of(load_keya("keya-can", keya(1))).load_unsolicited, 1);
  EXPECT_EQ(plan_of(load_keya("keya-can", keya(1) + ", " + keya(2))).load_unsolicited, 2);
  // Nobody has stated how often on RS232: 1.04 ms in 100 ms are assumed.
  EXPECT_EQ(plan_of(load_keya("keya-rs232", keya(1))).load_unsolicited, 11);
  EXPECT_EQ(plan_of(load_keya("keya-rs485", keya(1))).load_unsolicited, 0);
}

TEST(KeyaBus, ItsPeriodsLeaveRoomForCommandsHoweverManyDrivesShareIt) {
  for (const char* baud : {"9600", "19200", "115200"}) {
    const std::string more = std::string(R"(, "baud": )") + baud;
    const LoadedConfig loaded = load_keya("keya-rs485", keya(1) + ", " + keya(2) + ", " + keya(3), more);
    EXPECT_LE(plan_of(loaded).load_answered, kComfortablePermille) << baud;
    EXPECT_EQ(loaded.models[0][2].poll_period, bus_of(loaded).poll) << baud;
  }
  std::string many;
  for (int node = 1; node <= 8; ++node) many += (node == 1 ? "" : ", ") + keya(node);
  EXPECT_LE(plan_of(load_keya("keya-can", many, R"(, "bitrate": 125000)")).load_answered, kComfortablePermille);
}

TEST(KeyaBus, PeriodsThatAreGivenAreKept) {
  const LoadedConfig loaded = load_keya("keya-can", keya(1), R"(, "poll": {"fast": 10, "normal": 15, "slow": 30})");
  EXPECT_THAT(bus_of(loaded).poll, ElementsAre(milliseconds(10), milliseconds(15), milliseconds(30)));
  EXPECT_TRUE(check::report(loaded).overloaded);
}

TEST(KeyaBus, CheckTellsHowToBringTheInterfaceUpAndWhatGoesOverTheLineUnasked) {
  EXPECT_THAT(
      check::report(load_keya("keya-can", keya(1))).text,
      AllOf(HasSubstr("Bus agv: keya-can on agv0, 250000 bit/s assumed\n"),
            HasSubstr("ip link set agv0 up type can bitrate 250000"), HasSubstr("keep-alive      2 writes each"),
            HasSubstr("heartbeats of the drives: 0.1 % of the line")));
  EXPECT_THAT(check::report(load_keya("keya-rs485", keya(1))).text,
              AllOf(HasSubstr("Bus agv: keya-rs485 on agv0, 115200 baud\n"), Not(HasSubstr("keep-alive")),
                    Not(HasSubstr("heartbeats of the drives")), HasSubstr("DOES NOT STOP BY ITSELF on keya-rs485")));
}

}  // namespace
}  // namespace axisgate::config
