// SPDX-License-Identifier: Apache-2.0
// What a CAN bus is planned with, by the shipped profiles: frames as long as they can be, requests only for what no
// TPDO brings, inhibit times that leave the line to requests; and what `check` says of it.
#include <gmock/gmock.h>

#include "gateway/check/check.hpp"
#include "gateway/config/config_sections.hpp"
#include "tests/unit/config/one_bus.hpp"

namespace axisgate::config {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string drive(const std::string& profile, int node) {
  return R"({"profile": ")" + profile + R"(", "node": )" + std::to_string(node) + R"(, "axes": [{"axis": )" +
         std::to_string(node) + "}]}";
}

std::string several(const std::string& profile, int count) {
  std::string out;
  for (int node = 1; node <= count; ++node) out += (node == 1 ? "" : ", ") + drive(profile, node);
  return out;
}

LoadedConfig load_bus(const std::string& drives, const std::string& more = R"(, "bitrate": 500000)",
                      const std::string& device = "can0") {
  return load_one_bus(R"("name": "cell", "adapter": "canopen", "device": ")" + device + '"' + more, drives);
}

TEST(CanBus, AFrameIsCountedWithEveryBitThatStuffingCanAdd) {
  EXPECT_EQ(can_frame_time(1000000, 8), microseconds(135));
  EXPECT_EQ(can_frame_time(500000, 8), microseconds(270));
  EXPECT_EQ(can_frame_time(1000000, 1), microseconds(65)) << "a heartbeat";
  EXPECT_EQ(can_frame_time(1000000, 0), microseconds(55)) << "a guarding request";
}

TEST(CanBus, AnExchangeIsTwoFramesAndTheServersTime) {
  const LoadedConfig loaded = load_bus(drive("kinco-jd", 1));
  EXPECT_EQ(timing_of(bus_of(loaded)).on_wire, microseconds(540));
  EXPECT_EQ(plan_of(loaded).exchange, microseconds(1540));
  EXPECT_EQ(plan_of(loaded).stop_wait, microseconds(1810)) << "and a frame that another node has begun";
  EXPECT_EQ(plan_of(loaded).stop_wait_unresponsive, bus_of(loaded).timeout + microseconds(270));
}

TEST(CanBus, WhatComesByTpdoIsOnlyConfirmed) {
  const LoadedConfig loaded = load_bus(drive("leadshine-ld2-can", 1));
  const BusBudget budget = plan_of(loaded);
  EXPECT_EQ(budget.classes[0].reads, 0) << "statusword and position";
  EXPECT_EQ(budget.confirmed.reads, 8);
  EXPECT_EQ(budget.confirmed.period, milliseconds(1000));
  EXPECT_GT(budget.load_unmapped, 2 * budget.load_answered);
  EXPECT_FALSE(budget.overloaded());
}

TEST(CanBus, TpdosAndHeartbeatsTakeTheirShare) {
  BusTiming timing = timing_of(BusConfig{});
  timing.can_bitrate = 1000000;
  model::DriveModel model;
  model.protocol = "canopen";
  model.objects.resize(2);
  model.objects[0].size = 4;
  model.objects[1].size = 4;
  model.canopen.tpdos.push_back({1, {0, 1}, 255, 50, milliseconds(5), {}});
  EXPECT_EQ(plan_bus(timing, {model}).load_unsolicited, 27) << "135 us each 5 ms";
  model.canopen.tpdos[0].event_ms = 1;
  EXPECT_EQ(plan_bus(timing, {model}).load_unsolicited, 135) << "the timer comes before the inhibit time is over";
  model.canopen.tpdos[0].type = 2;
  model.canopen.sync = milliseconds(5);
  EXPECT_EQ(plan_bus(timing, {model}).load_unsolicited, 25) << "each second SYNC, 135 us in 10 ms, and SYNC itself";
  model.canopen.tpdos.clear();
  model.canopen.sync = {};
  model.canopen.heartbeat = milliseconds(10);
  model.canopen.own_heartbeat = milliseconds(10);
  EXPECT_EQ(plan_bus(timing, {model, model}).load_unsolicited, 20) << "two of them, and one of ours";
  model.canopen.heartbeat = {};
  model.canopen.own_heartbeat = {};
  model.canopen.guard_time = milliseconds(10);
  EXPECT_EQ(plan_bus(timing, {model}).load_unsolicited, 12);
}

TEST(CanBus, FewDrivesKeepTheirInhibitTimes) {
  const LoadedConfig loaded = load_bus(several("leadshine-ld2-can", 4));
  EXPECT_EQ(loaded.models.at(0).at(0).canopen.tpdos.at(0).inhibit, 50);
  EXPECT_THAT(bus_of(loaded).poll, ElementsAre(milliseconds(20), milliseconds(100), milliseconds(1000)));
}

TEST(CanBus, TpdosOfManyDrivesLeaveTheLineToRequests) {
  for (const std::string profile : {"leadshine-ld2-can", "kinco-jd", "kinco-md"}) {
    const LoadedConfig loaded = load_bus(several(profile, 30));
    const BusBudget budget = plan_of(loaded);
    EXPECT_LE(budget.load_unsolicited, kUnsolicitedPermille + 50) << profile << ": heartbeats are not stretched";
    const model::TpdoProperties& tpdo = loaded.models.at(0).at(0).canopen.tpdos.at(0);
    const model::TpdoProperties alone = load_bus(drive(profile, 1)).models.at(0).at(0).canopen.tpdos.at(0);
    EXPECT_GT(*tpdo.inhibit, *alone.inhibit);
    EXPECT_EQ(tpdo.inhibit_time / *tpdo.inhibit, alone.inhibit_time / *alone.inhibit) << "of the same unit";
    EXPECT_FALSE(budget.overloaded()) << profile;
  }
}

TEST(CanBus, TpdosAreSlowedDownByWholeStepsUntilTheyFitAndNoTimeWraps) {
  for (const std::size_t count : {10U, 14U, 18U, 22U, 26U}) {
    LoadedConfig loaded = load_bus(drive("leadshine-ld2-can", 1));
    std::vector<std::vector<model::DriveModel>> models{{count, loaded.models.at(0).at(0)}};
    model::TpdoProperties& slow = models[0][0].canopen.tpdos.at(3);
    slow.inhibit_time = slow.inhibit_time / *slow.inhibit * 40000;
    slow.inhibit = 40000;
    ConfigFaults faults("gateway.json");
    settle_can_buses(loaded.config, models, faults);
    const BusBudget budget = plan_bus(timing_of(bus_of(loaded)), models[0]);
    EXPECT_LE(budget.load_unsolicited, kUnsolicitedPermille + 10) << count << ": heartbeats are not stretched";
    EXPECT_TRUE(*slow.inhibit == 40000 || *slow.inhibit == 0xFFFF) << *slow.inhibit;
  }
}

TEST(CanBus, DefaultPeriodsOfManyDrivesFitTheLine) {
  const LoadedConfig loaded = load_bus(several("kinco-md", 60), R"(, "bitrate": 20000)");
  EXPECT_LE(plan_of(loaded).load_answered, 1000);
  EXPECT_GT(bus_of(loaded).poll[0], milliseconds(20));
  EXPECT_EQ(loaded.models.at(0).at(0).poll_period, bus_of(loaded).poll);
}

TEST(CanBus, TheDefaultsFollowFromTheDrives) {
  const LoadedConfig loaded = load_bus(drive("kinco-jd", 1), "");
  const BusConfig& bus = bus_of(loaded);
  EXPECT_EQ(bus.timeout, milliseconds(101)) << "100 for the drive, and 0.54 on the line";
  EXPECT_EQ(bus.min_gap, Duration{});
  EXPECT_EQ(bus.settle, Duration{});
  EXPECT_FALSE(bus.bitrate_given);
  EXPECT_EQ(bus.bitrate, 500000U);
  EXPECT_EQ(bus_of(load_bus(drive("kinco-jd", 1), R"(, "bitrate": 10000)")).timeout, milliseconds(127));
}

TEST(CanBus, AnOddRateIsAWarning) {
  const LoadedConfig loaded = load_bus(drive("kinco-jd", 1), R"(, "bitrate": 83333)");
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("/buses/0/bitrate: 83333 is not among the bit rates of CiA 301")));
}

TEST(CanBus, TheIdentityReachesTheModel) {
  std::string text = drive("kinco-jd", 1);
  text.insert(text.size() - 1, R"(, "identity": {"product": 7, "serial": 4294967295})");
  EXPECT_THAT(load_bus(text).models.at(0).at(0).canopen.identity,
              ElementsAre(std::nullopt, 7U, std::nullopt, 4294967295U));
}

TEST(CanBus, CheckTellsHowTheInterfaceIsBroughtUp) {
  const std::string given = check::report(load_bus(drive("kinco-jd", 1), R"(, "bitrate": 250000)")).text;
  EXPECT_THAT(given, HasSubstr("Bus cell: canopen on can0, 250000 bit/s\n"));
  EXPECT_THAT(given, HasSubstr("interface       bring it up as root: ip link set can0 up type can bitrate 250000 "
                               "restart-ms 100\n"));
  const std::string open = check::report(load_bus(drive("kinco-jd", 1), "")).text;
  EXPECT_THAT(open, HasSubstr("Bus cell: canopen on can0, 500000 bit/s assumed\n"));
  EXPECT_THAT(open, HasSubstr("with the bit rate of the drives"));
  const std::string adapter =
      check::report(load_bus(drive("kinco-jd", 1), R"(, "bitrate": 250000)", "slcan:/dev/ttyACM0")).text;
  EXPECT_THAT(adapter, AllOf(HasSubstr("a serial CAN adapter, which the gateway opens at 250000 bit/s"),
                             Not(HasSubstr("ip link"))));
}

TEST(CanBus, CheckTellsWhatComesByItselfAndWhatIsOnlyTried) {
  const std::string report =
      check::report(load_bus(drive("kinco-jd", 1) + ", " + drive("kinco-jd", 2) + ", " + drive("kinco-md", 9))).text;
  EXPECT_THAT(report, HasSubstr("by TPDO         nodes 1, 2: statusword, position_actual at most each 5 ms; "));
  EXPECT_THAT(report, HasSubstr("                node 9: position_actual, statusword at most each 5 ms, at least each "
                                "20 ms; "));
  EXPECT_THAT(report, HasSubstr("the mapping is tried at bring-up: what a drive refuses is polled by SDO"));
  EXPECT_THAT(report, HasSubstr("watched by      nodes 1, 2: heartbeat each 1000 ms\n"));
  EXPECT_THAT(report, HasSubstr("node 9: guarded each 500 ms, gone after 3\n"));
  EXPECT_THAT(report, HasSubstr("values that come by TPDO, each read by SDO where it was silent for 1000 ms"));
  EXPECT_THAT(report, HasSubstr("with drives that answer after 1 ms"));
  EXPECT_THAT(report, HasSubstr("without any mapping the polls would take"));
}

TEST(CanBus, CheckTellsHowADriveNoticesADeadGateway) {
  const std::string report = check::report(load_bus(drive("kinco-jd", 1) + ", " + drive("kinco-md", 9))).text;
  EXPECT_THAT(
      report,
      HasSubstr("gateway dies    WHETHER IT STOPS BY ITSELF IS NOT KNOWN: the drive is told to notice (1016h:01), "
                "which is verified at bring-up: the manual names 1016h without a word"));
  EXPECT_THAT(report,
              HasSubstr("gateway dies    it begins to stop by itself within 1500 ms: the drive is told to notice "
                        "(100Ch:00, 100Dh:00, 6007h:00)"));
  EXPECT_THAT(report, Not(HasSubstr("DOES NOT STOP")));
}

}  // namespace
}  // namespace axisgate::config
