// SPDX-License-Identifier: Apache-2.0
// Any CiA 402 drive by the generic profile: how it counts is asked of the drive itself; where it does not tell, the
// motor is enabled and never moved, and the log says what to write into the configuration.
#include <gmock/gmock.h>

#include "tests/stage/stage_lines.hpp"
#include "tests/stage_drive/can_rig.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::ObjectKey;
using testing::IsEmpty;

constexpr ObjectKey kPositionUnit{0x60A8, 0}, kSpeedUnit{0x60A9, 0}, kAccelerationUnit{0x60AA, 0};
constexpr std::uint32_t kIncrements = 0x00B50000, kIncrementsPerS = 0x00B50300, kIncrementsPerS2 = 0x00B55700,
                        kDegreesPerS = 0x00410300;

using Objects = std::map<ObjectKey, std::uint32_t>;
const Objects kAll{{kSpeedUnit, kIncrementsPerS}, {kAccelerationUnit, kIncrementsPerS2}};

GatewayStage::Line generic_line(Objects more, std::map<ObjectKey, std::int64_t> stored,
                                std::map<std::string, Rational> constants) {
  simulated::LeadshineOptions options;
  options.more = std::move(more);
  options.stored = std::move(stored);
  options.acknowledges_setpoints = true;
  GatewayStage::Line line = can_line_of({options}, 1);
  line.can_drives[0].profile = "cia402-generic";
  line.can_drives[0].constants = std::move(constants);
  return line;
}

class GenericDrive : public CanRig {
 public:
  explicit GenericDrive(Objects more, std::map<ObjectKey, std::int64_t> stored = {},
                        std::map<std::string, Rational> constants = {})
      : CanRig(generic_line(std::move(more), std::move(stored), std::move(constants))) {
    online();
  }
  /// Nothing that could move it is accepted, and it stands; but enable, disable and stops are.
  void expect_enabled_and_never_moved() {
    enable();
    mark();
    EXPECT_EQ(write(Quantity::target_velocity, 100'000).outcome.code, Errc::still_in_setup);
    EXPECT_EQ(write(Quantity::target_position, 5'000).outcome.code, Errc::still_in_setup);
    for (const Command each :
         {Command::move_absolute, Command::move_relative, Command::run_velocity, Command::run_torque, Command::home})
      EXPECT_EQ(command(each).outcome.code, Errc::still_in_setup) << text(each);
    EXPECT_EQ(ask(with_controlword(0x1F)).outcome.code, Errc::still_in_setup) << "a start by the drive's own word";
    EXPECT_THAT(commanding(), IsEmpty()) << "of this nothing has reached the drive";
    EXPECT_FALSE(turns());
    EXPECT_TRUE(powered());
    EXPECT_EQ(command(Command::quick_stop).outcome.code, Errc::ok);
    EXPECT_EQ(command(Command::disable).outcome.code, Errc::ok);
    EXPECT_FALSE(powered());
  }
  void expect_one_turn() {
    enable();
    ASSERT_EQ(write(Quantity::profile_velocity, 600'000).outcome.code, Errc::ok);
    ASSERT_EQ(write(Quantity::profile_acceleration, 6'000).outcome.code, Errc::ok);
    const std::int64_t before = position();
    ASSERT_EQ(ask(with_command(Command::move_absolute, {{Quantity::target_position, 10'000}})).outcome.code, Errc::ok);
    ASSERT_TRUE(settles([&] { return axis().motion_state == MotionState::completed; }));
    EXPECT_NEAR(static_cast<double>(position() - before), 10'000, 20) << "counts of a turn";
  }
};

TEST(GenericDriveOnCanopen, CountsAsTheDriveSaysAndMoves) {
  GenericDrive rig(kAll);
  EXPECT_FALSE(rig.told("is not known"));
  rig.expect_one_turn();
}

TEST(GenericDriveOnCanopen, WithoutTheUnitOfSpeedItIsEnabledAndNeverMoved) {
  GenericDrive rig({{kAccelerationUnit, kIncrementsPerS2}});
  EXPECT_EQ(rig.times_told("constant speed_units_per_rpm is not known: the drive does not have speed_unit "
                           "(0x60A9:00). What counts by it has no value, and nothing is moved: write \"constants\": "
                           "{\"speed_units_per_rpm\": ...} into the entry of this drive in the configuration"),
            1U);
  EXPECT_EQ(rig.times_told("is not known"), 1U) << "the others are";
  EXPECT_FALSE(rig.axis()[Quantity::velocity_actual].valid);
  EXPECT_TRUE(rig.axis()[Quantity::position_actual].valid);
  EXPECT_EQ(rig.write(Quantity::profile_velocity, 60'000).outcome.code, Errc::still_in_setup);
  const auto plc = client(1, "10.0.0.1");
  WriteBatch move = with_command(Command::move_absolute);
  move.client = plc->id;
  move.role = plc->role;
  move.life = plc;
  EXPECT_EQ(rig.ask(move).outcome.code, Errc::still_in_setup);
  EXPECT_TRUE(rig.has_event(EventKind::command, ": the drive does not tell speed_units_per_rpm")) << "and why";
  rig.expect_enabled_and_never_moved();
}

TEST(GenericDriveOnCanopen, WithoutTheUnitOfAccelerationItIsNeverMovedEither) {
  GenericDrive rig({{kSpeedUnit, kIncrementsPerS}});
  EXPECT_TRUE(
      rig.told("constant acceleration_units_per_rpm_per_s is not known: the drive does not have "
               "acceleration_unit (0x60AA:00)"));
  rig.expect_enabled_and_never_moved();
}

TEST(GenericDriveOnCanopen, AUnitThatItsProfileDoesNotKnowIsNoUnit) {
  GenericDrive rig({{kSpeedUnit, kDegreesPerS}, {kAccelerationUnit, kIncrementsPerS2}});
  EXPECT_TRUE(rig.told("constant speed_units_per_rpm is not known: "));
  EXPECT_TRUE(rig.told("speed_unit (0x60A9:00) holds 4260608 (0x410300)"));
  rig.expect_enabled_and_never_moved();
}

TEST(GenericDriveOnCanopen, AGearIsNotGuessed) {
  GenericDrive rig(kAll, {{ObjectKey{0x6091, 1}, 5}});
  EXPECT_TRUE(rig.told("constant position_units_per_rev is not known: "));
  rig.expect_enabled_and_never_moved();
}

TEST(GenericDriveOnCanopen, ATurnOfOneUnitIsAFactoryValue) {
  GenericDrive rig(kAll, {{ObjectKey{0x6092, 1}, 1}});
  EXPECT_TRUE(rig.told("constant position_units_per_rev is not known: "));
  EXPECT_TRUE(rig.told("which makes no value that it can have"));
  rig.expect_enabled_and_never_moved();
}

TEST(GenericDriveOnCanopen, WhatTheConfigurationGivesIsNotAskedOfTheDrive) {
  GenericDrive rig({}, {},
                   {{"speed_units_per_rpm", Rational(10000, 60)},
                    {"acceleration_units_per_rpm_per_s", Rational(10000, 60)},
                    {"position_units_per_rev", Rational(10000)}});
  EXPECT_FALSE(rig.told("is not known"));
  rig.expect_one_turn();
}

TEST(GenericDriveOnCanopen, PositionsInIncrementsAreThoseOfTheEncoder) {
  Objects more = kAll;
  more.emplace(kPositionUnit, kIncrements);
  GenericDrive rig(more, {{ObjectKey{0x6091, 1}, 1}});
  rig.expect_one_turn();
}

// A quick stop that ends energised is left by disable voltage alone, which no other word of an enable is.
TEST(GenericDriveOnCanopen, IsEnabledAgainFromQuickStopActive) {
  GenericDrive rig(kAll);
  rig.enable();
  ASSERT_EQ(rig.command(Command::quick_stop).outcome.code, Errc::ok);
  constexpr std::int64_t kState = 0x6F, kQuickStopActive = 0x07;
  EXPECT_EQ(rig.axis()[Quantity::statusword].value & kState, kQuickStopActive) << "605Ah is 6";
  ASSERT_EQ(rig.command(Command::disable).outcome.code, Errc::ok);
  rig.enable();
  rig.expect_one_turn();
}

}  // namespace
}  // namespace axisgate::test
