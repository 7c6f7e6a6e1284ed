// SPDX-License-Identifier: Apache-2.0
// A drive that has no profile velocity mode, but CiA 402's velocity mode (2, vl) of frequency converters: target 6042h
// in rpm, ramps as so many rpm in so many seconds (6048h, 6049h), and three bits of the controlword that let it run.
// Said in words that every profile has; judged by what the simulated motor does.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/profiles/mistakes.hpp"
#include "tests/simulated/eds_drive.hpp"
#include "tests/stage/gateway_stage.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test::vl_mode {
namespace {

using namespace std::chrono_literals;
using simulated::ObjectEntry;

constexpr std::int64_t kRpm = 1000, kRpmPerS = 10;

using enum simulated::ObjectType;
using enum simulated::Access;
using enum simulated::Keep;

constexpr ObjectEntry kObjects[] = {
    {0x1010, 1, u32, rw, ram, 1},        // store parameters
    {0x603F, 0, u16, ro, ram},           // error code
    {0x6040, 0, u16, rw, ram},           // controlword
    {0x6041, 0, u16, ro, ram},           // statusword
    {0x6042, 0, i16, rw, ram},           // vl target velocity
    {0x6043, 0, i16, ro, ram},           // vl velocity demand
    {0x6044, 0, i16, ro, ram},           // vl velocity actual
    {0x6048, 1, u32, rw, eeprom, 1000},  // vl acceleration: rpm
    {0x6048, 2, u16, rw, eeprom, 2},     // vl acceleration: in so many seconds
    {0x6049, 1, u32, rw, eeprom, 1000},  // vl deceleration: rpm
    {0x6049, 2, u16, rw, eeprom, 4},     // vl deceleration: in so many seconds
    {0x605A, 0, i16, rw, eeprom, 2},     // quick stop option code
    {0x6060, 0, i8, rw, eeprom},         // modes of operation
    {0x6061, 0, i8, ro, ram},            // modes of operation display
    {0x6064, 0, i32, ro, ram},           // position actual
    {0x6081, 0, u32, rw, eeprom, 500},   // profile velocity
    {0x6083, 0, u32, rw, eeprom, 500},   // profile acceleration
    {0x6085, 0, u32, rw, eeprom, 6000},  // quick stop deceleration
    {0x60FD, 0, u32, ro, ram},           // digital inputs
};

constinit const simulated::EdsDriveType kType{
    .name = "vl-drive",
    .device_name = "VL",
    .identity = {1, 2, 3, 4},
    .device_type = 0x00010192,
    .objects = kObjects,
    .encoder_counts = 4096,
    .units = [](const simulated::ObjectDictionary&, std::int64_t counts) { return simulated::counts_and_rpm(counts); },
    .torque_mode = 4,
};

/// How docs/new_drive.md says it: the seconds are read from the drive, and the ramp is written as their rpm.
constexpr const char* kProfile = R"({
  "profile": 1,
  "name": "vl-drive",
  "extends": "cia402",
  "base_only": false,
  "title": "Drive with velocity mode 2",
  "nvm": "no",
  "constants": {
    "faster_in_s": {"range": [1, 65535], "first": [{"value": ["vl_faster_in"]}]},
    "slower_in_s": {"range": [1, 65535], "first": [{"value": ["vl_slower_in"]}]}
  },
  "units": {
    "position": {"mul": [4096]},
    "faster": {"base": "rpm/s", "mul": ["faster_in_s"]},
    "slower": {"base": "rpm/s", "mul": ["slower_in_s"]}
  },
  "protocols": {"canopen": {"resynchronisation": ["error_code", "mode_display", "digital_inputs", "controlword"]}},
  "objects": {
    "velocity_actual": {"type": "i16", "at": {"canopen": "6044.00"}, "unit": "rpm"},
    "target_velocity": {"type": "i16", "at": {"canopen": "6042.00"}, "unit": "rpm"},
    "profile_acceleration": {"at": {"canopen": "6048.01"}, "unit": "faster"},
    "profile_deceleration": {"at": {"canopen": "6049.01"}, "unit": "slower"},
    "vl_faster_in": {"type": "u16", "access": "rw", "at": {"canopen": "6048.02"}},
    "vl_slower_in": {"type": "u16", "access": "rw", "at": {"canopen": "6049.02"}},
    "quick_stop_deceleration": {"unit": "faster"},
    "torque_actual": null, "following_error": null, "dc_voltage": null, "target_position": null, "target_torque": null,
    "max_torque": null, "max_velocity": null, "profile_velocity": null, "homing_method": null,
    "homing_speed_switch": null, "homing_speed_zero": null, "homing_acceleration": null, "homing_offset": null,
    "position_limit_min": null, "position_limit_max": null, "shutdown_option": null, "disable_option": null,
    "halt_option": null, "fault_reaction_option": null
  },
  "quantities": {
    "torque_actual": null, "following_error": null, "dc_voltage": null, "target_position": null, "target_torque": null,
    "max_torque": null, "max_velocity": null, "profile_velocity": null, "homing_method": null,
    "homing_speed_switch": null, "homing_speed_zero": null, "homing_acceleration": null, "homing_offset": null,
    "position_limit_min": null, "position_limit_max": null, "quick_stop_deceleration": null
  },
  "state": {"zero_before_enable": ["target_velocity"]},
  "modes": {"1": null, "3": 2, "4": null, "6": null},
  "homing": null,
  "setup": [{"write": "producer_heartbeat", "value": 1000, "why": "so that its end is noticed"}],
  "commands": {
    "run_velocity": {"steps": [{"write": "controlword", "value": "0x007F"}]},
    "move_absolute": null, "move_relative": null, "run_torque": null, "home": null, "set_position": null
  }
})";

class VlMode : public testing::Test {
 protected:
  VlMode() : stage({line()}) {}
  void SetUp() override {
    ASSERT_TRUE(stage.come_online());
    carry_out(Command::enable);
  }

  GatewayStage::Line line() {
    GatewayStage::Line out = can_line_of({simulated::EdsDriveOptions{&kType}}, 1);
    out.can_drives.front().profile = folder.write("vl-drive.json", kProfile).string();
    return out;
  }
  simulated::EdsDrive& drive() { return stage.eds_drive(0); }
  std::int64_t speed() { return simulated::rpm_of(drive().axis().actual_speed(), drive().encoder_counts(), kRpm); }
  void carry_out(Command command, std::initializer_list<Setpoint> with = {}) {
    WriteBatch batch;
    batch.command = command;
    batch.setpoints = with;
    ASSERT_EQ(stage.ask(1, batch).outcome.code, Errc::ok);
  }
  /// Until it is so fast.
  Duration time_to(std::int64_t rpm) {
    const Instant before = stage.runtime().now();
    EXPECT_TRUE(stage.run_until([&] { return speed() == rpm * kRpm; }));
    return stage.runtime().now() - before;
  }
  static void expect_about(Duration seen, Duration wanted) {
    EXPECT_GE(seen, wanted * 9 / 10);
    EXPECT_LE(seen, wanted * 11 / 10 + 50ms);
  }

  const OwnFolder folder;
  GatewayStage stage;
};

TEST_F(VlMode, RunsBothWaysAndRampsAsItIsSetTo) {
  EXPECT_EQ(stage.axis(1)[Quantity::profile_acceleration].value, 500 * kRpmPerS) << "1000 rpm in 2 s";
  carry_out(Command::run_velocity, {{Quantity::target_velocity, 500 * kRpm}});
  expect_about(time_to(500), 1s);
  EXPECT_EQ(drive().peek({0x6060, 0}), 2);
  EXPECT_EQ(stage.axis(1)[Quantity::mode_display].value, 3) << "as a client knows it";
  carry_out(Command::none, {{Quantity::target_velocity, -250 * kRpm}});
  expect_about(time_to(0), 2s);
  expect_about(time_to(-250), 500ms);
  EXPECT_TRUE(stage.run_until([&] { return stage.axis(1)[Quantity::velocity_actual].value == -250 * kRpm; }));
}

TEST_F(VlMode, ARampIsWrittenAsTheRpmOfTheSecondsThatTheDriveHolds) {
  carry_out(Command::none,
            {{Quantity::profile_acceleration, 250 * kRpmPerS}, {Quantity::profile_deceleration, 1000 * kRpmPerS}});
  EXPECT_EQ(drive().peek({0x6048, 1}), 500);
  EXPECT_EQ(drive().peek({0x6048, 2}), 2) << "the seconds stay as they are";
  EXPECT_EQ(drive().peek({0x6049, 1}), 4000);
  carry_out(Command::run_velocity, {{Quantity::target_velocity, 500 * kRpm}});
  expect_about(time_to(500), 2s);
  carry_out(Command::halt);
  ASSERT_TRUE(stage.run_until([&] { return speed() == 0; }));
  EXPECT_EQ(drive().state(), simulated::Cia402State::operation_enabled);
  stage.run(500ms);
  EXPECT_EQ(speed(), 0);
  carry_out(Command::run_velocity, {{Quantity::target_velocity, 100 * kRpm}});
  static_cast<void>(time_to(100));
  carry_out(Command::quick_stop);
  ASSERT_TRUE(stage.run_until([&] { return speed() == 0; }));
  EXPECT_NE(drive().state(), simulated::Cia402State::operation_enabled);
}

}  // namespace
}  // namespace axisgate::test::vl_mode
