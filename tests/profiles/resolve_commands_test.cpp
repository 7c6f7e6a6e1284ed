// SPDX-License-Identifier: Apache-2.0
// Commands, modes, homing, checks and facts of the resolved Kinco models.
#include <algorithm>

#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

/// "controlword=6 wait(statusword&111==33,500?) controlword=15 ..."
std::string written(const model::DriveModel& model, const model::Steps& steps) {
  std::string out;
  for (const model::Step& step : steps) {
    if (!out.empty()) out += ' ';
    const std::string& name = model.object(step.object).name;
    if (step.verb == model::Step::Verb::write) {
      out += name + "=" + std::to_string(step.literal);
      continue;
    }
    out += "wait(" + name + "&" + std::to_string(step.until.mask) +
           (step.until.test == model::Condition::Test::equals ? "==" : "!=") + std::to_string(step.until.values.at(0)) +
           "," + std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(step.limit).count()) +
           (step.optional ? "?)" : ")");
  }
  return out;
}

std::string steps(const model::DriveModel& model, Command command) {
  const auto& def = model.axes.at(0).command(command);
  return def ? written(model, def->steps) : "unsupported";
}

struct Commanded {
  std::string drive;
  Command command{};
  std::string steps;
};

const std::vector<Commanded> kCommanded{
    // Through "ready to switch on" to "operation enabled".
    {"kinco-jd", Command::enable,
     "controlword=6 wait(statusword&111==33,500?) controlword=15 wait(statusword&111==39,2000)"},
    {"kinco-jd", Command::disable, "controlword=6 wait(statusword&4==0,5000)"},
    {"kinco-jd", Command::quick_stop, "controlword=11 wait(statusword&36!=36,5000)"},
    // A rising edge, and disabled at its end.
    {"kinco-jd", Command::fault_reset, "controlword=6 controlword=128 wait(statusword&8==0,2000) controlword=6"},
    {"kinco-md", Command::fault_reset, "controlword=6 controlword=134 wait(statusword&8==0,2000) controlword=6"},
    // On the rise of bit 4, acknowledged by bit 12.
    {"kinco-md", Command::move_absolute,
     "controlword=47 wait(statusword&4096==0,200?) controlword=63 wait(statusword&4096==4096,500)"},
    {"kinco-md", Command::move_relative,
     "controlword=79 wait(statusword&4096==0,200?) controlword=95 wait(statusword&4096==4096,500)"},
    {"kinco-jd", Command::home, "controlword=15 controlword=31 wait(statusword&32768==0,200?)"},
    {"kinco-jd", Command::save_parameters, "save=1 wait(save&0!=1,2000?)"},
};

TEST(KincoCommands, TakeTheStepsOfTheManuals) {
  for (const Commanded& it : kCommanded)
    EXPECT_EQ(steps(resolved(shipped(it.drive), kinco_axis()), it.command), it.steps) << it.drive;
}

TEST(KincoCommands, AcknowledgingSavingAndSetPosition) {
  EXPECT_TRUE(resolved(shipped("kinco-md"), kinco_axis()).axes[0].cia402.setpoint_acknowledge);
  const model::DriveModel model = resolved(shipped("kinco-jd"), kinco_axis());
  const auto& set_position = model.axes[0].command(Command::set_position);
  ASSERT_TRUE(set_position);
  EXPECT_TRUE(set_position->zero_only);
  const model::ObjectDef& save = model.object(model.find({0x2FF0, 1}));
  EXPECT_TRUE(save.trigger);
  EXPECT_EQ(save.nvm, model::Nvm::yes);
}

TEST(KincoCommands, AWaitThatRunsOutIsNotReached) {
  const model::DriveModel model = resolved(shipped("kinco-jd"), kinco_axis());
  EXPECT_EQ(model.axes[0].command(Command::enable)->steps.back().otherwise, Errc::not_reached);
}

TEST(KincoCommands, TheJdHaltsByItsTargetVelocityAndElsewhereByQuickStop) {
  const model::DriveModel model = resolved(shipped("kinco-jd"), kinco_axis());
  const auto& halt = model.axes[0].command(Command::halt);
  ASSERT_TRUE(halt);
  EXPECT_TRUE(halt->quick_stop_otherwise);
  EXPECT_TRUE(halt->steps.empty());
  ASSERT_EQ(halt->variants.size(), 1U);
  EXPECT_EQ(halt->variants[0].modes, (std::vector<std::int16_t>{3, -3}));
  EXPECT_EQ(written(model, halt->variants[0].steps), "target_velocity=0");
}

TEST(KincoCommands, TheMdHaltsByBitEightButNotInTorqueMode) {
  const model::DriveModel model = resolved(shipped("kinco-md"), kinco_axis());
  const auto& halt = model.axes[0].command(Command::halt);
  ASSERT_TRUE(halt);
  ASSERT_EQ(halt->variants.size(), 1U);
  EXPECT_EQ(written(model, halt->variants[0].steps), "controlword=271");
  EXPECT_EQ(std::count(halt->variants[0].modes.begin(), halt->variants[0].modes.end(), 4), 0);
  EXPECT_TRUE(halt->quick_stop_otherwise);
}

TEST(KincoModel, RolesAreTheObjectsOfTheirQuantities) {
  const model::DriveModel jd = resolved(shipped("kinco-jd"), kinco_axis());
  EXPECT_EQ(jd.find({0x6041, 0}), jd.axes[0].statusword);
  EXPECT_EQ(jd.find({0x6040, 0}), jd.axes[0].controlword);
  EXPECT_EQ(jd.find({0x6061, 0}), jd.axes[0].mode_display);
  EXPECT_TRUE(jd.axes[0].cia402.mode_display);
  EXPECT_EQ(jd.find({0x2602, 0}), jd.axes[0].fault_words[1]);
  const model::DriveModel md = resolved(shipped("kinco-md"), kinco_axis());
  EXPECT_EQ(md.axes[0].mode_display, md.axes[0].mode) << "the MD has no display: its mode is read back";
  EXPECT_FALSE(md.axes[0].cia402.mode_display);
}

TEST(KincoModel, ChecksNameTheInputsThatKeepTheBusFromControl) {
  const model::DriveModel model = resolved(shipped("kinco-jd"), kinco_axis());
  const auto blocking = [&](const std::string& name) {
    return *std::find_if(model.checks.begin(), model.checks.end(),
                         [&](const model::Check& check) { return check.name == name; });
  };
  const model::Check din1 = blocking("din1_local_control");
  EXPECT_EQ(din1.alarm, AxisAlarm::local_control);
  EXPECT_EQ(model.object(din1.bad.object).address, (ObjectAddress{0x2010, 3}));
  ASSERT_EQ(din1.remedy.size(), 2U);
  EXPECT_EQ(din1.remedy[0].raw, 0);
  EXPECT_EQ(model.object(din1.remedy[1].object).address, (ObjectAddress{0x2FF0, 1}));
  EXPECT_EQ(model.object(blocking("din8_local_control").bad.object).address, (ObjectAddress{0x2010, 0x1D}));
  EXPECT_EQ(blocking("limit_inputs_open").alarm, AxisAlarm::limit_inputs_open);
}

TEST(Checks, HalfARemedyIsNone) {
  nlohmann::json profile = nlohmann::json::parse(test::content(valid_file("minimal")));
  profile["checks"][0].update({{"object", "statusword"}, {"remedy", nlohmann::json::array()}});
  profile["objects"]["din2"] = profile["objects"]["din1"];
  profile["objects"]["din2"]["at"] = {{"kinco-serial", "2010.04"}, {"modbus-rtu", "0x3900"}};
  for (const char* object : {"din2", "din1"})
    profile["checks"][0]["remedy"].push_back({{"write", object}, {"value", 0}});
  const test::OwnFolder folder;
  const LoadedProfile loaded = load_profile(folder.write("minimal.json", profile.dump()).string());
  EXPECT_EQ(resolved(loaded, one_axis()).checks.at(0).remedy.size(), 2U);
  EXPECT_EQ(resolved(loaded, one_axis("modbus-rtu")).checks.at(0).remedy.size(), 0U) << "din1 has no register";
}

TEST(KincoModel, HomingMethodsAndTheirEnd) {
  ResolveInput input = kinco_axis();
  input.axes[0].homing_method = static_cast<std::int16_t>(-17);
  const model::DriveModel model = resolved(shipped("kinco-jd"), input);
  const model::AxisModel& axis = model.axes[0];
  EXPECT_EQ(axis.homing_methods.size(), 33U);
  EXPECT_EQ(axis.homing_method, -17);
  ASSERT_TRUE(axis.homed && axis.homing_failed);
  EXPECT_TRUE(axis.homed->holds(model.object(axis.homed->object), 0xC037));
  EXPECT_FALSE(axis.homed->holds(model.object(axis.homed->object), 0x4037));
  EXPECT_TRUE(axis.homing_failed->holds(model.object(axis.homing_failed->object), 0x2037));
}

}  // namespace
}  // namespace axisgate::profile
