// What cannot be resolved is refused by name, pointing into the drive's entry of the configuration.
#include <gmock/gmock.h>

#include "tests/profiles/resolving.hpp"

namespace axisgate::drive {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

auto says(const std::string& pointer, const std::string& words) {
  return testing::AllOf(Field(&Fault::pointer, pointer), Field(&Fault::message, HasSubstr(words)));
}

TEST(Refusals, ARequiredConstantNamesItsValues) {
  EXPECT_THAT(
      refused(valid_file("required-constant"), one_axis()),
      ElementsAre(says("/constants/counts",
                       "\"counts\" is required for profile \"required-constant\": counts of the encoder: 2500 or "
                       "10000")));
}

TEST(Refusals, AKincoWithoutItsPeakCurrentHasNoCurrentsAndNoTorque) {
  for (const std::string name : {"kinco-jd", "kinco-md"}) {
    const DriveModel model = resolved(shipped(name), one_axis());
    EXPECT_EQ(model.axes.at(0).binding(Quantity::current_actual), nullptr) << name;
    EXPECT_EQ(model.axes.at(0).binding(Quantity::torque_actual), nullptr) << name;
    EXPECT_NE(model.axes.at(0).binding(Quantity::position_actual), nullptr) << name;
  }
}

TEST(Refusals, AnUnknownConstantSuggestsTheNearest) {
  ResolveInput input = kinco_axis();
  input.constants["encoder_count_per_rev"] = Rational(65536);
  EXPECT_THAT(refused(shipped("kinco-jd"), input),
              ElementsAre(says("/constants/encoder_count_per_rev", "did you mean \"encoder_counts_per_rev\"?")));
}

TEST(Refusals, AConstantOutsideItsRangeIsRefused) {
  ResolveInput input = kinco_axis();
  input.constants["encoder_counts_per_rev"] = Rational(0);
  EXPECT_THAT(refused(shipped("kinco-jd"), input),
              ElementsAre(says("/constants/encoder_counts_per_rev", "must be 16 to 16777216, is 0")));
}

TEST(Refusals, AProtocolTheDriveDoesNotHaveIsAMistakeOfTheConfiguration) {
  ResolveInput input = kinco_axis();
  input.protocol = "keya-can";
  EXPECT_THAT(
      refused(shipped("kinco-md"), input),
      ElementsAre(says("/profile",
                       "profile \"kinco-md\" has no protocol \"keya-can\": it has canopen, kinco-serial, modbus-rtu")));
}

TEST(Refusals, MoreAxesThanTheDriveHasAreRefused) {
  ResolveInput input = kinco_axis();
  input.axes.emplace_back();
  EXPECT_THAT(refused(shipped("kinco-jd"), input),
              ElementsAre(says("/axes", "is a drive of 1 axes, 2 are configured")));
}

TEST(Refusals, AHomingMethodTheDriveDoesNotHaveIsRefused) {
  ResolveInput input = kinco_axis();
  input.axes[0].homing_method = static_cast<std::int16_t>(15);
  EXPECT_THAT(refused(shipped("kinco-jd"), input),
              ElementsAre(says("/axes/0/homing_method", "this drive has no homing method 15")));
}

TEST(Refusals, AProfileWithMistakesIsNotResolved) {
  const LoadedProfile loaded = load_profile(AXISGATE_SOURCE_DIR "/tests/profiles/invalid/unknown-object.json");
  const auto result = resolve(loaded, one_axis());
  EXPECT_TRUE(std::holds_alternative<std::vector<Fault>>(result));
}

TEST(Refusals, UnitsBeyondSixtyFourBitsAreAFaultAndNoCrash) {
  ResolveInput input = kinco_axis();
  input.constants["encoder_counts_per_rev"] = Rational(16777213);
  input.axes[0].units_per_rev = Rational(1, 1000000000039);
  const std::vector<Fault> faults = refused(shipped("kinco-jd"), input);
  ASSERT_FALSE(faults.empty());
  EXPECT_THAT(faults[0].message, HasSubstr("more than 64 bits"));
}

}  // namespace
}  // namespace axisgate::drive
