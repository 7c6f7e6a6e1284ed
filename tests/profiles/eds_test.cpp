// SPDX-License-Identifier: Apache-2.0
// Reading an EDS: what such files look like in practice, and what a damaged one is told.
#include "gateway/profile/eds/eds.hpp"

#include <gmock/gmock.h>

#include <random>
#include <sstream>

#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"

namespace axisgate::profile {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string made_by_hand() { return test::content(test::source_path("tests/profiles/eds/kinco-md.eds")); }

std::string one_object(const std::string& keys, const std::string& section = "6040") {
  return "[" + section + "]\nParameterName=x\n" + keys;
}

const EdsObject& the_object(const Eds& eds, ObjectAddress address) {
  static const EdsObject kNone;
  const auto at = eds.objects.find(address);
  if (at == eds.objects.end()) ADD_FAILURE() << "no such object";
  return at == eds.objects.end() ? kNone : at->second;
}

TEST(Eds, TellsWhoMadeTheDrive) {
  const Eds eds = parse_eds(made_by_hand());
  EXPECT_THAT(eds.faults, IsEmpty());
  EXPECT_EQ(eds.vendor_name, "Made for tests");
  EXPECT_EQ(eds.product_name, "MD80");
  EXPECT_EQ(eds.vendor, 0x300);
  EXPECT_EQ(eds.product, 0x4D44);
  EXPECT_EQ(eds.revision, 0x10002);
}

TEST(Eds, ObjectsHaveTypeAccessAndMappability) {
  const Eds eds = parse_eds(made_by_hand());
  const EdsObject& status = the_object(eds, {0x6041, 0});
  EXPECT_EQ(status.section, "6041");
  EXPECT_EQ(eds_type_name(status.type), "UNSIGNED16");
  EXPECT_EQ(status.access, "ro");
  EXPECT_TRUE(status.mappable);
  EXPECT_EQ(the_object(eds, {0x6099, 1}).section, "6099Sub1");
  EXPECT_FALSE(eds.objects.contains({0x6099, 9}));
}

TEST(Eds, TheHeadOfARecordIsNoObjectOfItsOwn) {
  const Eds eds = parse_eds(made_by_hand());
  EXPECT_EQ(the_object(eds, {0x6099, 0}).access, "const");
  EXPECT_EQ(the_object(eds, {0x1800, 0}).section, "1800sub0");
}

TEST(Eds, ACompactArrayHasAllItsSubIndexes) {
  const Eds eds = parse_eds(made_by_hand());
  EXPECT_EQ(the_object(eds, {0x1A00, 0}).type, 0x0005);
  for (std::uint8_t sub = 1; sub <= 8; ++sub) EXPECT_EQ(the_object(eds, {0x1A00, sub}).type, 0x0007);
  EXPECT_FALSE(eds.objects.contains({0x1A00, 9}));
}

TEST(Eds, ASectionOfItsOwnCountsMoreThanTheCompactArray) {
  const Eds eds =
      parse_eds("[2000]\nDataType=7\nCompactSubObj=3\nAccessType=ro\n[2000sub2]\nDataType=6\nAccessType=rw\n");
  EXPECT_EQ(the_object(eds, {0x2000, 1}).type, 7);
  EXPECT_EQ(the_object(eds, {0x2000, 2}).type, 6);
  EXPECT_EQ(the_object(eds, {0x2000, 2}).access, "rw");
}

TEST(Eds, NumbersAreHexadecimalOctalOrDecimal) {
  const Eds eds = parse_eds(one_object("DataType=0x0007\nLowLimit=010\nHighLimit=0XfF ; not more\n"));
  EXPECT_EQ(the_object(eds, {0x6040, 0}).low, 8);
  EXPECT_EQ(the_object(eds, {0x6040, 0}).high, 255);
  EXPECT_THAT(eds.faults, IsEmpty());
}

TEST(Eds, SignedLimitsMayBeWrittenAsTheirBytes) {
  const Eds wide = parse_eds(one_object("DataType=4\nLowLimit=0x80000000\nHighLimit=0x7FFFFFFF\n"));
  EXPECT_EQ(the_object(wide, {0x6040, 0}).low, -2147483648LL);
  EXPECT_EQ(the_object(wide, {0x6040, 0}).high, 2147483647);
  const Eds narrow = parse_eds(one_object("DataType=2\nLowLimit=0xEE\nHighLimit=-1\n"));
  EXPECT_EQ(the_object(narrow, {0x6040, 0}).low, -18);
  EXPECT_EQ(the_object(narrow, {0x6040, 0}).high, -1);
}

TEST(Eds, AFormulaOfTheNodeIsNoLimit) {
  const Eds eds = parse_eds(one_object("DataType=7\nLowLimit=$NODEID+0x180\nHighLimit=0x80 + $nodeid\n"));
  EXPECT_THAT(eds.faults, IsEmpty());
  EXPECT_EQ(the_object(eds, {0x6040, 0}).low, std::nullopt);
  EXPECT_EQ(the_object(eds, {0x6040, 0}).high, std::nullopt);
}

TEST(Eds, CaseBlanksCommentsAndLineEndsMeanNothing) {
  const Eds eds =
      parse_eds("\xEF\xBB\xBF; a comment\r\n\r\n [ 60Fd ] \r\n  DATATYPE = 0x7 \r\naccesstype= RO\r\n\tPdoMapping =1");
  EXPECT_THAT(eds.faults, IsEmpty());
  const EdsObject& inputs = the_object(eds, {0x60FD, 0});
  EXPECT_EQ(inputs.type, 7);
  EXPECT_EQ(inputs.access, "ro");
  EXPECT_TRUE(inputs.mappable);
}

TEST(Eds, ForeignCharactersInNamesAreKept) {
  const Eds eds = parse_eds("[DeviceInfo]\nVendorName=Antriebe M\xFCller\n[6040]\nDataType=6\n");
  EXPECT_THAT(eds.faults, IsEmpty());
  EXPECT_EQ(eds.vendor_name, "Antriebe M\xFCller");
}

TEST(Eds, SectionsThatAreNoObjectsAreNone) {
  const Eds eds =
      parse_eds("[MandatoryObjects]\n1=0x1000\n[6099Name]\n1=x\n[DynamicChannels]\nNrOfSeg=0\n[6040]\nDataType=6\n");
  EXPECT_THAT(eds.objects, SizeIs(1));
  EXPECT_THAT(eds.faults, IsEmpty());
}

TEST(Eds, EachDamagedLineIsNamed) {
  const Eds eds = parse_eds(
      "early=1\n[6040\n[6040]\nDataType=6\nDataType=7\nthis is no EDS\n[6040]\nLowLimit=many\n[6041]\nDataType=0x\n");
  ASSERT_THAT(eds.faults, SizeIs(7));
  EXPECT_EQ(eds.faults[0], (EdsFault{1, "\"early=1\" stands before the first [section]"}));
  EXPECT_EQ(eds.faults[1], (EdsFault{2, "\"[6040\" is a section without its ]"}));
  EXPECT_EQ(eds.faults[2], (EdsFault{5, "key datatype is given twice in [6040]"}));
  EXPECT_EQ(eds.faults[3], (EdsFault{6, "\"this is no EDS\" is neither [section] nor key=value"}));
  EXPECT_EQ(eds.faults[4], (EdsFault{7, "section [6040] is there already, in line 3"}));
  EXPECT_EQ(eds.faults[5], (EdsFault{8, "many is no number"}));
  EXPECT_EQ(eds.faults[6], (EdsFault{10, "0x is no number"}));
}

TEST(Eds, WhatIsNoEdsIsSaidToBeNone) {
  EXPECT_THAT(parse_eds("").faults, ElementsAre(EdsFault{0, "has no object: is this an EDS?"}));
  const std::string zeroes(100, '\0');
  EXPECT_THAT(parse_eds(zeroes).faults.at(0).message, HasSubstr("bytes that are no text"));
  EXPECT_THAT(parse_eds("{\"profile\": 1}").faults.at(0).message, HasSubstr("neither [section] nor key=value"));
}

TEST(Eds, AMessageNeverCarriesTheBytesOfADamagedFile) {
  for (const EdsFault& fault : parse_eds("\x1B[31m\x07\n[60\x1B[2J40\n").faults)
    for (const char c : fault.message) EXPECT_TRUE(c >= ' ' && c <= '~') << fault.message;
}

TEST(Eds, BigFilesAreReadOrRefusedWithinBounds) {
  EXPECT_THAT(parse_eds(std::string(kMaxEdsBytes + 1, ';')).faults.at(0).message, HasSubstr("longer than 4 MiB"));
  std::string many;
  for (int i = 0; i < 0x300; ++i) {
    std::ostringstream index;
    index << std::hex << 0x2000 + i;
    many += "[" + index.str() + "]\nDataType=7\nCompactSubObj=254\n";
  }
  const Eds eds = parse_eds(many);
  EXPECT_LE(eds.objects.size(), kMaxEdsObjects);
  EXPECT_FALSE(eds.faults.empty()) << "what was left out must not look as if it were not there";
  EXPECT_LE(parse_eds(std::string(100000, '\n') + "x\n").faults.size(), kMaxEdsFaults);
  std::string wrong;
  for (int i = 0; i < 1000; ++i) wrong += "wrong\n";
  EXPECT_THAT(parse_eds(wrong).faults, SizeIs(kMaxEdsFaults));
  EXPECT_THAT(parse_eds("[6040]\nDescription=" + std::string(5000, 'x')).faults, SizeIs(1));
}

TEST(Eds, EveryBeginningAndEveryDamageOfAFileIsTakenCalmly) {
  const std::string whole = made_by_hand();
  for (std::size_t size = 0; size < whole.size(); size += 7) static_cast<void>(parse_eds(whole.substr(0, size)));
  std::mt19937 random(306);
  for (int round = 0; round < 300; ++round) {
    std::string damaged = whole;
    for (int i = 0; i < 20; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
    const Eds eds = parse_eds(damaged);
    EXPECT_LE(eds.faults.size(), kMaxEdsFaults + 1);
  }
}

}  // namespace
}  // namespace axisgate::profile
