// SPDX-License-Identifier: Apache-2.0
// A profile made of an EDS: whatever the file looks like, the same file does not contradict what was made of it.
#include "gateway/profile/make/from_eds.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "gateway/profile/eds/eds_compare.hpp"
#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/make/node_answers.hpp"
#include "gateway/profile/make/profile_text.hpp"
#include "gateway/profile/read/profile_loader.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kGeneric = "cia402-generic";

Eds eds_of(const std::string& file) {
  return parse_eds(test::content(test::source_path("tests/profiles/eds/" + file)));
}

class ProfileFromEds : public ::testing::Test {
 protected:
  [[nodiscard]] MadeProfile made(const Eds& eds) const {
    return profile_from_eds(eds, *base_.document, {"made", kGeneric, "drive.eds"});
  }
  [[nodiscard]] json document(const Eds& eds) const {
    const MadeProfile out = made(eds);
    EXPECT_THAT(out.faults, IsEmpty());
    return out.faults.empty() ? std::get<json>(parse_json(out.text)) : json::object();
  }
  /// As `axisgate profile check made.json --eds FILE` has it.
  [[nodiscard]] LoadedProfile loaded(const MadeProfile& out) const {
    const std::string path = (folder_.path() / "made.json").string();
    std::ofstream(path) << out.text;
    return load_profile(path, {test::source_path("schemas/drives")});
  }

  LayeredProfile base_ = layered_profile(shipped(kGeneric), {});
  test::OwnFolder folder_;
};

TEST_F(ProfileFromEds, TheSameEdsNeverContradictsIt) {
  for (const char* const file : {"complete.eds", "sparse.eds", "odd.eds", "stubborn.dcf", "kinco-md.eds"}) {
    SCOPED_TRACE(file);
    const Eds eds = eds_of(file);
    const MadeProfile out = made(eds);
    ASSERT_THAT(out.faults, IsEmpty());
    const LoadedProfile profile = loaded(out);
    EXPECT_EQ(text(profile.faults), "") << out.text;
    for (const EdsContradiction& found : contradictions(profile.profile, eds))
      ADD_FAILURE() << found.pointer << " [" << found.section << "] " << found.message;
  }
}

// Amounts are taken as they are; a position and a code are whole numbers, or nothing.
TEST_F(ProfileFromEds, TakesSpeedsThatAreReal32) {
  constexpr EdsType kReal32 = 0x08;
  Eds eds = eds_of("complete.eds");
  for (const int index : {0x606C, 0x6071, 0x6081, 0x6098, 0x60FF})
    eds.objects.at({static_cast<std::uint16_t>(index), 0}).type = kReal32;
  const MadeProfile out = made(eds);
  const LoadedProfile profile = loaded(out);
  EXPECT_EQ(text(profile.faults), "") << out.text;
  EXPECT_THAT(contradictions(profile.profile, eds), IsEmpty());
  const json written = document(eds);
  EXPECT_EQ(written["objects"]["target_velocity"]["type"], "f32");
  EXPECT_EQ(written["objects"]["homing_method"], nullptr);
  EXPECT_THAT(out.notes, Contains("without homing_method (6098h): is REAL32 in the EDS"));
  ResolveInput input = one_axis("canopen");
  input.constants = {{"position_units_per_rev", Rational(10000)},
                     {"speed_units_per_rpm", Rational(1)},
                     {"acceleration_units_per_rpm_per_s", Rational(1)}};
  const model::DriveModel model = resolved(profile, input);
  ASSERT_EQ(model.axes[0].zero_before_enable.size(), 2U) << "what may turn the motor can be made 0";
  for (const model::ObjectId id : model.axes[0].zero_before_enable) EXPECT_TRUE(model.object(id).is_real);
  EXPECT_TRUE(model.axes[0].binding(Quantity::target_velocity)->is_real);
}

TEST_F(ProfileFromEds, NorDoesOneWithAnyObjectMissing) {
  const Eds whole = eds_of("complete.eds");
  for (const auto& [address, object] : whole.objects) {
    if (address.index >= 0x1800 && address.index < 0x6000) continue;  // TPDOs: above
    Eds eds = whole;
    eds.objects.erase(address);
    SCOPED_TRACE(object.section);
    const MadeProfile out = made(eds);
    const bool needed =
        address.sub == 0 && (address.index == 0x6040 || address.index == 0x6041 || address.index == 0x6060);
    EXPECT_EQ(out.faults.empty(), !needed);
    if (needed) continue;
    const LoadedProfile profile = loaded(out);
    EXPECT_EQ(text(profile.faults), "") << out.text;
    EXPECT_THAT(contradictions(profile.profile, eds), IsEmpty());
  }
}

TEST_F(ProfileFromEds, ACompleteDriveIsAFewLines) {
  json out = document(eds_of("complete.eds"));
  EXPECT_EQ(out["name"], "made");
  EXPECT_EQ(out["extends"], kGeneric);
  EXPECT_EQ(out["title"], "Example Motors Complete 402");
  EXPECT_EQ(out["tried"], "simulated");
  EXPECT_EQ(out["identity"],
            json::parse(R"({"vendor": "0x0000BEEF", "product": ["0x00001001"], "revision": ["0x00010000"]})"));
  EXPECT_FALSE(out.contains("quantities")) << out;
  EXPECT_FALSE(out.contains("constants")) << "the drive itself tells how it counts\n" << out;
  EXPECT_EQ(out["objects"]["profile_velocity"], json::parse(R"({"range": [0, 100000]})"));
}

TEST_F(ProfileFromEds, WhatIsMissingIsTakenOutWithAllThatNeedsIt) {
  const MadeProfile made_of_it = made(eds_of("sparse.eds"));
  json out = std::get<json>(parse_json(made_of_it.text));
  for (const char* const object : {"error_code", "homing_method", "max_torque", "profile_deceleration"})
    EXPECT_TRUE(out["objects"].contains(object) && out["objects"][object].is_null()) << object;
  for (const char* const quantity : {"error_code", "homing_method", "following_error"})
    EXPECT_TRUE(out["quantities"].contains(quantity) && out["quantities"][quantity].is_null()) << quantity;
  EXPECT_TRUE(out.contains("homing") && out["homing"].is_null());
  EXPECT_TRUE(out["modes"].contains("6") && out["modes"]["6"].is_null());
  EXPECT_EQ(out["alarms"], json::parse(R"({"words": ["emcy"]})"));
  EXPECT_EQ(out["protocols"]["canopen"]["loss"]["by"], "life_guarding");
  EXPECT_TRUE(out["protocols"]["canopen"]["heartbeat_ms"].is_null()) << "a node sends heartbeats or is guarded";
  EXPECT_THAT(made_of_it.notes, Contains("without homing_method (6098h): not in the EDS"));
  for (const char* const of : {"position_units_per_rev", "speed_units_per_rpm", "acceleration_units_per_rpm_per_s",
                               "/state/quick_stop_ends", "/modes", "/nvm"})
    EXPECT_THAT(made_of_it.questions, Contains(HasSubstr(std::string(of) + ": "))) << of;
}

TEST_F(ProfileFromEds, ATpdoIsMappedAsFarAsTheDriveCan) {
  EXPECT_EQ(document(eds_of("sparse.eds"))["protocols"]["canopen"]["tpdo"], json::parse(R"([
    {"n": 1, "map": ["statusword", "position_actual"], "inhibit_us": 5000},
    {"n": 2, "map": ["mode_display"]}])"))
      << "what always changes needs an inhibit time";
  const json stubborn = document(eds_of("stubborn.dcf"))["protocols"]["canopen"];
  EXPECT_EQ(stubborn["tpdo"], json::parse(R"([
    {"n": 1, "map": ["statusword"], "inhibit_us": 5000, "event_ms": 500},
    {"n": 2, "map": ["mode_display", "error_code"], "inhibit_us": 20000, "event_ms": 500}])"))
      << "1A00h has one entry, and there is no TPDO 3";
  EXPECT_EQ(stubborn["unused_tpdos"], json({4}));
}

TEST_F(ProfileFromEds, WhatCannotBeUsedAsItIsIsTakenForMissing) {
  const MadeProfile made_of_it = made(eds_of("stubborn.dcf"));
  json out = std::get<json>(parse_json(made_of_it.text));
  for (const char* const note :
       {"without target_torque (6071h): is ro in the EDS", "without dc_voltage (6079h): has no DataType in the EDS"})
    EXPECT_THAT(made_of_it.notes, Contains(note));
  EXPECT_EQ(out["objects"]["profile_acceleration"]["type"], "f32");
  EXPECT_THAT(made_of_it.notes,
              Contains(HasSubstr("without profile_deceleration (6084h): DataType is 0x0007 in line")));
  EXPECT_EQ(out["objects"]["max_torque"]["type"], "i16");
  EXPECT_EQ(out["objects"]["max_velocity"]["access"], "ro");
  EXPECT_EQ(out["objects"]["controlword"]["access"], "wo");
  EXPECT_EQ(out["objects"].value("target_velocity", json::object()).value("range", json()), json())
      << "the set-point must take 0";
  EXPECT_TRUE(out["modes"]["4"].is_null());
  EXPECT_TRUE(out["modes"]["3"] == json() && !out["modes"].contains("1")) << "ParameterValue of 6502h: 1 and 6 alone";
}

TEST_F(ProfileFromEds, OneCountATurnIsNoEncoder) {
  Eds eds = eds_of("complete.eds");
  for (const ObjectAddress address : {ObjectAddress{0x60A8, 0}, {0x6092, 1}, {0x6092, 2}}) eds.objects.erase(address);
  const auto asked = testing::Contains(testing::StartsWith("position_units_per_rev: "));
  EXPECT_THAT(made(eds).questions, testing::Not(asked));
  eds.objects.at({0x608F, 1}).value = 1;
  EXPECT_THAT(made(eds).questions, asked);
  json out = document(eds);
  EXPECT_TRUE(out["constants"]["position_units_per_rev"]["first"].is_null())
      << "the drive would give the same until somebody has set it";
}

TEST_F(ProfileFromEds, CountsThatTheEdsAloneDoesNotTellAreAskedFor) {
  const auto asked = testing::Contains(testing::StartsWith("position_units_per_rev: "));
  Eds eds = eds_of("complete.eds");
  eds.objects.erase({0x608F, 1});
  EXPECT_THAT(made(eds).questions, asked) << "60A8h says increments, and nothing says how many a turn has";
  eds.objects.at({0x60A8, 0}).value = 0xFDB40000;  // a thousandth of a turn
  EXPECT_THAT(made(eds).questions, testing::Not(asked));
  eds.objects.at({0x60A8, 0}).value.reset();
  EXPECT_THAT(made(eds).questions, testing::Not(asked)) << "the drive will say";
}

TEST_F(ProfileFromEds, WithoutCia402ThereIsNone) {
  const MadeProfile out = made(parse_eds("[1000]\nDataType=7\n[6041]\nDataType=8\n"));
  EXPECT_EQ(out.text, "");
  EXPECT_THAT(out.faults,
              ElementsAre("6040h (controlword): not in the EDS; no CiA 402 drive is commanded without it",
                          "6041h (statusword): is REAL32 in the EDS; no CiA 402 drive is commanded without it",
                          "6060h (mode): not in the EDS; no CiA 402 drive is commanded without it"));
}

TEST_F(ProfileFromEds, TheNumberOfMotorsIsNoValue) {
  Eds eds = eds_of("complete.eds");
  EdsObject count = eds.objects.at({0x606C, 0});
  count.type = 0x05;
  eds.objects[{0x606C, 1}] = eds.objects[{0x606C, 2}] = std::exchange(eds.objects.at({0x606C, 0}), count);
  const MadeProfile out = made(eds);
  EXPECT_THAT(out.notes,
              Contains("without velocity_actual (606Ch): has sub-indexes in the EDS, perhaps one for each of "
                       "several motors"));
  eds.objects[{0x6840, 0}] = eds.objects.at({0x6040, 0});
  EXPECT_THAT(made(eds).notes, Contains(testing::StartsWith("6840h is in the EDS: there is a second axis")));
}

TEST_F(ProfileFromEds, TitlesAreTextWhateverTheFileHolds) {
  Eds eds = eds_of("complete.eds");
  eds.vendor_name = "M\xFCller\x1B\x07";
  eds.product_name = std::string(5000, 'x');
  json out = document(eds);
  EXPECT_THAT(out["title"].get<std::string>(), testing::StartsWith("M\xC3\xBCller xxx"));
  EXPECT_LE(out["title"].get<std::string>().size(), 120U);
}

TEST_F(ProfileFromEds, WhatTheDriveItselfSaysGoesBeforeItsEds) {
  Eds eds = eds_of("complete.eds");
  EXPECT_THAT(asked_of_node(eds), testing::IsSupersetOf({ObjectAddress{0x1018, 1}, {0x6502, 0}, {0x60A9, 0}}));
  EXPECT_THAT(asked_of_node(eds), testing::Not(Contains(ObjectAddress{0x1018, 3}))) << "the EDS does not have it";
  EXPECT_EQ(take_answer(eds, {{0x1018, 1}, 0xABC}, 5), "1018h:01 is 0xabc, read from node 5");
  EXPECT_EQ(take_answer(eds, {{0x6502, 0}, 0x21}, 5), "6502h is 0x21, read from node 5");
  EXPECT_EQ(take_answer(eds, {{0x60A9, 0}, std::nullopt}, 5), "60A9h is refused by node 5: taken for missing");
  json out = document(eds);
  EXPECT_EQ(out["identity"]["vendor"], "0x00000ABC");
  EXPECT_TRUE(out["modes"].contains("3") && out["modes"]["3"].is_null());
  EXPECT_THAT(made(eds).questions, Contains(testing::StartsWith("speed_units_per_rpm: ")));
}

TEST(ProfileText, ReadAgainItIsTheSameDocument) {
  for (const char* const name : {"cia402", "kinco-jd", "id286pro"}) {
    const json document = std::get<json>(parse_json(test::content(shipped(name))));
    const std::string once = profile_text(document);
    EXPECT_EQ(std::get<json>(parse_json(once)), document);
    std::istringstream lines(once);
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(line.size(), line.ends_with("{") ? 140U : 800U) << line;
  }
}

TEST(ProfileText, ADifferenceSaysNullOfWhatIsNotThere) {
  const json base = json::parse(R"({"a": {"b": 1, "c": [1, 2]}, "d": 3, "same": {"x": 1}})");
  const json wanted = json::parse(R"({"a": {"c": [1], "e": 5}, "same": {"x": 1}, "f": {"g": 1}})");
  EXPECT_EQ(difference(base, wanted), json::parse(R"({"a": {"b": null, "c": [1], "e": 5}, "d": null, "f": {"g": 1}})"));
}

TEST(ProfileText, AnyTextBecomesAName) {
  EXPECT_EQ(profile_name("EPOS4 70/15 (Disk)"), "epos4-70-15-disk");
  EXPECT_EQ(profile_name("--"), "drive");
  EXPECT_EQ(profile_name(std::string(60, 'a')), std::string(48, 'a'));
  EXPECT_EQ(profile_name("M\xFCller"), "m-ller");
}

}  // namespace
}  // namespace axisgate::profile
