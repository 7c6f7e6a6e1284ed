// SPDX-License-Identifier: Apache-2.0
// The shipped Keya profile: the steps of each command on each protocol and in each mode.
#include <gmock/gmock.h>

#include "tests/profiles/keya.hpp"

namespace axisgate::profile {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// How motor B is switched on and off.
struct Words {
  std::string protocol, on_in_speed, on_in_position, on_in_torque, off;
};
const std::vector<Words> kWords{
    {"canopen", "B.command=51191826", "B.command=51191858", "B.command=51191810", "B.command=51126274"},
    {"keya-can", "B.enable_command=0", "B.enable_command=0", "B.enable_command=0", "B.disable_command=0"},
    {"keya-rs232", "B.on=1", "B.on=1", "B.on=1", "B.on=0"},
    {"keya-rs485", "B.on=1", "B.on=1", "B.on=1", "B.on=0"},
};
const std::string kIsOn = ", wait B.fault&1==0", kIsOff = ", wait B.fault&1==1";

std::string of_b(const std::string& protocol, std::int64_t parameter, Command command, std::int16_t mode) {
  return keya::steps(keya::model(keya::in_mode(protocol, parameter)), 1, command, mode);
}

TEST(KeyaCommands, EnableNeverTravelsWithAPositionOfZero) {
  for (const Words& words : kWords) {
    SCOPED_TRACE(words.protocol);
    EXPECT_EQ(of_b(words.protocol, keya::kSpeed, Command::enable, 3), words.on_in_speed + kIsOn);
    EXPECT_EQ(of_b(words.protocol, keya::kAbsolute, Command::enable, 1),
              "B.target_position=position_actual, " + words.on_in_position + kIsOn);
    EXPECT_EQ(of_b(words.protocol, keya::kTorque, Command::enable, 4), words.on_in_torque + kIsOn);
  }
}

TEST(KeyaCommands, OnlyTheSetpointsOfItsOwnModeAreMadeZeroBeforeAnEnable) {
  const auto zeroed = [](const std::string& protocol, std::int64_t mode) {
    const model::DriveModel model = keya::model(keya::in_mode(protocol, mode));
    return names(model, model.axes[0].zero_before_enable);
  };
  for (const std::string protocol : keya::kFixed) {
    EXPECT_THAT(zeroed(protocol, keya::kSpeed), ElementsAre("A.target_velocity")) << protocol;
    EXPECT_THAT(zeroed(protocol, keya::kTorque), ElementsAre("A.target_torque")) << protocol;
    EXPECT_THAT(zeroed(protocol, keya::kAbsolute), IsEmpty()) << protocol;
  }
  EXPECT_THAT(zeroed("canopen", keya::kSpeed), ElementsAre("A.target_velocity"));
}

TEST(KeyaCommands, EveryWriteThatMovesTheMotorIsHeldUntilTheStart) {
  for (const std::string protocol : keya::kProtocols)
    for (const std::int64_t mode : {keya::kSpeed, keya::kTorque, keya::kAbsolute})
      for (const model::AxisModel& axis : keya::model(keya::in_mode(protocol, mode)).axes)
        for (const model::Binding& binding : axis.bindings)
          if (binding.quantity == Quantity::target_velocity || binding.quantity == Quantity::target_torque ||
              binding.quantity == Quantity::target_position) {
            const model::DriveModel model = keya::model(keya::in_mode(protocol, mode));
            EXPECT_TRUE(model.object(binding.object).trigger) << protocol;
            EXPECT_FALSE(model.object(binding.object).readable) << protocol;
          }
}

TEST(KeyaCommands, AStopSendsNoZeroToAMotorInPositionMode) {
  for (const Words& words : kWords) {
    SCOPED_TRACE(words.protocol);
    EXPECT_EQ(of_b(words.protocol, keya::kSpeed, Command::quick_stop, 3),
              "B.target_velocity=0, wait B.speed==0?, " + words.off + kIsOff);
    EXPECT_EQ(of_b(words.protocol, keya::kTorque, Command::quick_stop, 4), "B.target_torque=0, " + words.off + kIsOff);
    EXPECT_EQ(of_b(words.protocol, keya::kAbsolute, Command::quick_stop, 1), words.off + kIsOff);
    EXPECT_EQ(of_b(words.protocol, keya::kAbsolute, Command::halt, 1), "B.target_position=position_actual");
    EXPECT_EQ(of_b(words.protocol, keya::kSpeed, Command::halt, 3), "B.target_velocity=0");
    EXPECT_EQ(of_b(words.protocol, keya::kTorque, Command::halt, 4), "quick_stop");
    EXPECT_EQ(of_b(words.protocol, keya::kSpeed, Command::disable, 3), words.off + kIsOff);
  }
}

TEST(KeyaCommands, TheStepsOfMotorAAreItsOwn) {
  for (const std::string protocol : keya::kProtocols) {
    const model::DriveModel model = keya::model(keya::in_mode(protocol, keya::kSpeed, {"B", "A"}));
    for (const Command command : {Command::enable, Command::disable, Command::quick_stop, Command::halt}) {
      EXPECT_THAT(keya::steps(model, 0, command, 3), Not(HasSubstr("A."))) << protocol;
      EXPECT_THAT(keya::steps(model, 1, command, 3), Not(HasSubstr("B."))) << protocol;
    }
  }
  const model::DriveModel canopen = keya::model(keya::in_mode("canopen", keya::kSpeed, {"B", "A"}));
  EXPECT_THAT(keya::steps(canopen, 1, Command::enable, 1), HasSubstr("A.command=51191857"));
}

TEST(KeyaCommands, AResetThatTheDriveDoesNotHeedIsNotReached) {
  const std::string cleared = ", wait B.fault&16382==0";
  EXPECT_EQ(of_b("canopen", keya::kSpeed, Command::fault_reset, 3), "B.command=51126514" + cleared);
  for (const Words& words : kWords)
    if (words.protocol != "canopen") {
      EXPECT_EQ(of_b(words.protocol, keya::kSpeed, Command::fault_reset, 3), words.off + cleared) << words.protocol;
    }
}

TEST(KeyaCommands, APositionCanBecomeZeroOnCanopenAloneAndNotWhileItIsHeld) {
  for (const std::string protocol : keya::kFixed)
    EXPECT_EQ(of_b(protocol, keya::kAbsolute, Command::set_position, 1), "none") << protocol;
  EXPECT_EQ(of_b("canopen", keya::kSpeed, Command::set_position, 3), "B.command=51183616");
  EXPECT_THAT(of_b("canopen", keya::kSpeed, Command::set_position, 1), testing::StartsWith("must B.fault&1==1"));
  EXPECT_TRUE(keya::model(keya::drive("canopen")).axes[0].command(Command::set_position)->zero_only);
}

TEST(KeyaCommands, MovesAreAbsoluteAndARunIsItsSetpoint) {
  for (const std::string protocol : keya::kProtocols) {
    const model::DriveModel position = keya::model(keya::in_mode(protocol, keya::kAbsolute));
    EXPECT_EQ(keya::steps(position, 0, Command::move_absolute, 1), "A.target_position=target_position") << protocol;
    EXPECT_FALSE(position.axes[0].command(Command::move_relative)) << "no steps: the planner makes it absolute";
    EXPECT_NE(position.axes[0].supported_commands & 1U << static_cast<unsigned>(Command::move_relative), 0U);
    const model::DriveModel speed = keya::model(keya::in_mode(protocol, keya::kSpeed));
    EXPECT_EQ(keya::steps(speed, 0, Command::run_velocity, 3), "") << "nothing but the set-point: " << protocol;
  }
}

}  // namespace
}  // namespace axisgate::profile
