// SPDX-License-Identifier: Apache-2.0
// Limits of a write: register type, object, profile and axis together, rounded inwards.
#include "gateway/model/scale.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

TEST(ResolvedLimits, TheDrivesOwnClampIsALimitRoundedInwards) {
  const model::DriveModel model = resolved(shipped("kinco-jd"), kinco_axis());
  const model::Binding& velocity = binding(model, Quantity::target_velocity);
  EXPECT_EQ(velocity.limits, (Range{-6143999, 6143999}));
  EXPECT_LE(sent(model, Quantity::target_velocity, velocity.limits.max), 16777215);
  EXPECT_GE(sent(model, Quantity::target_velocity, velocity.limits.min), -16777215);
}

TEST(ResolvedLimits, EveryValueWithinTheLimitsFitsTheObjectOnBothEnds) {
  for (const std::string drive : {"kinco-jd", "kinco-md"}) {
    for (const bool inverted : {false, true}) {
      ResolveInput input = kinco_axis();
      input.constants["rated_current_a"] = Rational(7, 3);
      input.axes[0].inverted = inverted;
      input.axes[0].units_per_rev = Rational(360001, 37);
      const model::DriveModel model = resolved(shipped(drive), input);
      for (const model::Binding& bound : model.axes[0].bindings) {
        if (!bound.writable) continue;
        SCOPED_TRACE(drive + " " + std::string(row(bound.quantity).name));
        EXPECT_LT(bound.limits.min, bound.limits.max);
        EXPECT_TRUE(bound.to_raw(bound.limits.min, model.object(bound.object)));
        EXPECT_TRUE(bound.to_raw(bound.limits.max, model.object(bound.object)));
      }
    }
  }
}

// 3.3 Zeros: 0 is no speed, no ramp and no max_torque, nor is what a drive would hold as 0.
TEST(ResolvedLimits, SpeedsRampsAndTorqueStartAtTheLeastThatTheDriveHolds) {
  ResolveInput input = kinco_axis();
  input.constants["rated_current_a"] = Rational(4);
  for (const char* profile : {"kinco-jd", "kinco-md"}) {
    const model::DriveModel model = resolved(shipped(profile), input);
    for (const Quantity q : {Quantity::profile_velocity, Quantity::profile_acceleration, Quantity::max_velocity,
                             Quantity::homing_speed_zero, Quantity::max_torque}) {
      const model::Binding& bound = binding(model, q);
      EXPECT_GE(bound.to_raw(bound.limits.min, model.object(bound.object)).value_or(0), 1) << profile << row(q).name;
      EXPECT_GT(bound.limits.min, 0) << profile << row(q).name;
    }
  }
}

TEST(ResolvedLimits, TheAxisLimitsNarrowWhatAClientMayWrite) {
  ResolveInput input = kinco_axis();
  input.constants["rated_current_a"] = Rational(4);
  input.axes[0].limits.position = Range{-1000, 250000};
  input.axes[0].limits.velocity = 1500000;
  input.axes[0].limits.acceleration = 6000;
  input.axes[0].limits.torque = 800;
  input.axes[0].limits.quick_stop_deceleration_min = 3000;
  const model::DriveModel model = resolved(shipped("kinco-md"), input);
  EXPECT_EQ(binding(model, Quantity::target_position).limits, (Range{-1000, 250000}));
  EXPECT_EQ(binding(model, Quantity::target_velocity).limits, (Range{-1500000, 1500000}));
  EXPECT_EQ(binding(model, Quantity::profile_velocity).limits.max, 1500000);
  EXPECT_EQ(binding(model, Quantity::max_velocity).limits.max, 1500000);
  EXPECT_EQ(binding(model, Quantity::profile_deceleration).limits.max, 6000);
  EXPECT_EQ(binding(model, Quantity::target_torque).limits, (Range{-800, 800}));
  EXPECT_EQ(binding(model, Quantity::max_torque).limits, (Range{3, 800}));
  EXPECT_EQ(binding(model, Quantity::quick_stop_deceleration).limits.min, 3000);
  EXPECT_TRUE(model.axes[0].configured_torque_limit);
}

TEST(ResolvedLimits, TheProfilesLimitFollowsItsConstant) {
  ResolveInput input = kinco_axis();
  EXPECT_EQ(binding(resolved(shipped("kinco-md"), input), Quantity::target_velocity).limits,
            (Range{-3000000, 3000000}));
  input.constants["rated_speed_rpm"] = Rational(2500);
  EXPECT_EQ(binding(resolved(shipped("kinco-md"), input), Quantity::target_velocity).limits,
            (Range{-2500000, 2500000}));
}

TEST(ResolvedLimits, TheProfilesLimitOfAnInvertedAxisIsTurnedRound) {
  ResolveInput input = one_axis();
  EXPECT_EQ(binding(resolved(valid_file("derived"), input), Quantity::target_velocity).limits,
            (Range{-1000000, 2000000}));
  input.axes[0].inverted = true;
  EXPECT_EQ(binding(resolved(valid_file("derived"), input), Quantity::target_velocity).limits,
            (Range{-2000000, 1000000}));
}

TEST(RatedSpeed, IsTheConstantOfTheMotorOrNotKnown) {
  ResolveInput input = kinco_axis();
  EXPECT_EQ(resolved(shipped("kinco-md"), input).axes[0].rated_speed, 3'000'000U);
  EXPECT_FALSE(resolved(shipped("kinco-jd"), input).axes[0].rated_speed.has_value());
  input.constants["rated_speed_rpm"] = Rational(25001, 10);
  EXPECT_EQ(resolved(shipped("kinco-md"), input).axes[0].rated_speed, 2'500'100U);
}

TEST(ResolvedLimits, AnAxisLimitThatLeavesNothingIsAFault) {
  ResolveInput input = kinco_axis();
  input.axes[0].limits.position = Range{3000000000, 4000000000};
  const std::vector<Fault> faults = refused(shipped("kinco-jd"), input);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0].pointer, "/axes/0/limits/position");
  EXPECT_EQ(faults[0].message,
            "leaves no value for target_position, which this drive takes from -2147483647 to 2147483647");
}

TEST(Scale, RangesAreRoundedInwardsAlsoForNegativeFactors) {
  EXPECT_EQ(model::registers_within({-10, 10}, Rational(3)), (Range{-3, 3}));
  EXPECT_EQ(model::registers_within({-10, 20}, Rational(-3)), (Range{-6, 3}));
  EXPECT_EQ(model::registers_within({0, 255}, Rational(1, 2)), (Range{0, 510}));
  EXPECT_EQ(model::registers_within({INT64_MIN, INT64_MAX}, Rational(1, 1000)), (Range{INT64_MIN, INT64_MAX}))
      << "saturates, never wraps";
}

TEST(Scale, AmountsKeepTheirFraction) {
  EXPECT_EQ(model::rounded_up(Rational(7, 2)), 4);
  EXPECT_EQ(model::rounded_down(Rational(7, 2)), 3);
  EXPECT_EQ(model::rounded_up(Rational(-7, 2)), -3);
  EXPECT_EQ(model::rounded_down(Rational(-7, 2)), -4);
}

}  // namespace
}  // namespace axisgate::profile
