// SPDX-License-Identifier: Apache-2.0
// The shipped Leadshine LD2-CAN profile against the manual: objects, conversions, alarms, and what it does about the
// drive's own traps.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "gateway/image/axis_image.hpp"
#include "gateway/model/loss.hpp"
#include "gateway/model/scale.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

json ld2_vectors(const std::string& part) { return manual("leadshine-ld2-can").at(part); }

model::DriveModel leadshine(ResolveInput input = one_axis("canopen")) {
  return resolved(shipped("leadshine-ld2-can"), input);
}

/// As the drive layer has it once the drive told how it counts: so many units a turn.
model::DriveModel leadshine_of(std::int64_t units_per_turn) {
  ResolveInput input = one_axis("canopen");
  input.constants["units_per_motor_rev"] = Rational(units_per_turn);
  return leadshine(input);
}

using Held = std::map<std::string, std::int64_t>;

Held factory() {
  return {{"pulses_per_rev_override", 0}, {"feed_constant", 10000}, {"encoder_increments", 131072},
          {"gear_numerator", 1},          {"gear_denominator", 1},  {"profile_acceleration", 10000},
          {"profile_deceleration", 10000}};
}

/// What bring-up writes to a drive that holds these numbers, by name.
Held written(const model::DriveModel& model, const Held& held) {
  Held out;
  const auto number_of = [&](model::ObjectId id) -> std::optional<std::int64_t> {
    const auto at = held.find(model.object(id).name);
    return at == held.end() ? std::nullopt : std::optional(at->second);
  };
  for (const model::ObjectWrite& write : model::setup_writes(model, number_of))
    out[model.object(write.object).name] = write.raw;
  return out;
}

TEST(Leadshine, EveryObjectIsWhereAndAsTheManualSays) {
  const LoadedProfile loaded = load_profile(shipped("leadshine-ld2-can"));
  std::map<std::pair<std::int64_t, std::int64_t>, json> rows;
  std::set<std::int64_t> named;  // without any sub-index
  const json objects = ld2_vectors("objects");
  for (const json& row : objects) {
    if (row["sub"].is_null())
      named.insert(hex(row["index"]));
    else
      rows[{hex(row["index"]), row["sub"].get<std::int64_t>()}] = row;
  }
  EXPECT_GE(loaded.profile.objects.size(), 40U);
  for (const Object& object : loaded.profile.objects) {
    SCOPED_TRACE(object.name);
    const auto place = object.places.find("canopen");
    ASSERT_NE(place, object.places.end());
    const ObjectAddress address = place->second.address;
    const auto row = rows.find({address.index, address.sub});
    if (row == rows.end()) {
      EXPECT_TRUE(named.contains(address.index)) << "is at an address that the manual does not have";
      continue;
    }
    EXPECT_EQ(object.any_width, row->second["bits"].is_null()) << "a width nobody printed must not be insisted on";
    check_row(object, row->second);
  }
}

TEST(Leadshine, NothingIsMappedThatIsPrintedAsNotMappable) {
  const model::DriveModel model = leadshine();
  std::map<std::pair<std::int64_t, std::int64_t>, std::string> pdo;
  const json objects = ld2_vectors("objects");
  for (const json& row : objects)
    if (row["pdo"].is_string() && row["sub"].is_number())
      pdo[{hex(row["index"]), row["sub"].get<std::int64_t>()}] = row["pdo"].get<std::string>();
  ASSERT_THAT(model.canopen.tpdos, SizeIs(4));
  for (const model::TpdoProperties& tpdo : model.canopen.tpdos) {
    EXPECT_EQ(tpdo.type, 255) << "254 is not supported";
    EXPECT_GT(tpdo.inhibit.value_or(0), 0) << "with type 255 an inhibit time must be set";
    EXPECT_EQ(tpdo.event_ms, std::nullopt) << "an event timer is not mentioned";
    for (const model::ObjectId id : tpdo.map) {
      const ObjectAddress address = model.object(id).address;
      const auto said = pdo.find({address.index, address.sub});
      // Of what 3 and 4 carry nothing is printed, or RPDO: the drive is asked, and may refuse.
      EXPECT_TRUE(tpdo.number >= 3 || (said != pdo.end() && said->second == "TPDO")) << model.object(id).name;
    }
  }
  EXPECT_THAT(model.canopen.unused_tpdos, testing::IsEmpty()) << "no default is printed: none is left as it is";
}

TEST(Leadshine, ConversionsOfTheManualComeOutToTheDigit) {
  const model::DriveModel model = leadshine_of(10000);
  EXPECT_EQ(sent(model, Quantity::profile_velocity, 1500000), 250000);
  EXPECT_EQ(sent(model, Quantity::homing_speed_switch, 180000), 30000);
  EXPECT_EQ(sent(model, Quantity::homing_speed_zero, 120000), 20000);
  EXPECT_EQ(sent(model, Quantity::profile_acceleration, 15000), 250000);
  EXPECT_EQ(sent(model, Quantity::homing_acceleration, 1800), 30000);
  EXPECT_EQ(sent(model, Quantity::target_position, 20000), 20000);
  EXPECT_EQ(sent(model, Quantity::target_torque, 100), 100);
  EXPECT_EQ(sent(model, Quantity::max_velocity, 1000000), 1000);
  EXPECT_EQ(binding(model, Quantity::dc_voltage).to_register(48000), 480);
}

TEST(Leadshine, UnitsPerTurnFollowTheThreeObjectsThatCompeteForThem) {
  const model::DriveModel model = leadshine();
  ASSERT_THAT(model.constants, SizeIs(1));
  const auto counts = [&](std::int64_t override_, std::int64_t feed, std::int64_t encoder, std::int64_t numerator,
                          std::int64_t denominator) {
    const Held held{{"pulses_per_rev_override", override_},
                    {"feed_constant", feed},
                    {"encoder_increments", encoder},
                    {"gear_numerator", numerator},
                    {"gear_denominator", denominator}};
    return model::evaluate(model.constants[0],
                           [&](model::ObjectId id) { return std::optional(held.at(model.object(id).name)); })
        .value;
  };
  EXPECT_EQ(counts(0, 10000, 131072, 3, 7), Rational(10000)) << "6091h has no effect";
  EXPECT_EQ(counts(4000, 10000, 131072, 3, 7), Rational(4000)) << "Pr0.08 outranks 6092h";
  EXPECT_EQ(counts(0, 10000, 10000, 2, 1), Rational(5000)) << "6092h = 608Fh: the gear counts";
}

TEST(Leadshine, FactoryRampsAreReplacedByTheSameRampInAnyGear) {
  const model::DriveModel model = leadshine();
  // 600 rpm/s = 10 turns/s2.
  EXPECT_EQ(written(model, factory()).at("profile_deceleration"), 100000);
  EXPECT_EQ(written(model, factory()).at("profile_acceleration"), 100000);
  Held geared = factory();
  geared["feed_constant"] = 131072;
  geared["gear_denominator"] = 2;
  EXPECT_EQ(written(model, geared).at("profile_deceleration"), 2621440);
}

TEST(Leadshine, ARampThatSomebodyHasSetStays) {
  Held set = factory();
  set["profile_deceleration"] = 5000;
  const Held after = written(leadshine(), set);
  EXPECT_FALSE(after.contains("profile_deceleration")) << "slower than the factory's, but somebody's will";
  EXPECT_TRUE(after.contains("profile_acceleration"));
}

TEST(Leadshine, NoRampIsWrittenBeforeTheDriveHasToldHowItCounts) {
  Held unknown = factory();
  unknown.erase("feed_constant");
  EXPECT_FALSE(written(leadshine(), unknown).contains("profile_deceleration"));
  unknown = factory();
  unknown.erase("profile_deceleration");
  EXPECT_FALSE(written(leadshine(), unknown).contains("profile_deceleration")) << "what it holds is not known";
}

TEST(Leadshine, ARampThatDoesNotFitIsNotWritten) {
  ResolveInput input = one_axis("canopen");
  input.constants["ramp_rpm_per_s"] = Rational(1000000);
  input.constants["units_per_motor_rev"] = Rational(1000000000);
  EXPECT_FALSE(written(leadshine(input), factory()).contains("profile_deceleration"));
}

TEST(Leadshine, WatchesTheGatewayAndIsWatched) {
  const model::DriveModel model = leadshine();
  EXPECT_TRUE(model.stops_by_itself);
  EXPECT_EQ(model.canopen.heartbeat, std::chrono::milliseconds(1000));
  EXPECT_EQ(model.canopen.own_heartbeat, std::chrono::milliseconds(500));
  ASSERT_THAT(model.loss_objects, SizeIs(1));
  EXPECT_EQ(model::loss_stop_ms(model, true), 1500);
  EXPECT_EQ(model::loss_stop_ms(model, false), kGoesOn) << "it does not hold 1016h";
  EXPECT_EQ(model::loss_stop_ms(model, {}), kLossNotKnown) << "nobody has looked yet";
  EXPECT_EQ(model.object(model.loss_objects[0]).address, (ObjectAddress{0x1016, 1}));
  const Held after = written(model, {});
  EXPECT_EQ(after.at("consumer_heartbeat"), 0x007F05DC) << "node 127, 1500 ms";
  EXPECT_EQ(after.at("producer_heartbeat"), 1000);
}

TEST(Leadshine, AStartDoesNotWaitForABitThatIsNotValid) {
  const model::DriveModel model = leadshine();
  const model::AxisModel& axis = model.axes.at(0);
  EXPECT_FALSE(axis.cia402.setpoint_acknowledge);
  const auto& move = axis.command(Command::move_absolute);
  ASSERT_TRUE(move.has_value());
  std::vector<std::int64_t> words;
  for (const model::Step& step : move->steps) {
    if (step.verb == model::Step::Verb::write) words.push_back(step.literal);
    if (step.verb != model::Step::Verb::wait) continue;
    EXPECT_EQ(model.object(step.object).address, (ObjectAddress{0x3001, 0}));
    EXPECT_TRUE(step.optional) << "a drive without 3001h is only slower";
  }
  EXPECT_THAT(words, ElementsAre(0x0F, 0x2F, 0x3F));
}

TEST(Leadshine, EveryAlarmOfTheManualHasItsRow) {
  const model::DriveModel model = leadshine();
  std::set<std::uint32_t> rows;
  std::set<std::uint32_t> told;
  for (const model::AlarmRow& row : model.alarms) rows.insert(row.value.value_or(0));
  const json alarms = ld2_vectors("alarms");
  EXPECT_GE(alarms.size(), 100U);
  for (const json& alarm : alarms)
    if (!alarm["error_code"].is_null()) told.insert(static_cast<std::uint32_t>(hex(alarm["error_code"])));
  EXPECT_EQ(rows, told) << "a warning that is not stored has no code";
}

TEST(Leadshine, HasEveryCommandAndNoMoreModesThanTheManualDescribes) {
  const model::DriveModel model = leadshine();
  for (const Command command :
       {Command::enable, Command::disable, Command::quick_stop, Command::halt, Command::fault_reset,
        Command::move_absolute, Command::move_relative, Command::run_velocity, Command::run_torque, Command::home,
        Command::set_position, Command::save_parameters})
    EXPECT_TRUE(model.axes.at(0).command(command).has_value()) << axisgate::text(command);
  std::vector<std::int16_t> modes;
  for (const auto& [mode, raw] : model.axes.at(0).modes) modes.push_back(mode);
  EXPECT_THAT(modes, ElementsAre(1, 3, 4, 6));
}

}  // namespace
}  // namespace axisgate::profile
