// SPDX-License-Identifier: Apache-2.0
// What cannot be resolved is refused by name, pointing into the drive's entry of the configuration.
#include <gmock/gmock.h>

#include <functional>

#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

struct Refusal {
  std::string what;
  std::string profile;
  std::function<void(ResolveInput&)> with;  ///< what is changed in an axis that the drive has
  std::string pointer, words;
};

const std::vector<Refusal> kRefusals{
    {"a required constant that is missing", valid_file("required-constant"),
     [](ResolveInput& input) { input.constants.clear(); }, "/constants/counts",
     "\"counts\" is required for profile \"required-constant\": counts of the encoder: 2500 or 10000"},
    {"an unknown constant", shipped("kinco-jd"),
     [](ResolveInput& input) { input.constants["encoder_count_per_rev"] = Rational(65536); },
     "/constants/encoder_count_per_rev", "did you mean \"encoder_counts_per_rev\"?"},
    {"a constant outside its range", shipped("kinco-jd"),
     [](ResolveInput& input) { input.constants["encoder_counts_per_rev"] = Rational(0); },
     "/constants/encoder_counts_per_rev", "must be 16 to 16777216, is 0"},
    {"a protocol that the drive does not have", shipped("kinco-md"),
     [](ResolveInput& input) { input.protocol = "keya-can"; }, "/profile",
     "profile \"kinco-md\" has no protocol \"keya-can\": it has canopen, kinco-serial, modbus-rtu"},
    {"more axes than the drive has", shipped("kinco-jd"), [](ResolveInput& input) { input.axes.emplace_back(); },
     "/axes", "is a drive of 1 axes, 2 are configured"},
    {"a homing method that the drive does not have", shipped("kinco-jd"),
     [](ResolveInput& input) { input.axes[0].homing_method = static_cast<std::int16_t>(15); }, "/axes/0/homing_method",
     "this drive has no homing method 15"},
    {"a limit in a unit that the drive cannot have yet", shipped("kinco-jd"),
     [](ResolveInput& input) { input.axes[0].limits.torque = 500; }, "/axes/0/limits/torque",
     "limits nothing: this drive's unit of it needs rated_current_a: add it to the drive's \"constants\", or take the "
     "limit out"},
    {"the same, with two constants missing", shipped("kinco-md"),
     [](ResolveInput& input) {
       input.axes[0].limits.torque = 500;
       input.constants.clear();
     },
     "/axes/0/limits/torque", "needs rated_current_a and peak_current_a: add them to"},
};

TEST(Refusals, NameThePlaceInTheConfigurationAndWhatIsWrong) {
  for (const Refusal& it : kRefusals) {
    SCOPED_TRACE(it.what);
    ResolveInput input = kinco_axis();
    it.with(input);
    EXPECT_THAT(refused(it.profile, input),
                ElementsAre(AllOf(Field(&Fault::pointer, it.pointer), Field(&Fault::message, HasSubstr(it.words)))));
  }
}

TEST(Refusals, AKincoWithoutItsPeakCurrentHasNoCurrentsAndNoTorque) {
  for (const std::string name : {"kinco-jd", "kinco-md"}) {
    const model::DriveModel model = resolved(shipped(name), one_axis());
    EXPECT_EQ(model.axes.at(0).binding(Quantity::current_actual), nullptr) << name;
    EXPECT_EQ(model.axes.at(0).binding(Quantity::torque_actual), nullptr) << name;
    EXPECT_NE(model.axes.at(0).binding(Quantity::position_actual), nullptr) << name;
  }
}

TEST(Refusals, AProfileWithMistakesIsNotResolved) {
  LoadedProfile loaded = load_profile(valid_file("minimal"));
  ASSERT_TRUE(std::holds_alternative<model::DriveModel>(resolve(loaded, one_axis())));
  loaded.faults.push_back({loaded.file, "/title", "is wrong"});
  EXPECT_TRUE(std::holds_alternative<std::vector<Fault>>(resolve(loaded, one_axis())));
}

TEST(Refusals, AMotorThatIsEnabledWithAnotherNeedsItsAxisToo) {
  const std::vector<Fault> faults = refused(valid_file("shared-pair"), one_axis("canopen"));
  ASSERT_EQ(faults.size(), 1U) << text(faults);
  EXPECT_EQ(faults[0].pointer, "/axes");
  EXPECT_THAT(faults[0].message, HasSubstr("motor B is enabled and stopped with the others"));
}

TEST(Refusals, AxesWithOneOwnerHaveOneLease) {
  ResolveInput input = one_axis("canopen");
  input.axes.push_back(input.axes.front());
  EXPECT_EQ(resolved(valid_file("shared-pair"), input).axes[0].shares, std::vector<AxisSlot>{1});
  input.axes[1].lease.timeout = std::chrono::seconds(9);
  const std::vector<Fault> faults = refused(valid_file("shared-pair"), input);
  ASSERT_EQ(faults.size(), 1U) << text(faults);
  EXPECT_EQ(faults[0].pointer, "/axes/1/lease");
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
}  // namespace axisgate::profile
