// SPDX-License-Identifier: Apache-2.0
// Units of an axis: units per revolution, inversion, torque by rated current, composed bits.
#include "gateway/model/scale.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

TEST(ResolvedScale, UnitsPerRevolutionMayBeAFraction) {
  ResolveInput input = kinco_axis();
  input.axes[0].units_per_rev = Rational(60000, 37);  // a 37:12 gear with 5 mm pitch, in um
  const model::DriveModel model = resolved(shipped("kinco-jd"), input);
  EXPECT_EQ(binding(model, Quantity::target_position).raw_per_unit, Rational(37, 6));
  EXPECT_EQ(sent(model, Quantity::target_position, 60000), 370000);
  EXPECT_EQ(sent(model, Quantity::target_position, 1), 6);
}

TEST(ResolvedScale, TorqueNeedsTheRatedCurrent) {
  ResolveInput input = kinco_axis();
  const model::DriveModel without = resolved(shipped("kinco-jd"), input);
  EXPECT_EQ(without.axes[0].binding(Quantity::torque_actual), nullptr);
  EXPECT_FALSE(without.axes[0].command(Command::run_torque));
  EXPECT_EQ(without.axes[0].supported_modes & 0x0008, 0) << "torque mode without a torque set-point";
  EXPECT_EQ(without.axes[0].zero_before_enable.size(), 3U) << "its current set-points are made 0 all the same";

  input.constants["rated_current_a"] = Rational(4);
  const model::DriveModel model = resolved(shipped("kinco-jd"), input);
  // 100.0 % of 4 A rms: 4 * 1.414 * 2048 / 27.5 = 421.217...
  EXPECT_EQ(sent(model, Quantity::target_torque, 1000), 421);
  EXPECT_EQ(sent(model, Quantity::max_torque, 1000), 421);
  EXPECT_TRUE(model.axes[0].command(Command::run_torque));
  EXPECT_NE(model.axes[0].supported_modes & 0x0008, 0);
}

TEST(ResolvedScale, AnInvertedAxisNegatesWhatHasADirectionAndNothingElse) {
  ResolveInput input = kinco_axis();
  input.constants["rated_current_a"] = Rational(4);
  input.axes[0].inverted = true;
  const model::DriveModel model = resolved(shipped("kinco-jd"), input);
  for (const Quantity q :
       {Quantity::position_actual, Quantity::velocity_actual, Quantity::torque_actual, Quantity::current_actual,
        Quantity::following_error, Quantity::target_position, Quantity::target_velocity, Quantity::target_torque,
        Quantity::position_limit_min, Quantity::position_limit_max})
    EXPECT_LT(binding(model, q).raw_per_unit.numerator(), 0) << row(q).name;
  for (const Quantity q :
       {Quantity::profile_velocity, Quantity::profile_acceleration, Quantity::max_torque, Quantity::max_velocity,
        Quantity::dc_voltage, Quantity::drive_temperature, Quantity::homing_speed_switch})
    EXPECT_GT(binding(model, q).raw_per_unit.numerator(), 0) << row(q).name;
  EXPECT_EQ(sent(model, Quantity::target_position, 5000), -5000);
  EXPECT_EQ(binding(model, Quantity::velocity_actual).to_register(100), -100000);
}

TEST(ResolvedScale, AnInvertedAxisSwapsItsLimits) {
  ResolveInput input = kinco_axis();
  input.axes[0].inverted = true;
  const model::DriveModel model = resolved(shipped("kinco-jd"), input);
  EXPECT_EQ(model.object(binding(model, Quantity::position_limit_min).object).name, "position_limit_positive");
  EXPECT_EQ(model.object(binding(model, Quantity::position_limit_max).object).name, "position_limit_negative");
  const std::vector<model::BitField>& bits = binding(model, Quantity::digital_inputs).bits;
  const auto target_of = [&](const std::string& object, std::uint8_t from) {
    for (const model::BitField& field : bits)
      if (model.object(field.object).name == object && field.from == from) return static_cast<int>(field.to);
    return -1;
  };
  EXPECT_EQ(target_of("input_functions", 0), 1) << "the drive's negative limit is the axis's positive one";
  EXPECT_EQ(target_of("input_functions", 1), 0);
  EXPECT_EQ(target_of("input_functions", 2), 2);
  EXPECT_EQ(target_of("input_levels", 0), 4);
  EXPECT_EQ(target_of("input_levels", 7), 11);
}

TEST(ResolvedScale, ErrorCodeComesFromTheAlarmTableAndNoObject) {
  const model::DriveModel model = resolved(shipped("kinco-jd"), kinco_axis());
  const model::Binding& code = binding(model, Quantity::error_code);
  EXPECT_EQ(code.object, model::kNoObject);
  EXPECT_TRUE(code.bits.empty());
  EXPECT_NE(model.axes[0].supported & bit(Quantity::error_code), 0U);
}

TEST(ResolvedScale, BindingsAreInTheOrderOfTheQuantitiesAndFoundByNumber) {
  const model::DriveModel model = resolved(shipped("kinco-md"), kinco_axis());
  const model::AxisModel& axis = model.axes[0];
  std::uint32_t seen = 0;
  for (std::size_t i = 0; i < axis.bindings.size(); ++i) {
    const model::Binding& bound = axis.bindings[i];
    EXPECT_EQ(axis.binding(bound.quantity), &bound);
    EXPECT_TRUE(i == 0 || axis.bindings[i - 1].quantity < bound.quantity);
    seen |= bit(bound.quantity);
  }
  EXPECT_EQ(seen, axis.supported);
  EXPECT_EQ(axis.binding(Quantity::motor_temperature), nullptr);
  EXPECT_EQ(axis.binding(Quantity::dc_voltage), nullptr) << "the MD manual gives no object";
}

/// A drive whose ramp is a time, in ms to 1000 rpm.
class InverseRamp : public ::testing::Test {
 protected:
  model::DriveModel with(const nlohmann::json& unit, const ResolveInput& input = one_axis("modbus-rtu")) {
    auto profile = nlohmann::json::parse(test::content(valid_file("virtual")));
    profile["units"]["ramp"] = unit;
    if (unit["mul"][1].is_number())  // else it cannot be known beforehand
      profile["setup"] = {{{"write", "ramp"}, {"value", "500 rpm/s"}, {"why", "to be sure of it"}}};
    return resolved(load_profile(folder_.write("virtual.json", profile.dump()).string()), input);
  }
  const nlohmann::json unit_{{"base", "rpm/s"}, {"mul", {1000, 1000}}, {"inverse", true}};
  const test::OwnFolder folder_;
};

TEST_F(InverseRamp, IsLongWhereTheAccelerationIsSmall) {
  const model::DriveModel model = with(unit_);
  const model::Binding& ramp = binding(model, Quantity::profile_acceleration);
  EXPECT_EQ(sent(model, Quantity::profile_acceleration, 5'000), 2000) << "500.0 rpm/s";
  EXPECT_EQ(sent(model, Quantity::profile_acceleration, 30'000), 333);
  EXPECT_EQ(ramp.to_register(2000), 5'000);
  EXPECT_EQ(ramp.to_register(333), 30'030);
  EXPECT_EQ(ramp.to_register(0), std::nullopt) << "no ramp at all has no number";
  EXPECT_EQ(sent(model, Quantity::profile_acceleration, 0), std::nullopt);
  EXPECT_EQ(model.setup.at(0).raw, 2000);
}

TEST_F(InverseRamp, IsNeverSteeperThanTheLimit) {
  ResolveInput input = one_axis("modbus-rtu");
  input.axes[0].limits.acceleration = 29'990;
  const model::DriveModel model = with(unit_, input);
  EXPECT_EQ(binding(model, Quantity::profile_acceleration).limits, (Range{153, 29'990})) << "65535 ms at the most";
  EXPECT_EQ(sent(model, Quantity::profile_acceleration, 29'990), 334) << "333 ms would be steeper";
}

TEST_F(InverseRamp, MayWaitForAConstantOfTheDrive) {
  model::DriveModel model = with({{"base", "rpm/s"}, {"mul", {1000, "counts"}}, {"inverse", true}});
  model::Binding ramp = binding(model, Quantity::profile_acceleration);
  EXPECT_EQ(ramp.to_register(2000), std::nullopt);
  model::apply_recipe(ramp, {Rational(3000)}, model.object(ramp.object));
  EXPECT_EQ(ramp.to_register(2000), 15'000) << "ms to 3000 rpm";
  EXPECT_EQ(ramp.limits.min, 458);
}

}  // namespace
}  // namespace axisgate::profile
