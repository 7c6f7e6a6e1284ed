// SPDX-License-Identifier: Apache-2.0
// The shipped Keya profile: the manual's conversions come out, and what counts by unknown constants is not supported.
#include <gmock/gmock.h>

#include <cmath>
#include <regex>
#include <set>

#include "tests/profiles/keya.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

/// The first number of "750 rpm at rated 1500 rpm".
double number_in(const std::string& said) {
  std::smatch found;
  static const std::regex form(R"(-?[0-9]+(\.[0-9]+)?)");
  return std::regex_search(said, found, form) ? std::stod(found[0]) : 0;
}

/// The rows of the manual that a bus can carry, in register units.
struct Conversion {
  Quantity quantity{};
  std::int64_t value = 0;
};

std::optional<Conversion> conversion_of(const json& row) {
  const std::string quantity = row.at("quantity");
  const std::string said = row.at("engineering");
  const double number = number_in(said);
  const auto rounded = [](double value) { return static_cast<std::int64_t>(std::llround(value)); };
  if (quantity.starts_with("speed command")) {
    const double rpm = said.find('%') == std::string::npos ? number : number * 15;
    return Conversion{Quantity::target_velocity, rounded(rpm * 1000)};
  }
  if (quantity.starts_with("torque command")) return Conversion{Quantity::target_torque, rounded(number * 10)};
  if (quantity.starts_with("position command") || quantity.starts_with("encoder count")) {
    const double sign = said.find("turns clockwise") == std::string::npos ? 1 : -1;
    const double turns = said.find("degrees") == std::string::npos ? number : number / 360;
    const bool command = quantity.starts_with("position");
    return Conversion{command ? Quantity::target_position : Quantity::position_actual, rounded(sign * turns * 10000)};
  }
  if (quantity.starts_with("actual speed")) return Conversion{Quantity::velocity_actual, rounded(number * 1000)};
  if (quantity == "current") return Conversion{Quantity::current_actual, rounded(number * 100)};
  if (quantity == "bus voltage") return Conversion{Quantity::dc_voltage, rounded(number * 10)};
  if (quantity == "temperature") return Conversion{Quantity::drive_temperature, rounded(number * 10)};
  return std::nullopt;
}

std::int64_t mode_for(Quantity quantity) {
  if (quantity == Quantity::target_torque) return keya::kTorque;
  return quantity == Quantity::target_position ? keya::kAbsolute : keya::kSpeed;
}

TEST(KeyaConversions, OfTheManualComeOutOnEveryProtocolAndBothMotors) {
  for (const std::string protocol : keya::kProtocols) {
    int checked = 0;
    for (const json& row : keya::vectors("conversions")) {
      const std::optional<Conversion> wanted = conversion_of(row);
      if (!wanted) continue;
      SCOPED_TRACE(protocol + " " + row.dump());
      const model::DriveModel model = keya::model(keya::in_mode(protocol, mode_for(wanted->quantity)));
      for (const model::AxisModel& axis : model.axes) {
        const model::Binding* binding = axis.binding(wanted->quantity);
        ASSERT_NE(binding, nullptr);
        const std::int64_t raw = row.at("raw");
        EXPECT_EQ(binding->to_register(raw), wanted->value);
        EXPECT_EQ(binding->to_raw(wanted->value, model.object(binding->object)), raw);
      }
      ++checked;
    }
    EXPECT_EQ(checked, 18) << "the others are parameters of the maker's tool, codes and versions";
  }
}

TEST(KeyaConversions, CodesOfTheManualAreThoseThatAreSent) {
  const model::DriveModel model = keya::model(keya::in_mode("canopen", keya::kTorque));
  std::set<std::string> sent;
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (const Command command : {Command::enable, Command::disable}) sent.insert(keya::steps(model, axis, command, 4));
  int checked = 0;
  for (const json& row : keya::vectors("conversions")) {
    const std::string quantity = row.at("quantity");
    if (!quantity.starts_with("CANopen enable") && !quantity.starts_with("CANopen disable")) continue;
    const std::string motor = quantity.substr(quantity.size() - 1);
    const std::string write = motor + ".command=" + std::to_string(row.at("raw").get<std::int64_t>());
    EXPECT_TRUE(std::any_of(sent.begin(), sent.end(), [&](const auto& steps) { return steps.starts_with(write); }))
        << quantity;
    ++checked;
  }
  EXPECT_EQ(checked, 4);
}

TEST(KeyaConversions, EachMotorCountsByItsOwnConstants) {
  ResolveInput input = keya::in_mode("keya-can", keya::kSpeed);
  input.constants["rated_speed_b_rpm"] = Rational(3000);
  input.constants["counts_per_rev_b"] = Rational(20000);
  input.constants["rated_current_b_arms"] = Rational(5);
  const model::DriveModel model = keya::model(input);
  const auto raw = [&](std::size_t axis, Quantity quantity, std::int64_t value) {
    const model::Binding* binding = model.axes[axis].binding(quantity);
    return binding->to_raw(value, model.object(binding->object));
  };
  EXPECT_EQ(model.axes[0].rated_speed, 1'500'000U);
  EXPECT_EQ(model.axes[1].rated_speed, 3'000'000U);
  EXPECT_EQ(raw(0, Quantity::target_velocity, 1500000), 10000);
  EXPECT_EQ(raw(1, Quantity::target_velocity, 1500000), 5000);
  EXPECT_EQ(model.axes[0].binding(Quantity::target_velocity)->limits, (Range{-1500000, 1500000}));
  EXPECT_EQ(model.axes[1].binding(Quantity::position_actual)->to_register(20000), 10000);
  // 5 A are 33.3 % of motor A's rated current, and all of B's.
  EXPECT_EQ(model.axes[0].binding(Quantity::torque_actual)->to_register(5), 333);
  EXPECT_EQ(model.axes[1].binding(Quantity::torque_actual)->to_register(5), 1000);
}

TEST(KeyaConversions, WithoutItsCurrentsAMotorHasNoTorque) {
  for (const std::string protocol : keya::kProtocols) {
    ResolveInput input = keya::drive(protocol);
    input.constants["rated_current_b_arms"] = Rational(15);
    const model::DriveModel model = keya::model(input);
    EXPECT_EQ(model.axes[0].binding(Quantity::torque_actual), nullptr) << protocol;
    EXPECT_NE(model.axes[1].binding(Quantity::torque_actual), nullptr) << protocol;
    for (const model::AxisModel& axis : model.axes) {
      EXPECT_EQ(axis.binding(Quantity::target_torque), nullptr) << protocol;
      EXPECT_NE(axis.binding(Quantity::current_actual), nullptr) << protocol;
    }
  }
}

TEST(KeyaConversions, ATemperatureBelowZeroIsNoHotMotor) {
  const model::DriveModel model = keya::model(keya::drive("keya-rs232"));
  const model::Binding* temperature = model.axes[0].binding(Quantity::motor_temperature);
  EXPECT_EQ(temperature->to_register(model.object(temperature->object).number(0xE4)), -280);
}

}  // namespace
}  // namespace axisgate::profile
