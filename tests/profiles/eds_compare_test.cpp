// SPDX-License-Identifier: Apache-2.0
// A profile against an EDS: agreement is silence, and each way to contradict has its own words, with both places.
#include "gateway/profile/eds/eds_compare.hpp"

#include <gmock/gmock.h>

#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using testing::IsEmpty;

/// In `section`, `from` becomes `to`; where no `from` is given, the section is not there.
struct Change {
  std::string section, from, to;
};

struct Case {
  std::string what;
  std::vector<Change> changes;
  std::vector<EdsContradiction> told;
};

const std::vector<Case> kCases{
    {"an object that is not there",
     {{"6041", "", ""}},
     {{"/objects/statusword/at/canopen", "6041", "the EDS has no such object"}}},
    {"a sub-index that is not there",
     {{"6099Sub3", "", ""}},
     {{"/objects/home_at_power_on/at/canopen", "6099sub3", "the EDS has this index, but not this sub-index"}}},
    {"another width",
     {{"6041", "0x0006", "0x0007"}},
     {{"/objects/statusword/type", "6041", "is u16 here, UNSIGNED32 in the EDS"}}},
    {"another sign",
     {{"6098", "0x0002", "0x0005"}},
     {{"/objects/homing_method/type", "6098", "is i8 here, UNSIGNED8 in the EDS"}}},
    {"what is no whole number",
     {{"6041", "0x0006", "0x0008"}, {"6084", "0x0007", "0x0040"}},
     {{"/objects/statusword/type", "6041", "is u16 here, REAL32 in the EDS"},
      {"/objects/profile_deceleration/type", "6084", "is u32 here, type 0x0040 in the EDS"}}},
    {"an object without a type",
     {{"6041", "DataType=0x0006\r\n", ""}},
     {{"/objects/statusword/type", "6041", "has no DataType in the EDS"}}},
    {"an object that the EDS describes in two ways",
     {{"6041", "DataType=0x0006\r\n", "DataType=0x0006\r\nDataType=0x0007\r\n"}},
     {{"/objects/statusword/at/canopen", "6041", "DataType is 0x0006 in line 373, and 0x0007 in another one"}}},
    {"nothing: an object described in two ways that nobody needs",
     {{"1014", "DataType=0x0007\r\n", "DataType=0x0006\r\nDataType=0x0007\r\n"}},
     {}},
    {"what is written and not writable",
     {{"6040", "AccessType=rw", "AccessType=ro"}},
     {{"/objects/controlword/access", "6040", "is written here, ro in the EDS"}}},
    {"what is read and not readable",
     {{"6041", "AccessType=ro", "AccessType=wo"}},
     {{"/objects/statusword/access", "6041", "is read here, wo in the EDS"}}},
    {"nothing: what can be mapped one way only is still writable", {{"6040", "AccessType=rw", "AccessType=rwr"}}, {}},
    {"what is mapped and not mappable",
     {{"606C", "PDOMapping=1", "PDOMapping=0"}},
     {{"/protocols/canopen/tpdo/1/map/0", "606C", "is mapped here, PDOMapping is 0 in the EDS"}}},
    {"what the EDS maps to RPDOs alone",
     {{"606C", "AccessType=ro", "AccessType=rww"}},
     {{"/protocols/canopen/tpdo/1/map/0", "606C", "is mapped to a TPDO here, rww (RPDO only) in the EDS"}}},
    {"a TPDO that is not there",
     {{"1802", "", ""},
      {"1802sub0", "", ""},
      {"1802sub1", "", ""},
      {"1802sub2", "", ""},
      {"1802sub3", "", ""},
      {"1802sub5", "", ""}},
     {{"/protocols/canopen/tpdo/2", "1802", "the EDS has no such TPDO"}}},
    {"an event timer that is not there",
     {{"1800sub5", "", ""}},
     {{"/protocols/canopen/tpdo/0/event_ms", "1800sub5", "the EDS has no such sub-index"}}},
    {"a number that setup writes beyond the limits",
     {{"6040", "PDOMapping", "HighLimit=5\r\nPDOMapping"}},
     {{"/setup/0/value", "6040", "6 is written, the limits are none and 5"}}},
    {"a loss reaction beyond the limits",
     {{"6007", "PDOMapping", "HighLimit=0\r\nPDOMapping"}},
     {{"/protocols/canopen/loss/value", "6007", "1 is written, the limits are none and 0"}}},
};

/// The EDS made by hand, with changes, against the shipped profile.
class EdsComparison : public ::testing::Test {
 protected:
  void apply(const Change& change) {
    const std::size_t at = text_.find("[" + change.section + "]");
    ASSERT_NE(at, std::string::npos) << change.section;
    const std::size_t end = text_.find("\r\n[", at) + 2;
    const std::size_t from = change.from.empty() ? at : text_.find(change.from, at);
    ASSERT_LT(from, end) << "not in this section: " << change.from;
    text_.replace(from, change.from.empty() ? end - at : change.from.size(), change.to);
  }
  [[nodiscard]] std::vector<EdsContradiction> compared() const {
    const Eds eds = parse_eds(text_);
    EXPECT_THAT(eds.faults, IsEmpty());
    return contradictions(loaded_.profile, eds);
  }

  LoadedProfile loaded_ = load_profile(shipped("kinco-md"));
  std::string text_ = test::content(test::source_path("tests/profiles/eds/kinco-md.eds"));
};

TEST_F(EdsComparison, AnEdsThatAgreesIsSilence) {
  for (const EdsContradiction& found : compared())
    ADD_FAILURE() << found.pointer << " [" << found.section << "] " << found.message;
}

TEST_F(EdsComparison, EachContradictionIsToldWithBothPlaces) {
  const std::string agreeing = text_;
  for (const Case& it : kCases) {
    SCOPED_TRACE(it.what);
    text_ = agreeing;
    for (const Change& change : it.changes) apply(change);
    EXPECT_THAT(compared(), testing::UnorderedElementsAreArray(it.told));
  }
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
}  // namespace axisgate::profile
