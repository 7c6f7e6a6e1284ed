// SPDX-License-Identifier: Apache-2.0
// One axis in JSON: values and their age, states in words, faults, and what stands against a motion.
#include <gmock/gmock.h>

#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

AxisSample faulted() {
  AxisSample out = standing(1);
  out.axis_state = static_cast<std::uint8_t>(AxisState::error_stop);
  out.inputs = bits_of({AxisInput::online, AxisInput::fault});
  set(out, Quantity::error_code, 0x3210);
  set(out, Quantity::vendor_error, 0x10);
  return out;
}

TEST(AxisJson, HasValuesInTheUnitsOfTheirNames) {
  Told told;
  AxisSample sample = standing(1);
  set(sample, Quantity::velocity_actual, -123456);
  set(sample, Quantity::torque_actual, 125);
  set(sample, Quantity::current_actual, 123);
  set(sample, Quantity::dc_voltage, 3105);
  set(sample, Quantity::drive_temperature, -5);
  set(sample, Quantity::profile_acceleration, -1);
  told.tell(sample);
  const Json values = told.axis(1)["values"];
  EXPECT_EQ(values["position_rev"], 1.5);
  EXPECT_EQ(values["velocity_rpm"].dump(), "-123.456");
  EXPECT_EQ(values["torque_percent"].dump(), "12.5");
  EXPECT_EQ(values["current_a"].dump(), "1.23");
  EXPECT_EQ(values["dc_voltage_v"].dump(), "310.5");
  EXPECT_EQ(values["drive_temperature_c"].dump(), "-0.5");
  EXPECT_EQ(values["profile_acceleration_rpm_s"], 429496729.5) << "an u32 has no sign";
  EXPECT_EQ(values["mode"].dump(), "3");
  EXPECT_EQ(values.size(), kQuantityCount);
}

TEST(AxisJson, HasNullForWhatIsNotValidAndWhatItWasLastWithItsAge) {
  Told told;
  told.tell(standing(1));
  AxisSample sample = standing(1);
  sample.values.clear();
  sample.valid &= ~bit(Quantity::position_actual);
  told.tell(sample, kSecond);
  const Json axis = told.axis(1, 1500 * kMillisecond);
  EXPECT_TRUE(axis["values"]["position_rev"].is_null());
  EXPECT_EQ(axis["last"].dump(), R"({"position_rev":{"value":1.5,"age_ms":1500}})");
  EXPECT_TRUE(axis["values"]["motor_temperature_c"].is_null()) << "the drive has none";
  EXPECT_EQ(axis["values"]["mode"], 3);
}

TEST(AxisJson, CallsNothingGoodOfAGatewayThatIsNotHeard) {
  Told told;
  told.tell(standing(1));
  const Json axis = told.axis(1, 3 * kSecond);
  EXPECT_EQ(axis["joined"], false);
  EXPECT_TRUE(axis["values"]["position_rev"].is_null());
  EXPECT_EQ(axis["last"]["position_rev"]["age_ms"], 3000);
  EXPECT_EQ(axis["link_state"], "unknown");
  EXPECT_EQ(axis["axis_state"], "unknown");
  EXPECT_TRUE(axis["inputs"].empty());
  EXPECT_THAT(told.blocks(1, 3 * kSecond), ElementsAre("unknown"));
}

TEST(AxisJson, HasNoValueOfAnAxisOfWhichNothingWasTold) {
  Told told;
  const Json axis = told.axis(1);
  EXPECT_TRUE(axis["values"]["position_rev"].is_null());
  EXPECT_TRUE(axis["age_ms"].is_null());
  EXPECT_TRUE(axis["loss_stop_ms"].is_null());
  EXPECT_THAT(told.blocks(1), ElementsAre("unknown"));
}

TEST(AxisJson, GrowsOlder) {
  Told told;
  told.tell(standing(1));
  EXPECT_EQ(told.axis(1, kSecond)["age_ms"], 1012);
}

TEST(AxisJson, SaysStatesInTheWordsOfTop) {
  Told told;
  AxisSample sample = standing(1);
  sample.axis_state = static_cast<std::uint8_t>(AxisState::stopping);
  sample.alarms = bit(AxisAlarm::stop_latched);
  told.tell(sample);
  EXPECT_EQ(told.axis(1)["axis_state"], "latched");
  set(sample, Quantity::velocity_actual, 2000);
  told.tell(sample);
  EXPECT_EQ(told.axis(1)["axis_state"], "stopping");
  EXPECT_EQ(told.axis(1)["mode_text"], "profile velocity");
  EXPECT_EQ(told.axis(1)["inputs"], Json({"online", "enabled"}));
  EXPECT_EQ(told.axis(1)["alarms"][0]["word"], "stop_latched");
}

TEST(AxisJson, HasWhatIsFixedOfTheAxis) {
  Told told;
  told.tell(standing(1));
  const Json axis = told.axis(1);
  EXPECT_EQ(axis["bus"], "serial");
  EXPECT_EQ(axis["supported_modes"], Json({"profile position", "profile velocity"}));
  EXPECT_EQ(axis["commands"], Json({"enable", "disable", "quick_stop", "halt", "fault_reset", "move_absolute"}));
  EXPECT_EQ(axis["limits"].dump(), R"({"target_velocity_rpm":{"min":-3000.0,"max":3000.0}})");
  EXPECT_EQ(axis["rated_speed_rpm"], 3000.0);
  EXPECT_EQ(axis["units_per_rev"], 10000.0);
  EXPECT_EQ(axis["loss_stop_ms"], 500);
}

TEST(AxisJson, SaysWhoseLeaseRunsAndHowTheLastRequestEnded) {
  Told told;
  AxisSample sample = standing(1);
  sample.owner = sample.result_who = "10.0.0.2:5000";
  sample.lease_ms = 1500;
  sample.result = 3;
  sample.result_detail = 0x06010002;
  sample.result_what = "run_velocity";
  sample.result_age_ms = 250;
  told.tell(sample, kSecond);
  const Json axis = told.axis(1, kSecond);
  EXPECT_EQ(axis["owner"], "10.0.0.2:5000");
  EXPECT_EQ(axis["lease_ms"], 1500);
  EXPECT_EQ(axis["last_result"]["result"], "refused by drive");
  EXPECT_THAT(axis["last_result"]["text"].get<std::string>(), HasSubstr("0x06010002"));
  EXPECT_EQ(axis["last_result"]["at"], "2026-11-28T20:40:00.750000Z");
  sample.result_age_ms = 1251;
  told.tell(sample, 2 * kSecond);
  EXPECT_EQ(told.axis(1, 2 * kSecond)["last_result"]["at"], "2026-11-28T20:40:00.750000Z") << "of one result one time";
}

TEST(AxisJson, SaysAFaultWithTheDrivesOwnWordsAndRemedy) {
  Told told;
  told.tell(faulted(), kSecond);
  told.tell(faulted(), 2 * kSecond);
  const Json fault = told.axis(1, 2 * kSecond)["fault"];
  EXPECT_EQ(fault["code"], 0x3210);
  EXPECT_EQ(fault["vendor_code"], 0x10);
  EXPECT_EQ(fault["text"], "the DC bus is too high");
  EXPECT_EQ(fault["remedy"], "a braking resistor");
  EXPECT_EQ(fault["since"], "2026-11-28T20:40:01.000000Z");
  told.tell(standing(1), 3 * kSecond);
  EXPECT_TRUE(told.axis(1, 3 * kSecond)["fault"].is_null());
}

TEST(AxisJson, SaysOfAFaultThatIsBeingReadThatItIs) {
  Told told;
  AxisSample sample = faulted();
  sample.valid &= ~(bit(Quantity::error_code) | bit(Quantity::vendor_error));
  told.tell(sample);
  const Json fault = told.axis(1)["fault"];
  EXPECT_TRUE(fault["code"].is_null());
  EXPECT_THAT(fault["text"].get<std::string>(), HasSubstr("being read"));
}

TEST(BlockedBy, IsEmptyWhereAStartWouldBeAccepted) {
  Told told;
  told.tell(standing(1));
  EXPECT_THAT(told.blocks(1), ElementsAre());
}

TEST(BlockedBy, NamesWhatStandsInTheOrderOfClearing) {
  Told told;
  AxisSample sample = faulted();
  sample.alarms = bit(AxisAlarm::local_control) | bit(AxisAlarm::stop_latched) | bit(AxisAlarm::not_homed);
  sample.owner = "10.0.0.2:5000";
  set(sample, Quantity::mode_display, 1);
  told.tell(sample);
  EXPECT_THAT(told.blocks(1), ElementsAre("error stop", "local_control", "stop_latched", "not owner", "not_homed"));
  EXPECT_EQ(told.axis(1)["blocked_by"][1]["remedy"], "axisgate commission CONFIG 1 shows and changes it");
}

TEST(BlockedBy, NamesTheLinkAlone) {
  Told told;
  AxisSample sample = standing(1);
  sample.alarms = bit(AxisAlarm::stop_latched);
  for (const auto& [state, word] : {std::pair{LinkState::offline, "offline"},
                                    {LinkState::setup, "setup"},
                                    {LinkState::link_down, "link_down"},
                                    {LinkState::unknown, "unknown"}}) {
    sample.link_state = static_cast<std::uint8_t>(state);
    told.tell(sample);
    EXPECT_THAT(told.blocks(1), ElementsAre(word));
  }
}

TEST(BlockedBy, NamesAMissingReferenceWhereThePositionMatters) {
  Told told;
  AxisSample sample = standing(1);
  sample.alarms = bit(AxisAlarm::not_homed);
  told.tell(sample);
  EXPECT_THAT(told.blocks(1), ElementsAre());
  set(sample, Quantity::mode_display, 1);
  told.tell(sample);
  EXPECT_THAT(told.blocks(1), ElementsAre("not_homed"));
}

TEST(BlockedBy, NamesWhatIsNotEnabledLast) {
  Told told;
  AxisSample sample = standing(1);
  sample.axis_state = static_cast<std::uint8_t>(AxisState::disabled);
  told.tell(sample);
  EXPECT_THAT(told.blocks(1), ElementsAre("disabled"));
  EXPECT_THAT(told.axis(1)["blocked_by"][0]["remedy"].get<std::string>(), HasSubstr("enable"));
}

TEST(BlockedBy, NamesNoOwnerOfAnAxisThatMoves) {
  Told told;
  AxisSample sample = standing(1);
  sample.axis_state = static_cast<std::uint8_t>(AxisState::continuous_motion);
  sample.owner = "10.0.0.2:5000";
  told.tell(sample);
  EXPECT_THAT(told.blocks(1), ElementsAre());
}

TEST(BlockedBy, NamesUnitsThatDisagreeBecauseNoStartIsAccepted) {
  Told told;
  AxisSample sample = standing(1);
  sample.alarms = bit(AxisAlarm::units_disagree);
  told.tell(sample);
  EXPECT_THAT(told.blocks(1), ElementsAre("units_disagree"));
}

}  // namespace
}  // namespace axisgate::web
