// SPDX-License-Identifier: Apache-2.0
// A profile made from a table of registers: a form that is valid, that asks, and that enables nothing before.
#include "gateway/profile/make/form.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "gateway/profile/eds/eds_compare.hpp"
#include "gateway/profile/make/from_form.hpp"
#include "gateway/profile/read/profile_loader.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view kRegisters =
    "name,address,type,access,unit,range\n"
    "control,0x2000,u16,rw,,\n"
    "target_position,0x2002,i32,rw,counts,-100000..100000\n"
    "target_velocity,0x2004,i16,rw,0.1 rpm,\"-30000, 30000\"\n"
    "profile_acceleration,0x2005,u16,rw,rpm/s,1-5000\n"
    "status,0x1000,u16,r,,\n"
    "fault,0x1001,u16,R,,\n"
    "Actual position,0x1002,int32,ro,counts,\n"
    "velocity_actual,0x1004,i16,ro,rpm,\n"
    "dc_voltage,0x1010,u16,ro,0.1 V,\n"
    "gain,0x3000,word,R/W,,0..100\n";

class ProfileFromForm : public ::testing::Test {
 protected:
  [[nodiscard]] LoadedProfile loaded(const MadeProfile& out) const {
    const std::string path = (folder_.path() / "made.json").string();
    std::ofstream(path) << out.text;
    return load_profile(path, {test::source_path("schemas/drives")});
  }
  [[nodiscard]] static MadeProfile made(std::string_view csv) {
    const Form form = parse_form(csv, FormOf::modbus);
    EXPECT_THAT(form.faults, IsEmpty());
    return profile_from_form(form, {"made", "", "registers.csv"});
  }

  test::OwnFolder folder_;
};

TEST(Form, ReadsWhatAManualsTableIsCopiedInto) {
  const Form form = parse_form(kRegisters, FormOf::modbus);
  EXPECT_THAT(form.faults, IsEmpty());
  ASSERT_EQ(form.rows.size(), 10U);
  EXPECT_EQ(form.rows[0].name, "status");
  EXPECT_EQ(form.rows[2].name, "actual_position");
  EXPECT_EQ(form.rows[2].type(), "i32");
  EXPECT_FALSE(form.rows[2].writes);
  const FormRow& velocity = form.rows[7];
  EXPECT_EQ(velocity.address.index, 0x2004);
  EXPECT_EQ(velocity.unit, "0.1 rpm");
  EXPECT_EQ(velocity.low, -30000);
  EXPECT_EQ(velocity.high, 30000);
  EXPECT_TRUE(velocity.reads && velocity.writes);
}

TEST(Form, TakesOtherSeparatorsAndOrdersOfColumns) {
  const Form form = parse_form("Address;Name;Type\n100;Motor current (A);u16\n", FormOf::modbus);
  EXPECT_THAT(form.faults, IsEmpty());
  ASSERT_EQ(form.rows.size(), 1U);
  EXPECT_EQ(form.rows[0].name, "motor_current");
  EXPECT_EQ(parse_form("speed\t0x10\tu16\tro\n", FormOf::modbus).rows.at(0).address.index, 16);
  const Form objects =
      parse_form("target,607Ah,i32,rw\nlimit,0x607D:02,i32,rw\nspeed,6081.00,u32,rw\n", FormOf::canopen);
  EXPECT_THAT(objects.faults, IsEmpty());
  EXPECT_EQ(objects.rows.at(1).address, (ObjectAddress{0x607D, 2}));
}

TEST(Form, EachMistakeIsToldWithItsLine) {
  const Form form =
      parse_form("name,address,type\n,1,u16\na,x,u16\nb,2,float\nc,3,u32\nd,4,u16\nc,9,u16\n", FormOf::modbus);
  EXPECT_THAT(form.faults, ElementsAre(EdsFault{2, "has no name"}, EdsFault{3, "\"x\" is no address"},
                                       EdsFault{4, "\"float\" is no type: u8, i8, u16, i16, u32 or i32"},
                                       EdsFault{6, "its address is taken by line 5"},
                                       EdsFault{7, "name c is that of line 5 as well"}));
  EXPECT_THAT(parse_form("", FormOf::modbus).faults, testing::SizeIs(1));
  EXPECT_THAT(parse_form("a,1,u16,rw,,much\n", FormOf::modbus).faults,
              ElementsAre(EdsFault{1, "\"much\" is no range: 0..3000"}));
}

TEST_F(ProfileFromForm, IsAValidProfileWithEveryQuestionOpen) {
  const MadeProfile out = made(kRegisters);
  ASSERT_THAT(out.faults, IsEmpty());
  const LoadedProfile profile = loaded(out);
  EXPECT_EQ(text(profile.faults), "") << out.text;
  json document = std::get<json>(parse_json(out.text));
  for (const char* const command : {"enable", "disable", "quick_stop", "move_absolute", "run_velocity"}) {
    const std::string of = std::string("/commands/") + command;
    EXPECT_THAT(out.questions, Contains(AllOf(HasSubstr(of + ": "), HasSubstr("until then no enable")))) << of;
  }
  EXPECT_THAT(out.questions, Contains(HasSubstr("/protocols/modbus-rtu/word_order")));
  EXPECT_EQ(document["quantities"]["position_actual"]["object"], "actual_position");
  EXPECT_EQ(document["units"]["rpm_by_0_1"], json::parse(R"({"base": "rpm", "mul": [10]})"));
  EXPECT_EQ(document["modes"], json::parse(R"({"1": 1, "3": 3})"));
}

TEST_F(ProfileFromForm, AQuickStopAlwaysWaitsUntilTheMotorStands) {
  json steps = std::get<json>(parse_json(made(kRegisters).text))["commands"]["quick_stop"]["steps"];
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[1]["wait"], "status");
  EXPECT_FALSE(steps[1].contains("optional"));
}

TEST_F(ProfileFromForm, RunsGoAsFarAsThereIsNoHole) {
  json protocol = std::get<json>(parse_json(made(kRegisters).text))["protocols"]["modbus-rtu"];
  EXPECT_EQ(protocol["runs"], json::parse("[[4096, 4100], [8194, 8197]]"));
  EXPECT_EQ(protocol["max_registers"], 5);
  EXPECT_EQ(protocol["resynchronisation"], json::parse(R"([{"object": "status", "counts": [1, 2]}])"));
}

TEST_F(ProfileFromForm, WhatAFormCannotDoWithoutIsNamed) {
  const MadeProfile out = made("speed,1,u16,rw,rpm,\n");
  EXPECT_EQ(out.text, "");
  EXPECT_THAT(out.faults, ElementsAre(HasSubstr("two registers in a row"), HasSubstr("needs a row \"control\""),
                                      HasSubstr("needs a row \"status\""), HasSubstr("needs a row \"fault\"")));
}

TEST_F(ProfileFromForm, AQuantityNeedsAUnitOfItsKind) {
  const MadeProfile out = made("control,1,u16,rw\nstatus,2,u16,ro\nfault,3,u16,ro\nvelocity_actual,4,i16,ro,ms\n");
  EXPECT_THAT(out.notes, Contains("line 4: velocity_actual is no quantity: \"ms\" is no unit of its kind"));
  EXPECT_EQ(text(loaded(out).faults), "") << out.text;
}

TEST_F(ProfileFromForm, WhatStandsForTheRightNumbersFitsControl) {
  for (const char* const range : {"0..29", "10..99", "0..3"}) {
    std::string table(kRegisters);
    const std::string row = "control,0x2000,u16,rw,,";
    table.replace(table.find(row), row.size(), row + range);
    EXPECT_EQ(text(loaded(made(table)).faults), "") << range;
  }
}

TEST_F(ProfileFromForm, ASiblingGivesCommandsAndState) {
  const LayeredProfile sibling = layered_profile(shipped("id286pro"), {});
  const json objects = (*sibling.document)["objects"];
  std::string table = "name,address,type,access,unit,range\nextra,900,u16,ro,,\n";
  for (const auto& [name, object] : objects.items())
    if (name != "new_position" && name != "homing_mode")
      table += name + "," + std::to_string(object["at"]["modbus-rtu"].get<int>() + 1000) + "," +
               object["type"].get<std::string>() + "," + object.value("access", "ro") + ",,\n";
  const MadeProfile out =
      profile_like(parse_form(table, FormOf::modbus), *sibling.document, {"made", "id286pro", "registers.csv"});
  ASSERT_THAT(out.faults, IsEmpty());
  const LoadedProfile profile = loaded(out);
  EXPECT_EQ(text(profile.faults), "") << out.text;
  json document = std::get<json>(parse_json(out.text));
  EXPECT_EQ(document["extends"], "id286pro");
  EXPECT_EQ(document["objects"]["control"]["at"]["modbus-rtu"],
            objects["control"]["at"]["modbus-rtu"].get<int>() + 1000);
  EXPECT_TRUE(document["commands"]["set_position"].is_null()) << "new_position is not in the table";
  EXPECT_TRUE(document["homing"].is_null());
  EXPECT_TRUE(document["objects"].contains("extra"));
  EXPECT_THAT(out.questions, Contains(AllOf(HasSubstr("/commands: "), HasSubstr("until then no enable"))));
}

TEST_F(ProfileFromForm, ASiblingsStopThatIsNotThereIsNamed) {
  const LayeredProfile sibling = layered_profile(shipped("id286pro"), {});
  const MadeProfile out = profile_like(parse_form("fault_code,1,u16,ro\nrun_state,2,u16,ro\n", FormOf::modbus),
                                       *sibling.document, {"made", "id286pro", "registers.csv"});
  EXPECT_THAT(out.faults, Contains("needs the rows that quick_stop of \"id286pro\" uses: give them its names"));
  EXPECT_EQ(out.text, "");
}

TEST_F(ProfileFromForm, ATableOfObjectsIsAsGoodAsAnEds) {
  const LayeredProfile base = layered_profile(shipped("cia402-generic"), {});
  std::string table = "name,address,type,access\n";
  const json objects = (*base.document)["objects"];
  for (const auto& [name, object] : objects.items())
    if (name != "homing_method")
      table += name + "," + object["at"]["canopen"].get<std::string>() + "," + object["type"].get<std::string>() + "," +
               object.value("access", "ro") + "\n";
  const Form form = parse_form(table, FormOf::canopen);
  ASSERT_THAT(form.faults, IsEmpty());
  const MadeProfile out = profile_from_eds(eds_of(form), *base.document, {"made", "cia402-generic", "objects.csv"});
  EXPECT_EQ(text(loaded(out).faults), "") << out.text;
  EXPECT_THAT(out.notes, Contains("without homing_method (6098h): not in the EDS"));
}

}  // namespace
}  // namespace axisgate::profile
