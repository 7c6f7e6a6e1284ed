// SPDX-License-Identifier: Apache-2.0
// Reading an EDS: what such files look like in practice, and what a damaged one is told.
#include "gateway/profile/eds/eds.hpp"

#include <gmock/gmock.h>

#include <algorithm>
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

/// What a line of [6040] is read as, and the remark about it (empty: none).
struct Oddity {
  std::string line;
  std::optional<std::int64_t> low;
  std::string remark;
};

TEST(Eds, ANumberIsReadHoweverItIsWritten) {
  const std::vector<Oddity> cases{
      {"LowLimit=06h", 6, "lowlimit 06h is taken for 6"},
      {"LowLimit=1FH ; hexadecimal", 31, "lowlimit 1FH is taken for 31"},
      {"LowLimit=\"0x10\"", 16, "lowlimit \"0x10\" is taken for 16"},
      {"LowLimit='7'", 7, "lowlimit '7' is taken for 7"},
      {"LowLimit=08", 8, "lowlimit 08 is taken for 8"},
      {"LowLimit=+65535", 65535, "lowlimit +65535 is taken for 65535"},
      {"LowLimit=5 // at least", 5, ""},
      {"LowLimit=", std::nullopt, ""},
      {"LowLimit=many", std::nullopt, "lowlimit many is no number: left out"},
      {"LowLimit=0x", std::nullopt, "lowlimit 0x is no number: left out"},
      {"LowLimit=99999999999999999999", std::nullopt, "lowlimit 99999999999999999999 is no number: left out"},
  };
  for (const Oddity& it : cases) {
    const Eds eds = parse_eds(one_object("DataType=7\n" + it.line + "\n"));
    EXPECT_THAT(eds.faults, IsEmpty());
    EXPECT_EQ(the_object(eds, {0x6040, 0}).low, it.low) << it.line;
    if (it.remark.empty())
      EXPECT_THAT(eds.remarks, IsEmpty()) << it.line;
    else
      EXPECT_THAT(eds.remarks, ElementsAre(EdsFault{4, it.remark})) << it.line;
  }
}

TEST(Eds, WhatNobodyNeedsIsNotHeldAgainstTheFile) {
  const Eds eds = parse_eds(
      "[MandatoryObjects]\n12=0x1000\n12=0x1001\n"
      "[2001]\nDataType=8\nAccessType=rw\nLowLimit=1.5\nHighLimit=3.4E38\nDefaultValue=0.5\n"
      "[2002]\nDataType=0x1B\nHighLimit=0xFFFFFFFFFFFFFFFF\nDefaultValue=0xFFFFFFFFFFFFFFFF\n"
      "[2003]\nDataType=9\nDefaultValue=v1.0\n");
  EXPECT_THAT(eds.objects, SizeIs(3));
  EXPECT_THAT(eds.remarks,
              ElementsAre(EdsFault{3, "key 12 is given twice in [MandatoryObjects]: that of line 2 is taken"}));
}

TEST(Eds, EachOddLineIsARemarkAndTheRestIsRead) {
  const Eds eds = parse_eds(
      "early=1\n// a comment\n[6040\nDataType=6\nstray text\n[6041]\nDataType=6\n[6040]\nAccessType=rw\n[0x6060]\n"
      "DataType=2\n");
  EXPECT_THAT(eds.faults, IsEmpty());
  EXPECT_THAT(eds.remarks,
              ElementsAre(EdsFault{1, "\"early=1\" stands before the first [section]: left out"},
                          EdsFault{2, "\"// a comment\" is taken for a comment"},
                          EdsFault{3, "\"[6040\" is a section without its ]"},
                          EdsFault{5, "\"stray text\" is neither [section] nor key=value: left out"},
                          EdsFault{8, "section [6040] is there already, in line 3: both are taken together"},
                          EdsFault{10, "[0x6060] is taken for [6060]"}));
  EXPECT_EQ(the_object(eds, {0x6040, 0}).access, "rw");
  EXPECT_EQ(the_object(eds, {0x6040, 0}).type, 6);
  EXPECT_EQ(the_object(eds, {0x6060, 0}).type, 2);
}

TEST(Eds, WhatIsSaidInTwoWaysIsADoubtOfThatObjectAlone) {
  const Eds eds = parse_eds(
      "[6040]\nDataType=6\nDataType=7\n[6041]\nDataType=6\nDataType=6 ; again\nAccessType=ro\n"
      "[6060]\nDataType=2\nAccessType=rw\n[6060]\nAccessType=ro\n[6061]\nDataType=byte\n");
  EXPECT_EQ(the_object(eds, {0x6040, 0}).unclear, "DataType is 6 in line 2, and 7 in another one");
  EXPECT_EQ(the_object(eds, {0x6041, 0}).unclear, "");
  EXPECT_EQ(the_object(eds, {0x6060, 0}).unclear, "AccessType is rw in line 10, and ro in another one");
  EXPECT_EQ(the_object(eds, {0x6061, 0}).unclear, "DataType is byte in line 14, which is no number");
}

TEST(Eds, LimitsThatLeaveNoNumberAreNone) {
  for (const char* const limits : {"LowLimit=0\nHighLimit=0\n", "LowLimit=5\nHighLimit=3\n"}) {
    const Eds eds = parse_eds(one_object(std::string("DataType=7\n") + limits));
    EXPECT_EQ(the_object(eds, {0x6040, 0}).low, std::nullopt) << limits;
    EXPECT_EQ(the_object(eds, {0x6040, 0}).high, std::nullopt) << limits;
  }
}

TEST(Eds, AValueIsTheConfiguredOneOrElseTheDefault) {
  const Eds eds = parse_eds(
      "[6502]\nDataType=7\nDefaultValue=0x3AD\n[60A9]\nDataType=7\nDefaultValue=0\nParameterValue=0x00B44700\n"
      "[6060]\nDataType=2\nDefaultValue=0xFF\n[1018sub1]\nDataType=7\n");
  EXPECT_EQ(the_object(eds, {0x6502, 0}).value, 0x3AD);
  EXPECT_EQ(the_object(eds, {0x60A9, 0}).value, 0xB44700);
  EXPECT_EQ(the_object(eds, {0x6060, 0}).value, -1);
  EXPECT_EQ(the_object(eds, {0x1018, 1}).value, std::nullopt);
}

std::string as_utf16(std::string_view text, bool low_first, bool marked) {
  std::string out;
  const auto put = [&](char16_t unit) {
    const char low = static_cast<char>(unit & 0xFF), high = static_cast<char>(unit >> 8);
    out += low_first ? low : high;
    out += low_first ? high : low;
  };
  if (marked) put(0xFEFF);
  for (const char c : text) put(static_cast<unsigned char>(c));
  return out;
}

TEST(Eds, LineEndsAndEncodingsMeanNothing) {
  const std::string text = "[DeviceInfo]\nVendorName=M\xFCller\n[6041]\nDataType=6\n";
  std::string with_cr = text;
  std::ranges::replace(with_cr, '\n', '\r');
  EXPECT_EQ(the_object(parse_eds(with_cr), {0x6041, 0}).type, 6);
  for (const bool low_first : {true, false})
    for (const bool marked : {true, false}) {
      const Eds eds = parse_eds(as_utf16(text, low_first, marked));
      EXPECT_EQ(the_object(eds, {0x6041, 0}).type, 6);
      EXPECT_EQ(eds.vendor_name, "M\xC3\xBCller");
      EXPECT_THAT(eds.remarks, ElementsAre(EdsFault{0, "is UTF-16"}));
    }
}

TEST(Eds, WhatIsMissingIsMissing) {
  const Eds eds = parse_eds("[6041]\n[6099]\nSubNumber=3\n[6099sub1]\nDataType=7\n");
  EXPECT_THAT(eds.faults, IsEmpty());
  EXPECT_EQ(the_object(eds, {0x6041, 0}).type, 0);
  EXPECT_EQ(the_object(eds, {0x6041, 0}).access, "");
  EXPECT_EQ(eds.find({0x6099, 0}), nullptr);
  EXPECT_TRUE(eds.has_index(0x6099));
  EXPECT_FALSE(eds.has_index(0x6098));
  EXPECT_EQ(eds.vendor, std::nullopt);
}

TEST(Eds, WhatIsNoEdsIsSaidToBeNone) {
  const EdsFault none{0, "has no object: is this an EDS?"};
  const std::string zeroes(100, '\0');
  for (const std::string& text : {std::string(), zeroes, std::string("{\"profile\": 1}")})
    EXPECT_THAT(parse_eds(text).faults, ElementsAre(none));
  EXPECT_THAT(parse_eds("\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<ISO15745ProfileContainer>\n").faults,
              ElementsAre(EdsFault{
                  0, "is an XDD or XDC (XML): ask the drive's maker for the EDS, the same list as plain text"}));
}

TEST(Eds, AMessageNeverCarriesTheBytesOfADamagedFile) {
  for (const EdsFault& fault : parse_eds("\x1B[31m\x07\n[60\x1B[2J40\n").remarks)
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
  std::string wrong = "[6040]\nDataType=6\n";
  for (int i = 0; i < 3000; ++i) wrong += "wrong\n";
  const Eds odd = parse_eds(wrong);
  EXPECT_THAT(odd.faults, IsEmpty());
  EXPECT_THAT(odd.remarks, SizeIs(kMaxEdsRemarks));
  EXPECT_EQ(odd.remarks_in_all, 3000);
  const Eds long_name = parse_eds("[6040]\nDataType=6\nParameterName=" + std::string(5000, 'x'));
  EXPECT_EQ(the_object(long_name, {0x6040, 0}).type, 6);
  EXPECT_THAT(long_name.remarks, ElementsAre(EdsFault{3, "is longer than 4096 characters: its beginning is taken"}));
}

TEST(Eds, EveryBeginningAndEveryDamageOfAFileIsTakenCalmly) {
  const std::string whole = made_by_hand();
  for (std::size_t size = 0; size < whole.size(); size += 7) static_cast<void>(parse_eds(whole.substr(0, size)));
  std::mt19937 random(306);
  for (int round = 0; round < 300; ++round) {
    std::string damaged = whole;
    for (int i = 0; i < 20; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
    const Eds eds = parse_eds(damaged);
    EXPECT_LE(eds.remarks.size(), kMaxEdsRemarks);
  }
}

}  // namespace
}  // namespace axisgate::profile
