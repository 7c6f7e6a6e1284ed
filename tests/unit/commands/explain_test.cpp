// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"
#include "tests/places.hpp"

#include <gmock/gmock.h>

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
  EXPECT_THAT(told("0x8611"), HasSubstr("Kinco JD"));
}

TEST(Explain, NamesTheClassOfACodeThatNoDriveHere) {
  EXPECT_THAT(told("0x7390"), HasSubstr("0x7390 is of the class\nsensor (error code 0x7300"));
}

TEST(Explain, NamesTheRowOfARefusedBlock) {
  EXPECT_THAT(told("0x0A000032"), HasSubstr("the first row refused is 50 of the axis, profile_acceleration"));
  EXPECT_THAT(told("0x0A0000FE"), HasSubstr("254 of the axis: there is no such row"));
}

TEST(Explain, SaysNothingOfWhatItDoesNotKnow) {
  EXPECT_EQ(told("frobnicate"), "");
  EXPECT_EQ(told("0x12345678"), "");
}

}  // namespace
}  // namespace axisgate::commands
