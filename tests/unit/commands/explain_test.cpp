// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"
#include "tests/places.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <regex>
#include <set>

namespace axisgate::commands {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string told(const std::string& typed) { return explanation(typed, {test::source_path("schemas/drives")}); }

TEST(Explain, SaysMeaningCausesAndRemedy) {
  const std::string out = told("stop_latched");
  EXPECT_THAT(out, HasSubstr("stop_latched (axis alarm 7: bits of registers 34 and 35 of the axis)\n"));
  EXPECT_THAT(out, HasSubstr("  meaning: "));
  EXPECT_THAT(out, HasSubstr("  causes:  "));
  EXPECT_THAT(out, HasSubstr("  remedy:  enable; command 0 first if the last command was 1 (coil 0: first 0); a "
                             "disable clears nothing\n"));
}

TEST(Explain, FindsALatchedAxisAndSaysWhichAlarmsStandAgainstAnEnable) {
  EXPECT_THAT(told("latched"), HasSubstr("stopping (axis state 5"));
  EXPECT_THAT(told("latched"), HasSubstr("stop_latched (axis alarm 7"));
  EXPECT_THAT(told("local_control"), HasSubstr("  enable:  is refused while it is set\n"));
  EXPECT_THAT(told("not_homed"), Not(HasSubstr("  enable:  is refused")));
}

TEST(Explain, KnowsTheFaultsOfEveryDriveThatHasTheCode) {
  const std::string out = told("0x3130");
  EXPECT_THAT(out, HasSubstr("phase failure (error code 0x3130"));
  for (const char* drive : {"iD286pro", "Keya KYDAS4860-2E", "Leadshine LD2-CAN"}) EXPECT_THAT(out, HasSubstr(drive));
  EXPECT_THAT(out, Not(HasSubstr("Kinco")));
  EXPECT_THAT(out, Not(HasSubstr("explain with the code"))) << "it was typed";
  EXPECT_THAT(told("phase failure"), HasSubstr("explain with the code"));
  EXPECT_THAT(told("0x8611"), HasSubstr("Kinco JD"));
}

TEST(Explain, NamesTheClassOfACodeThatNoDriveHere) {
  EXPECT_THAT(told("0x7390"), HasSubstr("0x7390 is of the class\nsensor (error code 0x7300"));
}

TEST(Explain, NamesTheRowOfARefusedBlock) {
  EXPECT_THAT(told("0x0A000032"), HasSubstr("the first row refused is 50 of the axis, profile_acceleration"));
  EXPECT_THAT(told("0x0A0000FE"), HasSubstr("254 of the axis: there is no such row"));
}

TEST(Explain, KnowsEachErrorIdOfTheBlocksForPlcs) {
  std::ifstream file(test::source_path("deploy/plc/axisgate.st"));
  const std::string blocks(std::istreambuf_iterator<char>(file), {});
  static const std::regex kError("(?:ErrorID|AnswerError|Wrong|Failed) := (16#02[0-9A-F]{2})");
  std::set<std::string> errors;
  for (auto at = std::sregex_iterator(blocks.begin(), blocks.end(), kError); at != std::sregex_iterator(); ++at)
    errors.insert((*at)[1].str());
  EXPECT_GT(errors.size(), 9U);
  for (const std::string& error : errors)
    EXPECT_THAT(told(error),
                testing::AllOf(HasSubstr("(ErrorID " + error + ": output of the blocks"), HasSubstr("  meaning: "),
                               HasSubstr("  causes:  "), HasSubstr("  remedy:  ")));
  EXPECT_EQ(told("0x0208"), told("16#0208"));
  EXPECT_EQ(told("520"), told("16#0208"));
  EXPECT_EQ(told("ErrorID 16#0208"), told("16#0208"));
}

TEST(Explain, TakesTheErrorIdOfARowOrAResultForWhatTheBlocksMakeOfIt) {
  EXPECT_THAT(told("16#0130"), testing::StartsWith("16#0130 (ErrorID: row refused)\n"));
  EXPECT_THAT(told("16#0130"), HasSubstr("the first row refused is 48 of the axis, profile_velocity\n"));
  EXPECT_EQ(told("0x0130"), told("16#0130"));
  EXPECT_THAT(told("16#01FE"), HasSubstr("254 of the axis: there is no such row"));
  EXPECT_THAT(told("16#0009"),
              testing::StartsWith("16#0009 (ErrorID: the result in register 25)\nstate unsuitable (result 9:"));
  EXPECT_THAT(told("16#0009"), Not(HasSubstr("nvm_budget"))) << "an alarm is a bit, which no ErrorID is";
  EXPECT_THAT(told("9"), HasSubstr("nvm_budget"));
  EXPECT_THAT(told("16#0010"), Not(HasSubstr("ErrorID"))) << "results of DDS replies";
  EXPECT_THAT(told("16#3130"), HasSubstr("phase failure")) << "AXG_ReadError's are the drive's";
}

TEST(Explain, KnowsTheWordsOfTheGlossaryAsTheyAreSpokenAndAsTheyAreWritten) {
  for (const char* typed : {"single write", "single_write", "Single-Write"})
    EXPECT_THAT(told(typed),
                testing::MatchesRegex("single write \\(docs/glossary.md\\)\n  meaning: .*\n  seen: .*\n  to do: .*\n"));
  for (const char* word : {"owner", "lease", "latch", "block", "id", "not new", "owed", "adopted", "posted", "orphan"})
    EXPECT_THAT(told(word), HasSubstr(std::string(word) + " (docs/glossary.md)\n")) << word;
  EXPECT_THAT(told("not new"), HasSubstr("not_new (result 10")) << "the result of that name as well";
  EXPECT_THAT(told("3"), Not(HasSubstr("glossary"))) << "a word of the glossary has no number";
}

TEST(Explain, SaysNothingOfWhatItDoesNotKnow) {
  EXPECT_EQ(told("frobnicate"), "");
  EXPECT_EQ(told("0x12345678"), "");
}

}  // namespace
}  // namespace axisgate::commands
