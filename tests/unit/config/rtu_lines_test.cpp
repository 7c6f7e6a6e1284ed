// SPDX-License-Identifier: Apache-2.0
// What a Modbus RTU line is planned with, by the shipped profiles: lengths of its own for each exchange, runs of
// registers as one request, and timeouts and periods that follow from the drives on it.
#include <gmock/gmock.h>

#include "gateway/check/check.hpp"
#include "tests/unit/config/one_bus.hpp"

namespace axisgate::config {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kStepper = R"({"profile": "id286pro", "node": 3, "axes": [{"axis": 3}]})";
constexpr const char* kJd =
    R"({"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1}]})";

LoadedConfig load_line(const std::string& drives, const std::string& more = "") {
  return load_one_bus(R"("name": "line-a", "adapter": "modbus-rtu", "device": "/dev/ttyS1")" + more, drives);
}

std::string both() { return std::string(kJd) + ", " + kStepper; }

/// At 19200 baud without parity; the frames of both directions together.
constexpr Duration characters(int count) { return Duration(std::chrono::seconds(1)) * (count * 10) / 19200; }

bus::Exchange read_of(std::uint16_t index, std::uint8_t size) { return {3, bus::Access::read, {index, 0}, size, 0}; }

TEST(RtuLine, AnExchangeTakesWhatItsFramesAreLong) {
  const BusTiming timing = timing_of(bus_of(load_line(kStepper)));
  EXPECT_EQ(wire_time_of(timing, read_of(109, 2)), characters(8 + 7));
  EXPECT_EQ(wire_time_of(timing, read_of(117, 4)), characters(8 + 9));
  EXPECT_EQ(wire_time_of(timing, {3, bus::Access::write, {323, 0}, 2, 6}), characters(8 + 8));
  EXPECT_EQ(wire_time_of(timing, {3, bus::Access::write, {313, 0}, 4, 6}), characters(13 + 8));
  EXPECT_EQ(timing.on_wire, characters(13 + 8)) << "the longest that any object by itself takes";
}

TEST(RtuLine, AParityBitIsTimeOfTheLine) {
  const BusTiming plain = timing_of(bus_of(load_line(kStepper)));
  const BusTiming even = timing_of(bus_of(load_line(kStepper, R"(, "parity": "even")")));
  EXPECT_EQ(wire_time_of(even, read_of(109, 2)).count(), wire_time_of(plain, read_of(109, 2)).count() * 11 / 10);
}

TEST(RtuLine, OnKincosProtocolEveryExchangeTakesTheSame) {
  BusConfig bus;
  bus.adapter = "kinco-serial";
  const BusTiming timing = timing_of(bus);
  EXPECT_EQ(wire_time_of(timing, read_of(0x6041, 2)), wire_time_of(timing, read_of(0x6064, 4)));
  EXPECT_EQ(wire_time_of(timing, read_of(0x6041, 2)), timing.on_wire);
}

TEST(RtuLine, NeighbouringRegistersAreOneRequest) {
  const LoadedConfig loaded = load_line(kStepper, R"(, "poll": {"fast": 100, "normal": 500, "slow": 5000})");
  const BusBudget budget = plan_of(loaded);
  const Duration gap = bus_of(loaded).min_gap;
  // 0108 and 0109, fault and run state; 0117 to 0119, position and speed.
  EXPECT_EQ(budget.classes[0].reads, 2);
  EXPECT_EQ(budget.classes[0].on_wire, characters(8 + 9) + characters(8 + 11) + 2 * gap);
}

TEST(RtuLine, ADriveThatStatesALongerAnswerIsCountedWithIt) {
  const BusBudget stepper = plan_of(load_line(kStepper));
  EXPECT_EQ(stepper.classes[0].answered - stepper.classes[0].on_wire, 2 * milliseconds(20));
  const BusBudget jd = plan_of(load_line(kJd));
  EXPECT_EQ(jd.classes[0].answered - jd.classes[0].on_wire, jd.classes[0].reads * kAssumedAnswer);
}

TEST(RtuLine, AStopMayMeetTheLongestReadOfTheLine) {
  const LoadedConfig loaded = load_line(kStepper);
  // 0303 to 0320, the set-points: 18 registers, read at bring-up and after writes.
  const Duration longest = characters(8 + 5 + 2 * 18);
  EXPECT_EQ(plan_of(loaded).exchange, longest + milliseconds(20));
  EXPECT_EQ(plan_of(loaded).stop_wait, longest + milliseconds(20) + bus_of(loaded).min_gap);
}

TEST(RtuLine, TheDefaultsAreTheStandards) {
  const LoadedConfig loaded = load_line(kStepper);
  const BusConfig& bus = bus_of(loaded);
  EXPECT_EQ(bus.baud, 19200U);
  EXPECT_EQ(bus.parity, "none");
  EXPECT_EQ(bus.min_gap, Duration(std::chrono::seconds(1)) * 77 / (2 * 19200)) << "3.5 characters of 11 bits";
  EXPECT_EQ(bus_of(load_line(kStepper, R"(, "baud": 38400)")).min_gap, microseconds(1750));
}

TEST(RtuLine, TheDefaultTimeoutIsTheLongestExchangeAndWhatTheSlowestDriveMayTake) {
  const LoadedConfig loaded = load_line(kStepper);
  // 25.5 ms for the set-points, 100 ms for the drive, in whole milliseconds.
  EXPECT_EQ(bus_of(loaded).timeout, milliseconds(126));
  EXPECT_GT(bus_of(load_line(kStepper, R"(, "baud": 4800)")).timeout, milliseconds(200));
  EXPECT_EQ(bus_of(load_line(kStepper, R"(, "timeout_ms": 77)")).timeout, milliseconds(77));
}

TEST(RtuLine, TheDefaultPeriodsLeaveCommandsAFifthOfTheLine) {
  for (const std::string& drives : {std::string(kStepper), std::string(kJd), both()}) {
    const LoadedConfig loaded = load_line(drives);
    const BusBudget budget = plan_of(loaded);
    EXPECT_LE(budget.load_answered, kComfortablePermille) << drives;
    EXPECT_GT(budget.load_answered, 600) << drives << ": the line could give fresher values";
    for (const model::DriveModel& model : loaded.models.at(0)) EXPECT_EQ(model.poll_period, bus_of(loaded).poll);
  }
}

TEST(RtuLine, CheckNamesTheAnswerTimesItCountsWith) {
  EXPECT_THAT(check::report(load_line(kJd)).text, HasSubstr("with drives that answer after 5 ms, "));
  EXPECT_THAT(check::report(load_line(kStepper)).text, HasSubstr("with drives that answer after 20 ms, "));
  EXPECT_THAT(check::report(load_line(both())).text, HasSubstr("with drives that answer after 5 to 20 ms, "));
}

TEST(RtuLine, CheckReportsTheLine) {
  const std::string report = check::report(load_line(both())).text;
  EXPECT_THAT(report, HasSubstr("Bus line-a: modbus-rtu on /dev/ttyS1, 19200 baud\n"));
  EXPECT_THAT(report, HasSubstr("drives          Kinco JD at node 1, iD286pro at node 3\n"));
  EXPECT_THAT(report, HasSubstr("THE DRIVE DOES NOT STOP BY ITSELF on modbus-rtu"));
  EXPECT_THAT(report, Not(HasSubstr("OVERLOADED")));
}

TEST(RtuLine, CheckSaysWhichAxisStopsWithoutALeaseWhenItsClientLeaves) {
  constexpr const char* kLeaves = "but for a quick stop when its connection ends, where \"client\" is \"connection\"\n";
  const auto without_lease = [](std::string drive) {
    return check::report(load_line(drive.replace(drive.find("\"axis\": "), 0, "\"lease\": null, "))).text;
  };
  EXPECT_THAT(without_lease(kStepper), HasSubstr(kLeaves));
  EXPECT_THAT(without_lease(kJd), Not(HasSubstr(kLeaves)));
  EXPECT_THAT(check::report(load_line(kStepper)).text, Not(HasSubstr(kLeaves))) << "its lease takes care of it";
}

}  // namespace
}  // namespace axisgate::config
