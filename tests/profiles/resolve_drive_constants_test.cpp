// SPDX-License-Identifier: Apache-2.0
// Constants that are read from the drive: their rules, what waits for them, and scale and limits once they are known.
#include <gmock/gmock.h>

#include "gateway/model/scale.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using testing::ElementsAre;
using Known = std::vector<std::optional<Rational>>;

model::DriveModel waiting(ResolveInput input = one_axis("modbus-rtu")) {
  return resolved(valid_file("virtual"), input);
}

/// The model as the drive layer makes it once it has read the constants.
model::DriveModel applied(model::DriveModel model, const Known& constants) {
  for (model::Binding& bound : model.axes.at(0).bindings)
    if (bound.object != model::kNoObject) model::apply_recipe(bound, constants, model.object(bound.object));
  return model;
}

/// What `counts` is where the drive holds these numbers.
std::optional<Rational> counts_of(const model::DriveModel& model, std::map<std::string, std::int64_t> held) {
  return model::evaluate(model.constants.at(0),
                         [&](model::ObjectId id) -> std::optional<std::int64_t> {
                           const auto at = held.find(model.object(id).name);
                           return at == held.end() ? std::nullopt : std::optional(at->second);
                         })
      .value;
}

TEST(DriveConstants, AreListedOnceInTheOrderOfNeed) {
  ResolveInput input = one_axis("modbus-rtu");
  input.constants["spindle"] = Rational(5);
  const model::DriveModel model = waiting(input);
  ASSERT_EQ(model.constants.size(), 2U);
  EXPECT_EQ(model.constants[0].name, "counts");
  EXPECT_EQ(model.constants[1].name, "scale");
  EXPECT_THAT(binding(model, Quantity::target_position).recipe.mul, ElementsAre(0U));
  EXPECT_THAT(binding(model, Quantity::profile_velocity).recipe.div, ElementsAre(0U));
  EXPECT_THAT(binding(model, Quantity::profile_acceleration).recipe.mul, ElementsAre(1U));
}

TEST(DriveConstants, ThatNeedAConstantNobodyGaveAreNotSupported) {
  const model::DriveModel model = waiting();
  ASSERT_EQ(model.constants.size(), 1U) << "\"scale\" needs \"spindle\"";
  EXPECT_EQ(model.axes[0].binding(Quantity::profile_acceleration), nullptr);
}

TEST(DriveConstants, TheFirstRuleThatHoldsGivesTheValue) {
  const model::DriveModel model = waiting();
  EXPECT_EQ(counts_of(model, {{"resolution", 4096}, {"gear", 3}, {"lines", 9}}), Rational(4096));
  EXPECT_EQ(counts_of(model, {{"resolution", 0}, {"gear", 3}, {"lines", 9}}), Rational(9)) << "teeth are 3 as well";
  EXPECT_EQ(counts_of(model, {{"resolution", 0}, {"gear", 5}, {"lines", 100}}), Rational(2000, 3));
  EXPECT_EQ(counts_of(model, {{"gear", 5}, {"lines", 100}}), std::nullopt) << "the first rule cannot be judged";
}

TEST(DriveConstants, WhatWaitsForThemHasNoValueAndItsLimitsAreProvisional) {
  const model::DriveModel model = waiting();
  const model::Binding& target = binding(model, Quantity::target_position);
  EXPECT_FALSE(target.scaled);
  EXPECT_TRUE(target.recipe.waits());
  EXPECT_EQ(target.to_register(1000), std::nullopt);
  EXPECT_EQ(sent(model, Quantity::target_position, 1000), std::nullopt);
  EXPECT_EQ(target.limits, (Range{-1000000, 1000000})) << "the profile's 100 turns";
  EXPECT_EQ(target.limits, target.recipe.allowed);
  EXPECT_EQ(target.recipe.raw, (Range{-2147483648LL, 2147483647LL}));
  EXPECT_EQ(binding(model, Quantity::target_velocity).recipe.raw, (Range{-20000, 20000}));
  EXPECT_TRUE(binding(model, Quantity::homing_method).scaled);
  EXPECT_FALSE(binding(model, Quantity::homing_method).recipe.waits());
}

TEST(DriveConstants, AConfiguredConstantIsNotRead) {
  ResolveInput input = one_axis("modbus-rtu");
  input.constants["counts"] = Rational(2000);
  const model::DriveModel model = waiting(input);
  EXPECT_TRUE(model.constants.empty());
  EXPECT_TRUE(binding(model, Quantity::target_position).scaled);
  EXPECT_EQ(sent(model, Quantity::target_position, 10000), 2000);
  input.constants["counts"] = Rational(0);
  EXPECT_EQ(refused(valid_file("virtual"), input).at(0).message, "must be 1 to 1000000, is 0");
}

TEST(DriveConstants, OnceReadABindingIsAsIfTheyHadBeenConfigured) {
  for (const bool inverted : {false, true}) {
    ResolveInput input = one_axis("modbus-rtu");
    input.axes[0].inverted = inverted;
    input.axes[0].units_per_rev = Rational(60000, 37);
    input.axes[0].limits.position = Range{-1000, 250000};
    input.axes[0].limits.velocity = 700000;
    const model::DriveModel read = applied(waiting(input), {Rational(2000, 3)});
    input.constants["counts"] = Rational(2000, 3);
    const model::DriveModel configured = waiting(input);
    ASSERT_EQ(read.axes[0].supported, configured.axes[0].supported);
    for (const model::Binding& bound : read.axes[0].bindings) {
      SCOPED_TRACE(row(bound.quantity).name);
      EXPECT_TRUE(bound.scaled);
      EXPECT_EQ(bound.raw_per_unit, binding(configured, bound.quantity).raw_per_unit);
      EXPECT_EQ(bound.limits, binding(configured, bound.quantity).limits);
    }
    EXPECT_EQ(binding(read, Quantity::target_position).raw_per_unit.numerator() < 0, inverted);
    EXPECT_GT(binding(read, Quantity::profile_velocity).raw_per_unit.numerator(), 0) << "a magnitude";
  }
}

TEST(DriveConstants, TheObjectsOwnRangeLimitsAWriteOnceTheScaleIsKnown) {
  const model::DriveModel model = applied(waiting(), {Rational(6000)});
  // 20000 counts/s of 6000 a turn are 200 rpm.
  EXPECT_EQ(binding(model, Quantity::target_velocity).limits, (Range{-200000, 200000}));
  EXPECT_EQ(sent(model, Quantity::target_velocity, 200000), 20000);
  const model::DriveModel another = applied(model, {Rational(3000)});
  EXPECT_EQ(binding(another, Quantity::target_velocity).limits, (Range{-400000, 400000})) << "made anew, not narrowed";
}

TEST(DriveConstants, WithoutAUsableValueThereIsNoScale) {
  const Rational prime_in_32_bits(2147483647);
  for (const std::optional<Rational>& useless :
       {std::optional<Rational>{}, std::optional(Rational(0)), std::optional(Rational(-4096))}) {
    const model::DriveModel model = applied(applied(waiting(), {Rational(6000)}), {useless});
    const model::Binding& target = binding(model, Quantity::target_position);
    EXPECT_FALSE(target.scaled);
    EXPECT_EQ(target.to_register(1), std::nullopt);
    EXPECT_EQ(target.limits, target.recipe.allowed);
    EXPECT_FALSE(binding(model, Quantity::profile_velocity).scaled) << "divided by it";
  }
  EXPECT_FALSE(binding(applied(waiting(), {}), Quantity::target_position).scaled) << "as good as not known";
  EXPECT_TRUE(binding(applied(waiting(), {prime_in_32_bits}), Quantity::target_position).scaled);
}

TEST(DriveConstants, AScaleBeyondSixtyFourBitsIsNoneAndNoCrash) {
  ResolveInput input = one_axis("modbus-rtu");
  input.axes[0].units_per_rev = Rational(1000000000039);
  const model::DriveModel model = applied(waiting(input), {Rational(1, 4294967291)});
  EXPECT_FALSE(binding(model, Quantity::target_position).scaled);
  EXPECT_FALSE(binding(model, Quantity::position_actual).scaled);
  EXPECT_TRUE(binding(model, Quantity::target_velocity).scaled);
}

/// The drive of valid/virtual.json with other rules for its constant `counts`.
class Rules : public ::testing::Test {
 protected:
  model::DriveModel with(const std::string& rules) {
    auto profile = nlohmann::json::parse(test::content(valid_file("virtual")));
    profile["constants"]["counts"]["first"] = nlohmann::json::parse(rules);
    return resolved(load_profile(folder_.write("virtual.json", profile.dump()).string()), one_axis("modbus-rtu"));
  }
  /// Where it holds these, and has refused all others.
  static model::Evaluated found(const model::DriveModel& model, const std::map<std::string, std::int64_t>& held) {
    const auto name = [&](model::ObjectId id) { return model.object(id).name; };
    return model::evaluate(
        model.constants.at(0),
        [&](model::ObjectId id) {
          const auto at = held.find(name(id));
          return at == held.end() ? std::nullopt : std::optional(at->second);
        },
        [&](model::ObjectId id) { return !held.contains(name(id)); });
  }
  const test::OwnFolder folder_;
};

TEST_F(Rules, TakeAnotherObjectWhereTheFirstIsNotThere) {
  const model::DriveModel model = with(R"([{"if": ["resolution", "present"], "value": ["resolution"]},
                                           {"value": ["lines", "*", 4]}])");
  EXPECT_EQ(found(model, {{"resolution", 4096}, {"lines", 9}}).value, Rational(4096));
  EXPECT_EQ(found(model, {{"lines", 100}}).value, Rational(400));
  EXPECT_EQ(model::evaluate(model.constants[0], [](model::ObjectId) { return std::nullopt; }).why,
            model::Evaluated::Why::not_read)
      << "whether it is there nobody knows yet";
}

TEST_F(Rules, OfSeveralConditionsTheLaterOnesWaitForThoseBefore) {
  const model::DriveModel model = with(R"([{"if": [["resolution", "present"], ["resolution", "==", 7]], "value": [70]},
                                           {"if": ["resolution", "present"], "value": "unknown"},
                                           {"value": ["lines"]}])");
  EXPECT_EQ(found(model, {{"resolution", 7}, {"lines", 9}}).value, Rational(70));
  EXPECT_EQ(found(model, {{"resolution", 8}, {"lines", 9}}).why, model::Evaluated::Why::no_rule);
  EXPECT_EQ(found(model, {{"lines", 9}}).value, Rational(9)) << "what is not there is compared with nothing";
}

TEST_F(Rules, ThatNeedAnObjectWhichWasRefusedGiveNoValueAndNameIt) {
  const model::DriveModel model = with(R"([{"if": ["gear", "==", 1], "value": ["lines"]}, {"value": "unknown"}])");
  const model::Evaluated by_condition = found(model, {{"lines", 9}});
  EXPECT_EQ(by_condition.value, std::nullopt);
  EXPECT_EQ(by_condition.why, model::Evaluated::Why::absent);
  EXPECT_EQ(model.object(by_condition.object).name, "gear");
  const model::Evaluated by_value = found(model, {{"gear", 1}});
  EXPECT_EQ(by_value.why, model::Evaluated::Why::absent);
  EXPECT_EQ(model.object(by_value.object).name, "lines");
}

TEST_F(Rules, GiveNoValueBeyondTheConstantsOwnRange) {
  const model::DriveModel model = with(R"([{"value": ["lines", "*", "10000/60"]}])");
  EXPECT_EQ(found(model, {{"lines", 3}}).value, Rational(500));
  for (const std::int64_t lines : {0, 6001})
    EXPECT_EQ(found(model, {{"lines", lines}}).why, model::Evaluated::Why::unusable) << "1 to 1000000";
}

}  // namespace
}  // namespace axisgate::profile
