// A profile against an EDS: agreement is silence, and each way to contradict has its own words, with both places.
#include "gateway/drive/eds_compare.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/profiles/resolving.hpp"

namespace axisgate::drive {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

/// The EDS made by hand, with changes, against the shipped profile.
class EdsComparison : public ::testing::Test {
 protected:
  /// Inside one section.
  void change(const std::string& section, const std::string& from, const std::string& to) {
    const std::size_t at = text_.find("[" + section + "]");
    ASSERT_NE(at, std::string::npos) << section;
    const std::size_t found = text_.find(from, at);
    ASSERT_LT(found, text_.find("\r\n[", at + 1)) << "not in this section: " << from;
    text_.replace(found, from.size(), to);
  }
  void remove(const std::string& section) {
    const std::size_t at = text_.find("[" + section + "]");
    ASSERT_NE(at, std::string::npos) << section;
    text_.erase(at, text_.find("\r\n[", at) + 2 - at);
  }
  [[nodiscard]] std::vector<EdsContradiction> compared() const {
    const Eds eds = parse_eds(text_);
    EXPECT_THAT(eds.faults, IsEmpty());
    return contradictions(loaded_.profile, eds);
  }

  LoadedProfile loaded_ = load_profile(shipped("kinco-md"));
  std::string text_ = [] {
    std::ostringstream text;
    text << std::ifstream(AXISGATE_SOURCE_DIR "/tests/profiles/eds/kinco-md.eds", std::ios::binary).rdbuf();
    return text.str();
  }();
};

TEST_F(EdsComparison, AnEdsThatAgreesIsSilence) {
  for (const EdsContradiction& found : compared())
    ADD_FAILURE() << found.pointer << " [" << found.section << "] " << found.message;
}

TEST_F(EdsComparison, AnObjectThatIsNotThere) {
  remove("6041");
  EXPECT_THAT(compared(),
              ElementsAre(EdsContradiction{"/objects/statusword/at/canopen", "6041", "the EDS has no such object"}));
}

TEST_F(EdsComparison, ASubIndexThatIsNotThere) {
  remove("6099Sub3");
  EXPECT_THAT(compared(), ElementsAre(EdsContradiction{"/objects/home_at_power_on/at/canopen", "6099sub3",
                                                       "the EDS has this index, but not this sub-index"}));
}

TEST_F(EdsComparison, AnotherWidth) {
  change("6041", "0x0006", "0x0007");
  EXPECT_THAT(compared(),
              ElementsAre(EdsContradiction{"/objects/statusword/type", "6041", "is u16 here, UNSIGNED32 in the EDS"}));
}

TEST_F(EdsComparison, AnotherSign) {
  change("6098", "0x0002", "0x0005");
  EXPECT_THAT(compared(),
              Contains(EdsContradiction{"/objects/homing_method/type", "6098", "is i8 here, UNSIGNED8 in the EDS"}));
}

TEST_F(EdsComparison, WhatIsNoWholeNumber) {
  change("6041", "0x0006", "0x0008");
  change("6084", "0x0007", "0x0040");
  EXPECT_THAT(compared(), testing::UnorderedElementsAre(
                              EdsContradiction{"/objects/statusword/type", "6041", "is u16 here, REAL32 in the EDS"},
                              EdsContradiction{"/objects/profile_deceleration/type", "6084",
                                               "is u32 here, type 0x0040 in the EDS"}));
}

TEST_F(EdsComparison, AnEdsWithoutATypeSaysSo) {
  change("6041", "DataType=0x0006\r\n", "");
  EXPECT_THAT(compared(),
              ElementsAre(EdsContradiction{"/objects/statusword/type", "6041", "has no DataType in the EDS"}));
}

TEST_F(EdsComparison, WhatIsWrittenMustBeWritable) {
  change("6040", "AccessType=rw", "AccessType=ro");
  EXPECT_THAT(compared(),
              ElementsAre(EdsContradiction{"/objects/controlword/access", "6040", "is written here, ro in the EDS"}));
}

TEST_F(EdsComparison, WhatIsReadMustBeReadable) {
  change("6041", "AccessType=ro", "AccessType=wo");
  EXPECT_THAT(compared(),
              ElementsAre(EdsContradiction{"/objects/statusword/access", "6041", "is read here, wo in the EDS"}));
}

TEST_F(EdsComparison, WhatCanBeMappedOneWayOnlyIsStillWritable) {
  change("6040", "AccessType=rw", "AccessType=rwr");
  EXPECT_THAT(compared(), IsEmpty());
}

TEST_F(EdsComparison, WhatIsMappedMustBeMappable) {
  change("606C", "PDOMapping=1", "PDOMapping=0");
  EXPECT_THAT(compared(), ElementsAre(EdsContradiction{"/protocols/canopen/tpdo/1/map/0", "606C",
                                                       "is mapped here, PDOMapping is 0 in the EDS"}));
}

TEST_F(EdsComparison, ATpdoThatIsNotThere) {
  for (const std::string sub : {"", "sub0", "sub1", "sub2", "sub3", "sub5"}) remove("1802" + sub);
  EXPECT_THAT(compared(),
              ElementsAre(EdsContradiction{"/protocols/canopen/tpdo/2", "1802", "the EDS has no such TPDO"}));
}

TEST_F(EdsComparison, AnEventTimerThatIsNotThere) {
  remove("1800sub5");
  EXPECT_THAT(compared(), ElementsAre(EdsContradiction{"/protocols/canopen/tpdo/0/event_ms", "1800sub5",
                                                       "the EDS has no such sub-index"}));
}

TEST_F(EdsComparison, ANumberThatSetupWritesBeyondTheLimits) {
  change("6040", "PDOMapping", "HighLimit=5\r\nPDOMapping");
  EXPECT_THAT(compared(),
              ElementsAre(EdsContradiction{"/setup/0/value", "6040", "6 is written, the limits are none and 5"}));
}

TEST_F(EdsComparison, ALossReactionBeyondTheLimits) {
  change("6007", "PDOMapping", "HighLimit=0\r\nPDOMapping");
  EXPECT_THAT(compared(), ElementsAre(EdsContradiction{"/protocols/canopen/loss/value", "6007",
                                                       "1 is written, the limits are none and 0"}));
}

TEST_F(EdsComparison, ARangeThatReachesBeyondTheLimits) {
  loaded_ = load_profile(shipped("kinco-jd"));
  text_ = "[60FF]\nDataType=4\nAccessType=rw\nLowLimit=-1000\nHighLimit=0x1000\n";
  EXPECT_THAT(compared(),
              testing::IsSupersetOf(
                  {EdsContradiction{"/objects/target_velocity/range", "60FF", "begins at -16777215, LowLimit is -1000"},
                   EdsContradiction{"/objects/target_velocity/range", "60FF", "ends at 16777215, HighLimit is 4096"}}));
}

TEST_F(EdsComparison, AWidthThatNobodyPrintedAgreesWithAnyThatIsNotWider) {
  loaded_ = load_profile(shipped("leadshine-ld2-can"));
  const auto about_2008 = [&](const std::string& type) {
    text_ = "[2008]\nDataType=" + type + "\nAccessType=rw\n";
    std::vector<EdsContradiction> found = compared();
    std::erase_if(found, [](const EdsContradiction& one) { return one.section != "2008"; });
    return found;
  };
  EXPECT_THAT(about_2008("6"), IsEmpty());
  EXPECT_THAT(about_2008("7"), IsEmpty());
  EXPECT_THAT(about_2008("4"), testing::SizeIs(1)) << "a sign is another matter";
}

TEST_F(EdsComparison, ObjectsOfOtherProtocolsAreNoneOfItsBusiness) {
  loaded_ = load_profile(shipped("id286pro"));
  EXPECT_THAT(compared(), IsEmpty());
}

}  // namespace
}  // namespace axisgate::drive
