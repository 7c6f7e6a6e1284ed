// SPDX-License-Identifier: Apache-2.0
// A profile that extends another one: which file is taken, what is merged how, and where a mistake is told.
#include <gmock/gmock.h>

#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;

const std::string kValid = test::source_path("tests/profiles/valid");

class Layers : public ::testing::Test {
 protected:
  std::string write(const std::string& file, const json& profile) const {
    fs::create_directories((folder() / file).parent_path());
    return folder_.write(file, profile.dump()).string();
  }
  /// Extends `base` and says nothing else but its name.
  std::string derive(const std::string& file, const std::string& base) const {
    return write(file, {{"profile", 1}, {"name", fs::path(file).stem().string()}, {"extends", base}});
  }
  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }
  /// "FILE: /pointer: message", without the folder's name.
  [[nodiscard]] std::string told(const LoadedProfile& loaded) const {
    std::vector<Fault> faults = loaded.faults;
    for (Fault& fault : faults) fault.place = {};
    std::string out = text(faults);
    for (std::size_t at = out.find(folder().string()); at != std::string::npos; at = out.find(folder().string()))
      out.erase(at, folder().string().size() + 1);
    return out;
  }

  static json minimal() { return json::parse(test::content(kValid + "/minimal.json")); }

 private:
  test::OwnFolder folder_;
};

TEST_F(Layers, ABaseBesideTheFileComesBeforeOneInTheFolders) {
  json own = minimal();
  own["title"] = "The one beside it";
  const std::string base = write("minimal.json", own);
  const std::string file = derive("mine.json", "minimal");
  const LoadedProfile loaded = load_profile(file, {kValid});
  EXPECT_EQ(told(loaded), "");
  EXPECT_EQ(loaded.profile.title, "The one beside it");
  EXPECT_THAT(loaded.files, ElementsAre(file, base));
}

TEST_F(Layers, ABaseIsSearchedForInTheFoldersInTheirOrder) {
  const std::string file = derive("mine.json", "minimal");
  const LoadedProfile loaded = load_profile(file, {"/nowhere", kValid});
  EXPECT_EQ(told(loaded), "");
  EXPECT_EQ(loaded.profile.name, "mine");
  EXPECT_THAT(loaded.files, ElementsAre(file, kValid + "/minimal.json"));
  EXPECT_EQ(told(load_profile(file, {"/nowhere"})),
            "mine.json: /extends: there is no other minimal.json beside this file or in /nowhere\n");
  EXPECT_EQ(told(load_profile(file)), "mine.json: /extends: there is no other minimal.json beside this file\n");
}

TEST_F(Layers, AProfileMayExtendAnotherOneOfItsOwnName) {
  const std::string file = derive("minimal.json", "minimal");
  EXPECT_EQ(told(load_profile(file)), "minimal.json: /extends: there is no other minimal.json beside this file\n");
  const LoadedProfile loaded = load_profile(file, {folder().string(), kValid});
  EXPECT_EQ(told(loaded), "");
  EXPECT_THAT(loaded.files, ElementsAre(file, kValid + "/minimal.json"));
}

TEST_F(Layers, AProfileThatExtendsItselfByOthersIsRefused) {
  const std::string file = derive("a.json", "b");
  derive("b.json", "c");
  derive("c.json", "a");
  EXPECT_EQ(
      told(load_profile(file)),
      "c.json: /extends: \"a\" extends this profile itself, directly or by others: one of them must stand alone\n");
}

TEST_F(Layers, FourBasesMayStandBehindOneAnother) {
  write("minimal.json", minimal());
  derive("d.json", "minimal");
  derive("c.json", "d");
  derive("b.json", "c");
  const std::string four = derive("a.json", "b");
  EXPECT_EQ(told(load_profile(four)), "");
  EXPECT_EQ(load_profile(four).files.size(), 5U);
  EXPECT_EQ(told(load_profile(derive("z.json", "a"))),
            "d.json: /extends: \"minimal\" would be base number 5, and at most 4 may stand behind one another\n");
}

TEST_F(Layers, ABaseThatIsNoJsonIsToldWithItsFileAndLine) {
  std::ofstream(folder() / "minimal.json") << "{\n  \"profile\": 1,\n}\n";
  const LoadedProfile loaded = load_profile(derive("mine.json", "minimal"));
  ASSERT_EQ(loaded.faults.size(), 1U);
  EXPECT_EQ(loaded.faults[0].file, folder() / "minimal.json");
  EXPECT_EQ(loaded.faults[0].place, (JsonPlace{2, 15}));
  write("minimal.json", json::array({1}));
  EXPECT_EQ(told(load_profile(folder() / "mine.json")), "minimal.json: must be object, is array\n");
}

TEST_F(Layers, ABaseThatIsNoDriveIsOnlyExtended) {
  json base = minimal();
  base["name"] = "base";
  base["base_only"] = true;
  base.erase("quantities");
  const LoadedProfile alone = load_profile(write("base.json", base));
  EXPECT_TRUE(alone.base_only);
  EXPECT_EQ(told(alone), "base.json: /base_only: is no drive but a base: name or check a profile that extends it\n");
  const std::string mine = write(
      "mine.json", {{"profile", 1}, {"name", "mine"}, {"extends", "base"}, {"quantities", minimal()["quantities"]}});
  const LoadedProfile loaded = load_profile(mine);
  EXPECT_EQ(told(loaded), "");
  EXPECT_FALSE(loaded.base_only);
}

// 3.4: "Where a drive has no halt, the profile names the replacement, else quick_stop": buttons end a jog by it.
TEST_F(Layers, WithoutAHaltQuickStopTakesItsPlace) {
  json own = minimal();
  own["commands"].erase("halt");
  const model::DriveModel model = resolved(load_profile(write("minimal.json", own)), one_axis());
  ASSERT_EQ(model.axes.size(), 1U);
  EXPECT_NE(model.axes[0].supported_commands & 1U << static_cast<unsigned>(Command::halt), 0U);
  ASSERT_TRUE(model.axes[0].command(Command::halt));
  EXPECT_TRUE(model.axes[0].command(Command::halt)->quick_stop_otherwise);
}

TEST_F(Layers, AChangeOfTheBaseIsAChangeOfTheProfile) {
  write("minimal.json", minimal());
  const std::string file = derive("mine.json", "minimal");
  const std::string before = load_profile(file).text;
  EXPECT_EQ(load_profile(file).text, before);
  json base = minimal();
  base["objects"]["velocity"]["range"] = {-100, 100};
  write("minimal.json", base);
  EXPECT_NE(load_profile(file).text, before);
}

TEST_F(Layers, ObjectsAreMergedListsReplacedAndNullTakesOut) {
  const LoadedProfile loaded = load_profile(kValid + "/derived.json");
  EXPECT_EQ(text(loaded.faults), "");
  const Profile& profile = loaded.profile;
  EXPECT_EQ(profile.find("din1", 0), nullptr);
  const Object* velocity = profile.find("velocity", 0);
  EXPECT_EQ(velocity->printed, (Range{-20000, 20000}));
  EXPECT_EQ(velocity->unit, "speed") << "the base's";
  EXPECT_TRUE(velocity->writable);
  const QuantitySpec* target = profile.find(Quantity::target_velocity);
  EXPECT_TRUE(target->min.has_value());
  EXPECT_FALSE(target->max.has_value()) << "of a list nothing is merged";
  ASSERT_EQ(profile.alarms.size(), 2U);
  EXPECT_EQ(profile.alarms[0].code, 0x3210);
  EXPECT_EQ(profile.alarms[0].value, 0x3210U);
  EXPECT_EQ(profile.alarms[0].remedy, "ask the maker");
  EXPECT_EQ(profile.alarms[1].text, "too hot");
  EXPECT_EQ(profile.alarms[1].remedy, "let it cool");
}

TEST_F(Layers, NullSaysOfALossThatTheDriveHasNone) {
  json base = minimal();
  base["protocols"]["kinco-serial"]["loss"] = {{"by", "command_watchdog"}, {"after_ms", 1000}};
  write("minimal.json", base);
  const std::string mine = write("mine.json", {{"profile", 1},
                                               {"name", "mine"},
                                               {"extends", "minimal"},
                                               {"protocols", {{"kinco-serial", {{"loss", nullptr}}}}}});
  const LoadedProfile loaded = load_profile(mine);
  EXPECT_EQ(told(loaded), "");
  EXPECT_FALSE(loaded.profile.protocols.find("kinco-serial")->second.stops_by_itself());
}

TEST_F(Layers, ACheckOfEachNameIsOneCheckForEach) {
  const LoadedProfile loaded = load_profile(kValid + "/derived.json");
  std::vector<std::string> told_checks;
  for (const JsonNode& check : loaded.profile.section("checks").elements()) {
    told_checks.push_back(check.text("name") + ": " + check.text("object") + ": " + check.text("text"));
    for (const JsonNode& write : check["remedy"].elements()) EXPECT_EQ(write.text("write"), check.text("object"));
  }
  EXPECT_THAT(told_checks,
              ElementsAre("in1_enables: in1: IN1 enables the drive", "in2_enables: in2: IN2 enables the drive",
                          "overheated: fault_word: too hot for long ramps"));
}

TEST_F(Layers, WhatAllAxesHaveAlikeIsWrittenOnceAndCorrectedForOne) {
  const LoadedProfile loaded = load_profile(kValid + "/each-axis.json");
  EXPECT_EQ(text(loaded.faults), "");
  const Profile& profile = loaded.profile;
  EXPECT_EQ(profile.constants.find("factor_a")->second.standard, Rational(10));
  EXPECT_EQ(profile.constants.find("factor_b")->second.standard, Rational(20));
  EXPECT_EQ(profile.constants.find("factor_b")->second.text, "of motor B");
  EXPECT_EQ(std::get<std::string>(profile.units.find("speed_b")->second.mul.at(0)), "factor_b");
  const Object* a = profile.find("speed", 0);
  const Object* b = profile.find("speed", 1);
  EXPECT_EQ(a->places.find("modbus-rtu")->second.address.index, 30);
  EXPECT_EQ(b->places.find("modbus-rtu")->second.address.index, 31);
  EXPECT_EQ(a->unit, "speed_a");
  EXPECT_EQ(b->unit, "speed_b");
  EXPECT_EQ(a->printed, (Range{INT64_MIN, INT64_MAX})) << "none";
  EXPECT_EQ(b->printed, (Range{-3000, 3000}));
}

TEST_F(Layers, APlaceIsFoundWhereItWasWritten) {
  const LoadedProfile loaded = load_profile(kValid + "/each-axis.json");
  const auto written = [&](const std::string& pointer) {
    const Written found = written_at(loaded.written, pointer);
    return fs::path(found.file).stem().string() + " " + found.pointer;
  };
  EXPECT_EQ(written("/objects/B.speed/at/modbus-rtu"), "each-axis /each_axis/objects/$AXIS.speed/at/modbus-rtu/B");
  EXPECT_EQ(written("/objects/A.speed"), "each-axis /each_axis/objects/$AXIS.speed");
  EXPECT_EQ(written("/objects/B.speed/range/0"), "each-axis /objects/B.speed/range/0");
  EXPECT_EQ(written("/objects/A.position/type"), "virtual-pair /objects/A.position/type");
  EXPECT_EQ(written("/objects/A.position/unit/none"), "virtual-pair /objects/A.position/unit/none");
  EXPECT_EQ(written("/nothing/here"), "each-axis /nothing/here");
  EXPECT_EQ(written(""), "each-axis ");
}

}  // namespace
}  // namespace axisgate::profile
