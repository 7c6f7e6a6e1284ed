// SPDX-License-Identifier: Apache-2.0
// The shipped Keya profile: which motor an axis is, which modes it has and what it can do in them, what is repeated.
#include <gmock/gmock.h>

#include "gateway/image/axis_image.hpp"
#include "gateway/model/loss.hpp"
#include "tests/profiles/keya.hpp"

namespace axisgate::profile {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

const std::vector<std::vector<std::string>> kAxes{{"A"}, {"A", "B"}, {"B"}, {"B", "A"}, {""}, {"", ""}};

std::vector<Command> motions(const model::AxisModel& axis) {
  std::vector<Command> out;
  for (const Command command : {Command::move_absolute, Command::move_relative, Command::run_velocity,
                                Command::run_torque, Command::home, Command::set_position})
    if ((axis.supported_commands >> static_cast<unsigned>(command) & 1U) != 0) out.push_back(command);
  return out;
}

std::vector<Quantity> targets(const model::AxisModel& axis) {
  std::vector<Quantity> out;
  for (const Quantity quantity : {Quantity::target_position, Quantity::target_velocity, Quantity::target_torque})
    if (axis.binding(quantity) != nullptr) out.push_back(quantity);
  return out;
}

auto fault_at(const std::string& pointer, const std::string& words) {
  return testing::AllOf(testing::Field(&Fault::pointer, pointer), testing::Field(&Fault::message, HasSubstr(words)));
}

std::vector<Fault> refused_with(const ResolveInput& input) { return refused(shipped("keya-kydas4860-2e"), input); }

TEST(KeyaModes, ResolvesOnEveryProtocolForEveryChoiceOfMotors) {
  for (const std::string protocol : keya::kProtocols) {
    for (const auto& motors : kAxes) {
      SCOPED_TRACE(protocol + " " + std::to_string(motors.size()) + " " + motors[0]);
      const model::DriveModel model = keya::model(keya::drive(protocol, motors));
      ASSERT_EQ(model.axes.size(), motors.size());
      for (std::size_t i = 0; i < motors.size(); ++i) {
        const std::string motor = motors[i].empty() ? std::string(1, "AB"[i]) : motors[i];
        const model::AxisModel& axis = model.axes[i];
        EXPECT_EQ(model.object(axis.statusword).name, motor + ".statusword");
        EXPECT_EQ(model.object(axis.virtual_axis->fault.object).name, motor + ".fault");
        EXPECT_EQ(model.object(axis.fault_words[0]).name, motor + ".fault");
        EXPECT_EQ(model.object(axis.moving->object).name, motor + ".speed");
        EXPECT_EQ(model.object(axis.binding(Quantity::position_actual)->object).name, motor + ".position");
        for (const model::ObjectDef& object : model.objects)
          if (object.name.starts_with(motor + ".")) {
            EXPECT_EQ(object.slot, i) << object.name;
          }
        for (const Command stop : {Command::disable, Command::quick_stop, Command::halt, Command::enable})
          EXPECT_TRUE(axis.command(stop)) << static_cast<int>(stop);
      }
    }
  }
}

TEST(KeyaModes, AMotorThatIsNoAxisIsLeftOutButForTheControlFrame) {
  for (const std::string protocol : keya::kProtocols) {
    const model::DriveModel model = keya::model(keya::drive(protocol, {"B"}));
    std::vector<std::string> others;
    for (const model::ObjectDef& object : model.objects) {
      if (!object.name.starts_with("A.")) continue;
      EXPECT_EQ(object.slot, kNoAxis) << object.name;
      EXPECT_TRUE(object.composed) << object.name;
      others.push_back(object.name);
    }
    EXPECT_EQ(others.empty(), protocol == "canopen" || protocol == "keya-can") << protocol;
    EXPECT_EQ(model.composed.size(), others.empty() ? 0U : 4U) << protocol;
    EXPECT_THAT(model.checks, IsEmpty()) << "motor B's mode is nowhere to be seen";
  }
  const model::CanopenProperties facts = keya::model(keya::drive("canopen", {"B"})).canopen;
  ASSERT_EQ(facts.tpdos.size(), 2U);
  EXPECT_EQ(facts.tpdos[1].map.size(), 3U) << "without the faults of motor A";
  EXPECT_THAT(facts.unused_tpdos, ElementsAre(1));
}

TEST(KeyaModes, AMotorThatIsNoneOrTakenIsRefusedAtItsAxis) {
  EXPECT_THAT(refused_with(keya::drive("keya-can", {"C"})),
              ElementsAre(fault_at("/axes/0/motor", "has no motor \"C\": it has A, B")));
  EXPECT_THAT(refused_with(keya::drive("keya-can", {"B", "B"})),
              ElementsAre(fault_at("/axes/1/motor", "motor \"B\" is the axis at /axes/0 already")));
  EXPECT_THAT(refused_with(keya::drive("keya-can", {"B", ""})),
              ElementsAre(fault_at("/axes/1/motor", "which this axis is by its place in the list")));
  ResolveInput kinco = kinco_axis();
  kinco.axes[0].motor = "B";
  EXPECT_THAT(refused(shipped("kinco-jd"), kinco), ElementsAre(fault_at("/axes/0/motor", "it has A")));
}

TEST(KeyaModes, OnItsOwnProtocolsAMotorHasTheModeOfTheMakersToolAndNoOther) {
  for (const std::string protocol : keya::kFixed) {
    ResolveInput input = keya::in_mode(protocol, keya::kSpeed);
    input.constants["control_mode_b"] = Rational(keya::kAbsolute);
    const model::DriveModel model = keya::model(input);
    EXPECT_THAT(model.axes[0].modes, ElementsAre(Pair(3, 3)));
    EXPECT_THAT(motions(model.axes[0]), ElementsAre(Command::run_velocity));
    EXPECT_THAT(targets(model.axes[0]), ElementsAre(Quantity::target_velocity));
    EXPECT_EQ(model.axes[0].supported_modes, 0x0004);
    EXPECT_THAT(model.axes[1].modes, ElementsAre(Pair(1, 1)));
    EXPECT_THAT(motions(model.axes[1]), ElementsAre(Command::move_absolute, Command::move_relative));
    EXPECT_THAT(targets(model.axes[1]), ElementsAre(Quantity::target_position));
    const model::AxisModel torque = keya::model(keya::in_mode(protocol, keya::kTorque)).axes[0];
    EXPECT_THAT(torque.modes, ElementsAre(Pair(4, 4)));
    EXPECT_THAT(targets(torque), ElementsAre(Quantity::target_torque));
    EXPECT_THAT(motions(torque), IsEmpty()) << "run_torque needs a speed limit that the drive is known to hold";
  }
}

TEST(KeyaModes, OnCanopenTheEnableChoosesSpeedOrPositionAndTorqueMustBeConfigured) {
  const model::AxisModel speed = keya::model(keya::in_mode("canopen", keya::kSpeed)).axes[0];
  EXPECT_THAT(speed.modes, ElementsAre(Pair(3, 3), Pair(1, 1))) << "what it was set to is what it begins with";
  EXPECT_TRUE(speed.mode_needs_disabled);
  EXPECT_THAT(motions(speed), ElementsAre(Command::move_absolute, Command::move_relative, Command::run_velocity,
                                          Command::set_position));
  EXPECT_THAT(targets(speed), ElementsAre(Quantity::target_position, Quantity::target_velocity));
  const model::AxisModel torque = keya::model(keya::in_mode("canopen", keya::kTorque)).axes[1];
  EXPECT_THAT(torque.modes, ElementsAre(Pair(4, 4), Pair(1, 1), Pair(3, 3)));
  EXPECT_FALSE(resolved(shipped("kinco-jd"), kinco_axis()).axes[0].mode_needs_disabled);
}

TEST(KeyaModes, RelativePositionIsRefusedWithTheReason) {
  for (const std::string protocol : keya::kProtocols)
    EXPECT_THAT(refused_with(keya::in_mode(protocol, 4)),
                ElementsAre(fault_at("/constants/control_mode_a", "must never be sent again"),
                            fault_at("/constants/control_mode_b", "must be 1 to 3, is 4")));
  ResolveInput half = keya::drive("keya-can");
  half.constants["control_mode_a"] = Rational(3, 2);
  EXPECT_THAT(refused_with(half), ElementsAre(fault_at("/constants/control_mode_a", "must be one of 1, 2, 3")));
}

TEST(KeyaModes, TorqueModeWithoutItsCurrentsIsRefusedAndNamesThem) {
  ResolveInput input = keya::drive("keya-rs232", {"B"});
  input.constants["control_mode_b"] = Rational(keya::kTorque);
  input.constants["rated_current_b_arms"] = Rational(10);
  EXPECT_THAT(refused_with(input),
              ElementsAre(fault_at("/constants/control_mode_b", "give also configured_current_b_arms")));
}

TEST(KeyaModes, AnotherModeThanTheConfiguredOneIsAnotherDrive) {
  for (const std::string protocol : keya::kFixed) {
    const model::DriveModel model = keya::model(keya::in_mode(protocol, keya::kAbsolute));
    ASSERT_EQ(model.checks.size(), 1U);
    const model::Check& check = model.checks[0];
    EXPECT_EQ(check.alarm, AxisAlarm::identity_mismatch);
    EXPECT_EQ(check.slot, 0);
    const model::ObjectDef& shown = model.object(check.bad.object);
    EXPECT_FALSE(check.bad.holds(shown, 0x30));
    EXPECT_FALSE(check.bad.holds(shown, 0x35)) << "the low four bits say nothing";
    EXPECT_TRUE(check.bad.holds(shown, 0x10));
    EXPECT_TRUE(check.bad.holds(shown, 0x40));
  }
  const model::DriveModel second = keya::model(keya::drive("keya-rs485", {"B", "A"}));
  ASSERT_EQ(second.checks.size(), 1U);
  EXPECT_EQ(second.checks[0].slot, 1);
  EXPECT_THAT(keya::model(keya::drive("canopen")).checks, IsEmpty()) << "203Ah has no known layout";
}

TEST(KeyaModes, TheSetpointOfTheModeIsRepeatedWhereAWatchdogWaits) {
  for (const std::string protocol : keya::kProtocols) {
    const bool watched = protocol != "keya-rs485";
    for (const auto& [mode, object] : {std::pair(keya::kSpeed, std::pair(3, "B.target_velocity")),
                                       {keya::kTorque, {4, "B.target_torque"}},
                                       {keya::kAbsolute, {1, "B.target_position"}}}) {
      SCOPED_TRACE(protocol + " " + object.second);
      const model::DriveModel model = keya::model(keya::in_mode(protocol, mode));
      EXPECT_EQ(model.keep_alive, watched ? milliseconds(300) : Duration{});
      EXPECT_EQ(model.stops_by_itself, watched);
      const std::uint16_t told = protocol == "canopen" ? kLossNotKnown : 1000;
      EXPECT_EQ(model::loss_stop_ms(model, {}), watched ? told : kGoesOn) << "nothing is written to it for that";
      const auto& rows = model.axes[1].keep_alive;
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.first == object.first; });
      ASSERT_EQ(row != rows.end(), watched);
      if (watched) {
        EXPECT_EQ(model.object(row->second).name, object.second);
      }
      EXPECT_EQ(rows.size(), watched ? model.axes[1].modes.size() : 0U);
    }
  }
  const model::DriveModel kinco = resolved(shipped("kinco-jd"), kinco_axis());
  EXPECT_EQ(kinco.keep_alive, Duration{});
  EXPECT_THAT(kinco.axes[0].keep_alive, IsEmpty());
}

TEST(KeyaModes, OneQueryAnswersForBothMotorsInOnePollClass) {
  for (const std::string protocol : keya::kProtocols) {
    const model::DriveModel model = keya::model(keya::in_mode(protocol, keya::kSpeed));
    std::map<std::pair<int, int>, model::PollClass> classes;
    for (const model::AxisModel& axis : model.axes) {
      EXPECT_EQ(axis.binding(Quantity::velocity_actual)->poll, model::PollClass::fast);
      EXPECT_EQ(axis.binding(Quantity::position_actual)->poll, model::PollClass::fast);
      EXPECT_EQ(axis.binding(Quantity::motor_temperature)->poll, model::PollClass::slow);
      for (const model::Binding& binding : axis.bindings) {
        if (binding.object == model::kNoObject || model.object(binding.object).emulated) continue;
        const ObjectAddress at = model.object(binding.object).address;
        if (binding.quantity == Quantity::torque_actual) continue;  // the same object as current_actual
        EXPECT_EQ(classes.emplace(std::pair(at.index, at.sub), binding.poll).first->second, binding.poll)
            << row(binding.quantity).name;
      }
    }
  }
}

}  // namespace
}  // namespace axisgate::profile
