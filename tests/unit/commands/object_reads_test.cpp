// SPDX-License-Identifier: Apache-2.0
// What one answer says of the profile of an object.
#include "gateway/commands/try/plan/object_reads.hpp"

#include <gmock/gmock.h>

namespace axisgate::commands {
namespace {

using testing::HasSubstr;

class ObjectReads : public ::testing::Test {
 protected:
  explicit ObjectReads() {
    model_.protocol = "canopen";
    model::ObjectDef object;
    object.name = "profile_velocity";
    object.address = {0x6081, 0};
    object.size = 4;
    object.is_signed = true;
    model_.objects = {object};
    model_.axes.resize(1);
    model_.axes[0].binding_of.fill(-1);
  }
  ObjectRow row(std::uint32_t data, std::uint8_t size) {
    BatchResult answer;
    answer.object_data = data;
    answer.object_size = size;
    return row_of(model_, 0, answer);
  }
  model::DriveModel model_;
};

TEST_F(ObjectReads, AnotherWidthIsWrongUnlessNobodyHasPrintedIt) {
  EXPECT_FALSE(row(7, 4).wrong);
  const ObjectRow narrow = row(7, 2);
  EXPECT_TRUE(narrow.wrong);
  EXPECT_THAT(line_of(narrow), HasSubstr("WRONG: 2 bytes, the profile says 4"));
  model_.objects[0].any_width = true;
  EXPECT_FALSE(row(7, 2).wrong);
}

TEST_F(ObjectReads, ARefusedObjectIsWrongWhereNothingMovesWithoutIt) {
  BatchResult refused;
  refused.outcome = {Errc::refused_by_drive, 0x06020000};
  refused.abort_code = 0x06020000;
  EXPECT_FALSE(row_of(model_, 0, refused).wrong);
  EXPECT_THAT(row_of(model_, 0, refused).remark, HasSubstr("0x06020000"));
  model_.axes[0].state_sources = {0};
  model_.axes[0].statusword = 0;
  EXPECT_TRUE(row_of(model_, 0, refused).wrong);
}

TEST_F(ObjectReads, OnModbusRtuBothWordOrdersStandSideBySide) {
  model_.protocol = "modbus-rtu";
  const ObjectRow turn = row(0x27100000, 4);
  EXPECT_EQ(turn.value, 0x27100000);
  EXPECT_EQ(turn.other_order, 10000);
  EXPECT_FALSE(turn.wrong) << "either is possible";
  EXPECT_THAT(line_of(turn), HasSubstr("(other word order 10000)"));
  model_.objects[0].printed = {0, 100000};
  EXPECT_TRUE(row(0x27100000, 4).wrong) << "only one of them is";
  EXPECT_FALSE(row(0x00002710, 4).wrong);
}

TEST_F(ObjectReads, AnUnusualValueAloneIsNotWrong) {
  model_.objects[0].printed = {1, 100};
  EXPECT_FALSE(row(0, 4).wrong);
  EXPECT_THAT(row(0, 4).remark, HasSubstr("outside its range 1 to 100"));
}

TEST_F(ObjectReads, TheSetupIsHeldAgainstWhatTheDriveHolds) {
  BatchResult answer;
  answer.object_data = 0xFFFFFFFF;
  EXPECT_TRUE(setup_row(model_, {0, -1, ""}, answer).holds);
  const SetupRow other = setup_row(model_, {0, 5, ""}, answer);
  EXPECT_FALSE(other.holds);
  EXPECT_EQ(other.text, "profile_velocity (6081.00) holds -1, the setup writes 5");
}

TEST_F(ObjectReads, LinesAreBrokenAtSpaces) {
  for (const std::string& line : wrapped("  saw    " + std::string(200, 'a') + " b c d " + std::string(60, 'e'), 9))
    EXPECT_TRUE(line.size() <= 79 || line.find(' ', 9) == std::string::npos) << line;
  EXPECT_THAT(wrapped("one two three", 2, 8), testing::ElementsAre("one two", "  three"));
}

}  // namespace
}  // namespace axisgate::commands
