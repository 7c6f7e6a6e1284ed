// SPDX-License-Identifier: Apache-2.0
// A CiA 402 drive whose speeds and ramps are REAL32 in rpm, as EVE-NET and others have them: told and written to the
// last bit, made 0 before torque comes on, and without a value where the drive tells none.
#include <gtest/gtest.h>

#include <bit>

#include "tests/profiles/mistakes.hpp"
#include "tests/simulated/eds_drive.hpp"
#include "tests/stage/gateway_stage.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test::real_speeds {
namespace {

using namespace std::chrono_literals;
using simulated::ObjectEntry;

constexpr std::int64_t kRpm = 1000;

using enum simulated::ObjectType;
using enum simulated::Access;
using enum simulated::Keep;

constexpr std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

constexpr ObjectEntry kObjects[] = {
    {0x1010, 1, u32, rw, ram, 1},                 // store parameters
    {0x603F, 0, u16, ro, ram},                    // error code
    {0x6040, 0, u16, rw, ram},                    // controlword
    {0x6041, 0, u16, ro, ram},                    // statusword
    {0x605A, 0, i16, rw, eeprom, 2},              // quick stop option code
    {0x6060, 0, i8, rw, eeprom, 3},               // modes of operation
    {0x6061, 0, i8, ro, ram},                     // modes of operation display
    {0x6064, 0, i32, ro, ram},                    // position actual
    {0x606C, 0, u32, ro, ram},                    // velocity actual
    {0x6081, 0, u32, rw, eeprom, bits(500.0F)},   // profile velocity
    {0x6083, 0, u32, rw, eeprom, bits(1000.0F)},  // profile acceleration
    {0x6084, 0, u32, rw, eeprom, bits(1000.0F)},  // profile deceleration
    {0x6085, 0, u32, rw, eeprom, bits(6000.0F)},  // quick stop deceleration
    {0x60FD, 0, u32, ro, ram},                    // digital inputs
    {0x60FF, 0, u32, rw, eeprom, bits(-750.0F)},  // target velocity: somebody has left one
};

constinit const simulated::EdsDriveType kType{
    .name = "real-drive",
    .device_name = "REAL",
    .identity = {1, 2, 3, 4},
    .device_type = 0x00020192,
    .objects = kObjects,
    .encoder_counts = 4096,
    .units =
        [](const simulated::ObjectDictionary&, std::int64_t counts) {
          return simulated::EdsUnits{{counts}, {60'000}, {60'000}};
        },
    .real_speeds = true,
};

constexpr const char* kProfile = R"({
  "profile": 1,
  "name": "real-drive",
  "extends": "cia402",
  "base_only": false,
  "title": "Drive with REAL32 speeds",
  "nvm": "no",
  "units": {"position": {"mul": [4096]}, "speed": {"base": "rpm"}, "acceleration": {"base": "rpm/s"}},
  "objects": {
    "velocity_actual": {"type": "f32"}, "target_velocity": {"type": "f32"}, "profile_acceleration": {"type": "f32"},
    "profile_deceleration": {"type": "f32"}, "quick_stop_deceleration": {"type": "f32"},
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
    "position_limit_min": null, "position_limit_max": null
  },
  "state": {"zero_before_enable": ["target_velocity"]},
  "modes": {"1": null, "4": null, "6": null},
  "homing": null,
  "setup": [{"write": "producer_heartbeat", "value": 1000, "why": "so that its end is noticed"}],
  "commands": {"move_absolute": null, "move_relative": null, "run_torque": null, "home": null, "set_position": null}
})";

class RealSpeeds : public testing::Test {
 protected:
  RealSpeeds() : stage({line()}) {}
  void SetUp() override { ASSERT_TRUE(stage.come_online()); }

  GatewayStage::Line line() {
    GatewayStage::Line out = can_line_of({simulated::EdsDriveOptions{&kType}}, 1);
    out.can_drives.front().profile = folder.write("real-drive.json", kProfile).string();
    out.can_drives.front().axis.limits.velocity = 2000 * kRpm;
    return out;
  }
  simulated::EdsDrive& drive() { return stage.eds_drive(0); }
  std::int64_t speed() { return simulated::rpm_of(drive().axis().actual_speed(), drive().encoder_counts(), kRpm); }
  Errc ask(Command command, std::initializer_list<Setpoint> with = {}) {
    WriteBatch batch;
    batch.command = command;
    batch.setpoints = with;
    return stage.ask(1, batch).outcome.code;
  }
  bool shows(std::int64_t rpm_1000) {
    return stage.run_until([&] { return stage.axis(1)[Quantity::velocity_actual].value == rpm_1000; });
  }

  const OwnFolder folder;
  GatewayStage stage;
};

TEST_F(RealSpeeds, AreMadeZeroBeforeTorqueComesOn) {
  ASSERT_EQ(drive().peek({0x60FF, 0}), bits(-750.0F));
  ASSERT_EQ(ask(Command::enable), Errc::ok);
  EXPECT_EQ(drive().peek({0x60FF, 0}), 0);
  const simulated::FinePosition before = drive().axis().actual();
  stage.run(1s);
  EXPECT_EQ(drive().axis().actual(), before) << "an enable moves nothing";
}

TEST_F(RealSpeeds, AreWrittenToTheLastBitAndRead) {
  ASSERT_EQ(ask(Command::enable), Errc::ok);
  ASSERT_EQ(ask(Command::run_velocity, {{Quantity::target_velocity, 123'456}}), Errc::ok);
  EXPECT_EQ(drive().peek({0x60FF, 0}), bits(123.456F));
  EXPECT_TRUE(shows(123'456));
  EXPECT_NEAR(static_cast<double>(speed()), 123'456, 10);
  EXPECT_EQ(stage.axis(1)[Quantity::target_velocity].value, 123'456);
  ASSERT_EQ(ask(Command::none, {{Quantity::target_velocity, -1}, {Quantity::profile_acceleration, 12'345}}), Errc::ok);
  EXPECT_EQ(drive().peek({0x60FF, 0}), bits(-0.001F));
  EXPECT_EQ(drive().peek({0x6083, 0}), bits(1234.5F));
  EXPECT_EQ(ask(Command::none, {{Quantity::target_velocity, 2001 * kRpm}}), Errc::bad_value) << "beyond its limit";
  ASSERT_EQ(ask(Command::none, {{Quantity::target_velocity, -2000 * kRpm}}), Errc::ok);
  EXPECT_TRUE(stage.run_until([&] { return speed() < -1999 * kRpm; }));
  ASSERT_EQ(ask(Command::quick_stop), Errc::ok);
  EXPECT_TRUE(stage.run_until([&] { return speed() == 0; }));
}

TEST_F(RealSpeeds, HaveNoValueWhereTheDriveTellsNoNumber) {
  ASSERT_EQ(ask(Command::enable), Errc::ok);
  ASSERT_EQ(ask(Command::run_velocity, {{Quantity::target_velocity, 60 * kRpm}}), Errc::ok);
  ASSERT_TRUE(shows(60 * kRpm));
  drive().tell_no_number(true);
  EXPECT_TRUE(stage.run_until([&] { return !stage.axis(1)[Quantity::velocity_actual].valid; }));
  drive().tell_no_number(false);
  EXPECT_TRUE(shows(60 * kRpm));
}

TEST_F(RealSpeeds, AMailboxWritesNoneThatIsNoNumber) {
  ASSERT_EQ(ask(Command::enable), Errc::ok);
  for (const std::uint32_t none : {0x7FC00000U, 0x7F800000U, bits(2001.0F)}) {
    WriteBatch batch;
    batch.object = ObjectRequest{true, 0x60FF, 0, 4, none};
    EXPECT_EQ(stage.ask(1, batch).outcome.code, Errc::bad_value);
    EXPECT_EQ(drive().peek({0x60FF, 0}), 0);
  }
}

}  // namespace
}  // namespace axisgate::test::real_speeds
