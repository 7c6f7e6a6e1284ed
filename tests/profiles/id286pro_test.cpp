// SPDX-License-Identifier: Apache-2.0
// The shipped iD286pro profile against the manual's register table, conversions and codes.
#include <map>
#include <regex>
#include <set>

#include "gateway/model/scale.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

json id286pro_vectors(const std::string& part) { return manual("id286pro").at(part); }

model::DriveModel id286pro(std::int64_t pulses_per_rev = 10000) {
  ResolveInput input = one_axis("modbus-rtu");
  input.constants["pulses_per_rev"] = Rational(pulses_per_rev);
  return resolved(shipped("id286pro"), input);
}

/// "1-5000", "-2000000000..2000000000 (misprint)", "0-1 printed; 0-3 described": what is described counts.
std::optional<Range> range_in(const json& text) {
  static const std::regex form(R"((-?[0-9]+)(?:-|\.\.)(-?[0-9]+))");
  if (!text.is_string()) return std::nullopt;
  const std::string said = text;
  std::optional<Range> out;
  for (std::sregex_iterator at(said.begin(), said.end(), form), end; at != end; ++at)
    out = Range{std::stoll((*at)[1]), std::stoll((*at)[2])};
  return out;
}

model::Nvm nvm_of(const json& row) {
  const std::string said = row["eeprom"];
  return said.starts_with("no") ? model::Nvm::no : said == "unknown" ? model::Nvm::unknown : model::Nvm::yes;
}

TEST(Id286pro, EveryRegisterIsWhereAndAsTheManualSays) {
  const LoadedProfile loaded = load_profile(shipped("id286pro"));
  std::map<std::uint16_t, const Object*> by_register;
  for (const Object& object : loaded.profile.objects)
    by_register[object.places.at("modbus-rtu").address.index] = &object;
  const json rows = id286pro_vectors("objects");
  EXPECT_EQ(rows.size(), 49U);
  EXPECT_EQ(by_register.size(), rows.size()) << "no register of its own, and none left out";
  for (const json& row : rows) {
    SCOPED_TRACE(row["name"].get<std::string>());
    const auto at = by_register.find(row["address"].get<std::uint16_t>());
    ASSERT_NE(at, by_register.end());
    const Object& object = *at->second;
    EXPECT_EQ(object.size, 2 * row["words"].get<int>());
    EXPECT_EQ(object.is_signed, row["type"].get<std::string>().starts_with("i"));
    EXPECT_TRUE(object.readable);
    EXPECT_EQ(object.writable, row["access"] == "R/W");
    if (!object.writable) continue;
    EXPECT_EQ(object.printed, range_in(row["range"]).value_or(Range{INT64_MIN, INT64_MAX}));
    EXPECT_EQ(object.nvm, nvm_of(row));
  }
}

TEST(Id286pro, ItsRunsHaveNoHoles) {
  std::set<int> there;
  for (const json& row : id286pro_vectors("objects"))
    for (int word = 0; word < row["words"].get<int>(); ++word) there.insert(row["address"].get<int>() + word);
  const model::DriveModel model = id286pro();
  EXPECT_EQ(model.rtu.runs.size(), 9U);
  for (const auto& [first, last] : model.rtu.runs)
    for (int number = first; number <= last; ++number)
      EXPECT_TRUE(there.contains(number)) << "register " << number << " of the run from " << first << " to " << last;
}

TEST(Id286pro, ConversionsOfTheManualComeOut) {
  const model::DriveModel model = id286pro();
  int checked = 0;
  for (const json& row : id286pro_vectors("conversions")) {
    const std::string engineering = row["engineering"];
    const auto expect = [&](const std::string& named, Quantity quantity, std::int64_t value) {
      if (engineering != named) return;
      const model::Binding& bound = binding(model, quantity);
      const auto raw = row["raw"].get<std::int64_t>();
      EXPECT_EQ(bound.to_raw(value, model.object(bound.object)), raw) << named;
      EXPECT_EQ(bound.to_register(raw), value) << named;
      ++checked;
    };
    for (const Quantity speed : {Quantity::profile_velocity, Quantity::target_velocity, Quantity::velocity_actual}) {
      expect("10 rev/s = 600 rpm", speed, 600000);
      expect("50 rev/s = 3000 rpm", speed, 3000000);
    }
    expect("48 V", Quantity::dc_voltage, 480);
    expect("500 rev/s^2", Quantity::profile_acceleration, 500 * 600);
    expect("500 rev/s^2", Quantity::profile_deceleration, 500 * 600);
    expect("1 turn at 10000 pulses/rev", Quantity::position_actual, 10000);
    expect("1 turn at 10000 pulses/rev", Quantity::target_position, 10000);
  }
  EXPECT_EQ(checked, 11);
}

TEST(Id286pro, ARegisterUnitOfSpeedIsFinerThanTheDrives) {
  const model::DriveModel model = id286pro();
  EXPECT_EQ(sent(model, Quantity::target_velocity, -300000), -500);
  EXPECT_EQ(sent(model, Quantity::target_velocity, 299), 0) << "0.6 rpm are one of the drive's";
  EXPECT_EQ(binding(model, Quantity::target_velocity).limits, (Range{-3000000, 3000000}));
  EXPECT_EQ(binding(model, Quantity::profile_velocity).limits, (Range{600, 3000000})) << "the drive takes no 0";
  EXPECT_EQ(binding(model, Quantity::profile_deceleration).limits, (Range{3000, 6000000}));
}

TEST(Id286pro, WhatItsManualDoesNotSayIsNotSupported) {
  const model::DriveModel model = resolved(shipped("id286pro"), one_axis("modbus-rtu"));
  for (const Quantity q :
       {Quantity::torque_actual, Quantity::current_actual, Quantity::following_error, Quantity::drive_temperature,
        Quantity::digital_inputs, Quantity::digital_outputs, Quantity::target_torque, Quantity::homing_speed_switch,
        Quantity::homing_speed_zero, Quantity::homing_offset, Quantity::max_velocity})
    EXPECT_EQ(model.axes[0].binding(q), nullptr) << row(q).name;
  EXPECT_FALSE(model.axes[0].command(Command::run_torque));
  EXPECT_FALSE(model.axes[0].command(Command::save_parameters));
  EXPECT_NE(model.find({100, 0}), model::kNoObject) << "the motor current can still be looked at";
  EXPECT_EQ(model.axes[0].supported_modes, 0x0025) << "1, 3 and 6";
}

TEST(Id286pro, ItsGateIsTheGatewaysAndAStopLeavesItEnergised) {
  const model::DriveModel model = resolved(shipped("id286pro"), one_axis("modbus-rtu"));
  const auto& facts = model.axes[0].virtual_axis;
  ASSERT_TRUE(facts);
  EXPECT_TRUE(facts->gate_only);
  EXPECT_TRUE(facts->quick_stop_energised);
  EXPECT_EQ(facts->within, 10);
  const model::ObjectDef& state = model.object(facts->enabled.object);
  EXPECT_FALSE(facts->enabled.holds(state, 1));
  EXPECT_TRUE(facts->enabled.holds(state, 2));
  EXPECT_TRUE(facts->enabled.holds(state, 3));
  ASSERT_TRUE(facts->reached && facts->homed_at && model.axes[0].moving);
  EXPECT_TRUE(facts->reached->holds(state, 2));
  EXPECT_TRUE(model.axes[0].moving->holds(state, 3));
  const model::ObjectDef& position = model.object(facts->homed_at->object);
  EXPECT_EQ(position.address, (ObjectAddress{117, 0}));
  EXPECT_TRUE(facts->homed_at->holds(position, 0));
  EXPECT_TRUE(facts->homed_at->holds(position, 0xFFFFFFF6)) << "-10";
  EXPECT_FALSE(facts->homed_at->holds(position, 0xFFFFFFF5));
  EXPECT_FALSE(facts->homed_at->holds(position, 11));
}

/// What a command writes to register 0323, in its order.
std::vector<std::int64_t> commanded(const model::DriveModel& model, Command command) {
  std::vector<std::int64_t> out;
  const auto& def = model.axes.at(0).command(command);
  if (!def) return {-1};
  for (const model::Step& step : def->steps)
    if (step.verb == model::Step::Verb::write && model.object(step.object).address.index == 323)
      out.push_back(step.literal);
  return out;
}

TEST(Id286pro, EachCommandHasItsCodeOfTheManual) {
  const model::DriveModel model = resolved(shipped("id286pro"), one_axis("modbus-rtu"));
  std::map<std::string, std::int64_t> codes;
  for (const json& row : id286pro_vectors("commands"))
    if (row["register_0323"] == true) codes[row["name"]] = row["code"].get<std::int64_t>();
  const auto code = [&](const std::string& name) { return std::vector<std::int64_t>{codes.at(name)}; };
  EXPECT_EQ(commanded(model, Command::move_absolute), code("absolute move"));
  EXPECT_EQ(commanded(model, Command::move_relative), code("relative move"));
  EXPECT_EQ(commanded(model, Command::run_velocity), code("speed mode"));
  EXPECT_EQ(commanded(model, Command::halt), code("decelerated stop"));
  EXPECT_EQ(commanded(model, Command::disable), code("decelerated stop"));
  EXPECT_EQ(commanded(model, Command::quick_stop), code("emergency stop"));
  EXPECT_EQ(commanded(model, Command::set_position), code("set current position"));
  EXPECT_EQ(commanded(model, Command::home), code("start homing"));
  EXPECT_EQ(commanded(model, Command::fault_reset), code("clear alarm"));
  EXPECT_EQ(commanded(model, Command::enable), std::vector<std::int64_t>{}) << "nothing on its bus enables it";
}

TEST(Id286pro, StopsWaitUntilTheDriveStands) {
  const model::DriveModel model = resolved(shipped("id286pro"), one_axis("modbus-rtu"));
  for (const Command command : {Command::halt, Command::disable, Command::quick_stop}) {
    const model::Step& last = model.axes[0].command(command)->steps.back();
    EXPECT_EQ(last.verb, model::Step::Verb::wait) << axisgate::text(command);
    const model::ObjectDef& state = model.object(last.until.object);
    EXPECT_EQ(state.address.index, 109);
    EXPECT_FALSE(last.until.holds(state, 3));
    EXPECT_TRUE(last.until.holds(state, 1)) << "a drive that lost its torque has stopped as well";
  }
}

TEST(Id286pro, HomingMethodsAreTheDrivesOwnFourAndNeedTheirInput) {
  const model::DriveModel model = resolved(shipped("id286pro"), one_axis("modbus-rtu"));
  // Modes 2 and 3 look for a limit (functions 9 and 10), 0 and 1 for the origin (11).
  const std::map<std::int64_t, std::pair<std::int64_t, std::int64_t>> modes{
      {17, {3, 10}}, {18, {2, 9}}, {19, {0, 11}}, {21, {1, 11}}};
  EXPECT_EQ(model.axes[0].homing_methods, (std::vector<std::int16_t>{17, 18, 19, 21}));
  ASSERT_EQ(model.axes[0].homing_needs.size(), 4U);
  for (const model::HomingNeed& need : model.axes[0].homing_needs) {
    SCOPED_TRACE(need.method);
    EXPECT_EQ(sent(model, Quantity::homing_method, need.method), modes.at(need.method).first);
    EXPECT_EQ(need.equals, modes.at(need.method).second);
    ASSERT_EQ(need.any_of.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(model.object(need.any_of[i]).address.index, 400 + i);
  }
  EXPECT_EQ(sent(model, Quantity::homing_method, 20), std::nullopt);
  EXPECT_EQ(binding(model, Quantity::homing_method).to_register(1), 21);
}

TEST(Id286pro, ADriveThatFollowsPulsesIsToldWithItsRemedy) {
  const model::DriveModel model = resolved(shipped("id286pro"), one_axis("modbus-rtu"));
  ASSERT_EQ(model.checks.size(), 1U);
  EXPECT_EQ(model.checks[0].alarm, AxisAlarm::local_control);
  const model::ObjectDef& mode = model.object(model.checks[0].bad.object);
  EXPECT_EQ(mode.address.index, 296);
  EXPECT_TRUE(model.checks[0].bad.holds(mode, 0));
  EXPECT_FALSE(model.checks[0].bad.holds(mode, 1));
  ASSERT_EQ(model.checks[0].remedy.size(), 1U);
  EXPECT_EQ(model.checks[0].remedy[0].raw, 1);
}

TEST(Id286pro, ItsLineIsAsTheManualSays) {
  const model::DriveModel model = resolved(shipped("id286pro"), one_axis("modbus-rtu"));
  EXPECT_TRUE(model.rtu.low_word_first);
  EXPECT_EQ(model.rtu.broadcast, 255);
  EXPECT_EQ(model.rtu.answer, std::chrono::milliseconds(20));
  EXPECT_GE(model.timeout, 2 * model.rtu.answer);
  EXPECT_GE(model.resync.worst_reply, model.timeout);
  EXPECT_TRUE(model.resync.by_length);
  EXPECT_FALSE(model.stops_by_itself);
  EXPECT_EQ(model.nvm, model::Nvm::yes) << "a register that is not in the table is stored as well, so far as is known";
}

}  // namespace
}  // namespace axisgate::profile
