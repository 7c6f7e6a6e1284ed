// SPDX-License-Identifier: Apache-2.0
// The questions of a commissioning, and which yes counts: against a drive of three checks written down here.
#include "gateway/commands/commission/commission_plan.hpp"

#include <gmock/gmock.h>

namespace axisgate::commands {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

enum : model::ObjectId { din1, limits, din5, din6, save, hint };

model::ObjectDef object(const char* name, std::uint16_t index, std::uint8_t sub) {
  model::ObjectDef out;
  out.name = name;
  out.address = {index, sub};
  out.writable = true;
  return out;
}

model::Check check(const char* name, model::ObjectId id, std::uint32_t mask, std::int64_t bad,
                   std::vector<model::ObjectWrite> remedy) {
  model::Check out;
  out.name = name;
  out.bad = {id, mask, model::Condition::Test::equals, {bad}};
  out.text = std::string("what ") + name + " means";
  out.remedy = std::move(remedy);
  return out;
}

/// A first yes could free DIN1, a second take both limit switches away; the third check is beyond any write.
model::DriveModel drive_with_checks() {
  model::DriveModel out;
  out.objects = {object("din1_function", 0x2010, 3), object("input_functions", 0x2010, 0x0A),
                 object("din5_function", 0x2010, 7), object("din6_function", 0x2010, 8),
                 object("save", 0x2FF0, 1),          object("temperature", 0x2000, 0)};
  out.objects[save].trigger = true;
  const model::ObjectWrite store{save, 1, "keeps it over a restart"};
  out.checks = {
      check("din1_local_control", din1, 0, 1, {{din1, 0, "takes the function off DIN1"}, store}),
      check("limit_inputs_open", limits, 3, 3,
            {{din5, 0, "takes the positive limit off DIN5"}, {din6, 0, "takes the negative limit off DIN6"}, store}),
      check("too_warm", hint, 0, 90, {})};
  return out;
}

class CommissionPlan : public ::testing::Test {
 protected:
  std::string objection_to(const model::Check& asked, const Numbers& shown, const Numbers& now) {
    return objection(model_, asked, shown, now);
  }
  const model::DriveModel model_ = drive_with_checks();
  const model::Check& free_din1_ = model_.checks[0];
  const model::Check& open_limits_ = model_.checks[1];
  const Numbers limits_shown_{{limits, 0x43}, {din5, 0x10}, {din6, 0x20}};
};

TEST_F(CommissionPlan, EachFindingWithARemedyIsAQuestionOfItsOwn) {
  drive::ObjectStore store(model_.objects);
  EXPECT_THAT(to_ask(findings(model_, store, 0)), IsEmpty()) << "what is not known is not asked";
  store.read(din1, 1, Instant{});
  store.read(limits, 3, Instant{});
  store.read(hint, 90, Instant{});
  EXPECT_THAT(to_ask(findings(model_, store, 0)), ElementsAre(&free_din1_, &open_limits_));
  store.read(din1, 0, Instant{});
  EXPECT_THAT(to_ask(findings(model_, store, 0)), ElementsAre(&open_limits_));
}

TEST_F(CommissionPlan, AFindingThatNoWriteRemediesIsToldAsSuch) {
  drive::ObjectStore store(model_.objects);
  store.read(hint, 90, Instant{});
  EXPECT_THAT(text(model_, findings(model_, store, 0)[2]), AllOf(HasSubstr("BAD  too_warm"), HasSubstr("no write")));
}

TEST_F(CommissionPlan, AQuestionNamesEachWriteItsMeaningAndWhatIsThereNow) {
  const std::string asked = question(model_, open_limits_, limits_shown_);
  EXPECT_THAT(asked, AllOf(HasSubstr("limit_inputs_open: input_functions (2010.0A) = 0x43"),
                           HasSubstr("what limit_inputs_open means"),
                           HasSubstr("din5_function (2010.07) = 0  takes the positive limit off DIN5  (now 0x10)"),
                           HasSubstr("din6_function (2010.08) = 0  takes the negative limit off DIN6  (now 0x20)"),
                           HasSubstr("save (2FF0.01) = 1  keeps it over a restart\n")));
  EXPECT_THAT(asked, Not(HasSubstr("din1"))) << "a yes to this one does not write that one";
}

TEST_F(CommissionPlan, ATriggerIsNotRead) {
  EXPECT_THAT(objects_of(model_, open_limits_), ElementsAre(limits, din5, din6));
  EXPECT_THAT(objects_of(model_, free_din1_), ElementsAre(din1)) << "each once";
}

TEST_F(CommissionPlan, OnlyAWholeYesIsOne) {
  EXPECT_TRUE(means_yes("yes"));
  for (const char* line : {"", "y", "YES", "Yes", "yes ", " yes", "yesno", "no", "ja"})
    EXPECT_FALSE(means_yes(line)) << line;
}

TEST_F(CommissionPlan, AYesCountsWhileAllIsAsItWasShown) {
  EXPECT_EQ(objection_to(open_limits_, limits_shown_, limits_shown_), "");
}

TEST_F(CommissionPlan, AnInputThatTheCheckDoesNotLookAtMayChangeMeanwhile) {
  EXPECT_EQ(objection_to(open_limits_, limits_shown_, {{limits, 0x03}, {din5, 0x10}, {din6, 0x20}}), "");
}

TEST_F(CommissionPlan, AYesDoesNotCountForAnotherNumber) {
  EXPECT_THAT(objection_to(free_din1_, {{din1, 1}}, {{din1, 4}}),
              AllOf(HasSubstr("din1_function (2010.03) is 0x4 now"), HasSubstr("was 0x1")));
  EXPECT_THAT(objection_to(free_din1_, {{din1, 1}}, {{din1, 0}}), Not(IsEmpty())) << "somebody else has cured it";
}

TEST_F(CommissionPlan, AYesDoesNotCountWhereAnObjectThatItWouldOverwriteHasChanged) {
  EXPECT_THAT(objection_to(open_limits_, limits_shown_, {{limits, 0x43}, {din5, 0x10}, {din6, 0x40}}),
              HasSubstr("din6_function"));
}

TEST_F(CommissionPlan, AYesDoesNotCountForWhatCannotBeRead) {
  EXPECT_THAT(objection_to(free_din1_, {{din1, 1}}, {}), HasSubstr("could not be read"));
  EXPECT_THAT(objection_to(free_din1_, {}, {{din1, 1}}), HasSubstr("could not be read"));
}

TEST_F(CommissionPlan, NothingIsWrittenUnderTorqueOnAnyMotorOfTheDriveOrToADriveThatIsGone) {
  EXPECT_EQ(objection({{1, LinkState::online, true, false}, {2, LinkState::online, true, false}}), "");
  EXPECT_THAT(objection({{1, LinkState::online, true, false}, {2, LinkState::online, true, true}}),
              AllOf(HasSubstr("axis 2 is enabled"), HasSubstr("disable it first")));
  EXPECT_THAT(objection({{1, LinkState::online, false, false}}), HasSubstr("does not tell"));
  EXPECT_THAT(objection({{1, LinkState::suspect, true, false}}), HasSubstr("not online"));
  EXPECT_THAT(objection({{1, LinkState::offline, true, true}}), HasSubstr("not online"));
}

TEST_F(CommissionPlan, WhatWasWrittenIsReadBackAndSaid) {
  const ReadBack after = read_back(model_, open_limits_, {{limits, 0x40}, {din5, 0}, {din6, 0}});
  EXPECT_TRUE(after.cured);
  EXPECT_THAT(after.text, AllOf(HasSubstr("din5_function (2010.07) reads 0x0  takes the positive limit off DIN5\n"),
                                HasSubstr("limit_inputs_open: reads as it should")))
      << "when a setting acts, its reason tells";
}

TEST_F(CommissionPlan, ABadFindingThatNoWriteRemediesIsLeftBad) {
  EXPECT_FALSE(leaves_bad({{&free_din1_, true, true, 1}}));
  EXPECT_FALSE(leaves_bad({{&model_.checks[2], true, false, 20}}));
  EXPECT_TRUE(leaves_bad({{&free_din1_, true, true, 1}, {&model_.checks[2], true, true, 90}}));
}

TEST_F(CommissionPlan, ARegisterOfModbusRtuHasItsNumberAsTheManualsPrintIt) {
  model::DriveModel model = drive_with_checks();
  model.protocol = "modbus-rtu";
  model.objects[din1].address = {296, 0};
  EXPECT_THAT(text(model, model.checks[0].remedy[0]), HasSubstr("din1_function (register 296) = 0"));
}

TEST_F(CommissionPlan, AWriteThatDidNotHoldIsNoCure) {
  const ReadBack kept = read_back(model_, free_din1_, {{din1, 1}});
  EXPECT_FALSE(kept.cured);
  EXPECT_THAT(kept.text, AllOf(HasSubstr("reads 0x1, although 0 was written"), HasSubstr("STILL BAD")));
  const ReadBack other = read_back(model_, free_din1_, {{din1, 7}});
  EXPECT_FALSE(other.cured) << "not bad, and not what was agreed to either";
  EXPECT_THAT(other.text, HasSubstr("does not hold what was written"));
  const ReadBack silent = read_back(model_, free_din1_, {});
  EXPECT_FALSE(silent.cured);
  EXPECT_THAT(silent.text, HasSubstr("NOT KNOWN"));
}

}  // namespace
}  // namespace axisgate::commands
