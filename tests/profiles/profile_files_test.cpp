// SPDX-License-Identifier: Apache-2.0
// Every profile of tests/profiles and schemas/drives is read as a user's would be.
#include <gmock/gmock.h>

#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

namespace fs = std::filesystem;
using test::Mistake;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using ::testing::ValuesIn;

const fs::path kFolder = fs::path(test::source_path("tests/profiles"));

/// Of `folder`, at least `least` of them.
void expect_no_faults(const fs::path& folder, int least) {
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const LoadedProfile loaded = load_profile(entry.path().string());
    if (loaded.base_only) continue;
    EXPECT_EQ(text(loaded.faults), "") << entry.path();
    ++files;
  }
  EXPECT_GE(files, least);
}

TEST(ProfileFiles, TheShippedProfilesHaveNoFault) {
  expect_no_faults(fs::path(test::source_path("schemas/drives")), 5);
}

TEST(ProfileFiles, MadeUpProfilesOfOtherKindsOfDrivesHaveNoFault) { expect_no_faults(kFolder / "valid", 5); }

class ProfileWith : public ::testing::TestWithParam<Mistake> {};

/// A file that has its base's name, as the profile in it. What it extends lies in valid/, and is named where a fault is
/// told of it.
TEST_P(ProfileWith, IsToldInExactlyTheExpectedWords) {
  const test::OwnFolder folder;
  const fs::path file = folder.write(GetParam().base + ".json", GetParam().file);
  std::string told;
  for (const Fault& fault : load_profile(file.string(), {(kFolder / "valid").string()}).faults) {
    const fs::path where(fault.file);
    EXPECT_EQ(where.parent_path(), where == file ? folder.path() : kFolder / "valid");
    if (where != file) told += where.filename().string() + ": ";
    // Where a pointer says the place, it is looked at elsewhere.
    const Fault without{"", fault.pointer, fault.message, fault.pointer.empty() ? fault.place : JsonPlace{}};
    told += text(without).substr(without.place.line > 0 ? 1 : 2) + "\n";
  }
  EXPECT_EQ(told, GetParam().words);
}

const auto kName = [](const auto& info) { return test::as_test_name(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Mistake, ProfileWith, ValuesIn(test::mistakes_of(kFolder)), kName);
INSTANTIATE_TEST_SUITE_P(No_mistake_as, ProfileWith, ValuesIn(test::bases_of(kFolder)), kName);

TEST(ProfileFiles, NoneOfTheMistakesWasLost) {
  EXPECT_GE(test::mistakes_of(kFolder).size(), 203U);
  EXPECT_EQ(test::bases_of(kFolder).size(), 10U);
}

TEST(ProfileFiles, AKeepAliveOfHalfTheWatchdogsTimeIsOftenEnough) {
  std::string profile = test::content(shipped("keya-kydas4860-2e"));
  profile.replace(profile.find("\"every_ms\": 300"), 15, "\"every_ms\": 500");
  const test::OwnFolder folder;
  EXPECT_EQ(text(load_profile(folder.write("keya-kydas4860-2e.json", profile).string()).faults), "");
}

TEST(TableOfMistakes, AnEntryThatProvesNothingIsRefused) {
  const std::pair<std::string, std::string> cases[] = {
      {"a: replace /name \"minimal\"\n  > words", "changes nothing"},
      {"a: replace /nome \"other\"\n  > words", "not found"},
      {"a: rename /name \"other\"\n  > words", "invalid"},
      {"a: text no such text => other\n  > words", "is not in the base exactly once"},
      {"a: text \"object\" => \"objects\"\n  > words", "is not in the base exactly once"},
      {"a: remove /name", "no words for a"},
      {"a: remove /name\nb: remove /title\n  > words", "line 3: b: remove /title: no words for a"},
      {"a: remove /name\n  > words\na: remove /title\n  > words", "is a name that was used"},
      {"a: remove /name\n  > words\nb: remove /name\n  > words", "b is the same file as a"},
      {"a: remove /name\n  > words\n  remove /title", "changes come before the words"},
      {"base none\na: remove /name\n  > words", "there is no such base"},
      {"a remove /name", "is neither a base nor a case"},
  };
  for (const auto& [entry, why] : cases) {
    const std::string table = "base minimal\n" + entry;
    EXPECT_THAT([&] { return test::mistakes(table, kFolder / "valid"); },
                ThrowsMessage<std::runtime_error>(HasSubstr(why)))
        << table;
  }
}

TEST(ProfileFiles, AMissingFileIsAFault) {
  const LoadedProfile loaded = load_profile("/nowhere/kinco-jd.json");
  ASSERT_EQ(loaded.faults.size(), 1U);
  EXPECT_EQ(text(loaded.faults[0]), "/nowhere/kinco-jd.json: cannot be read: No such file or directory");
}

TEST(ProfileFiles, AFolderIsAFault) { EXPECT_EQ(load_profile(test::source_path("schemas")).faults.size(), 1U); }

TEST(ProfileFiles, AreFoundByNameInTheFirstFolderThatHasThemOrByPath) {
  const std::string drives = test::source_path("schemas/drives");
  EXPECT_EQ(find_profile("kinco-jd", {"/nowhere", drives}), drives + "/kinco-jd.json");
  EXPECT_EQ(find_profile("kinco-xx", {drives}), std::nullopt);
  EXPECT_EQ(find_profile(drives + "/kinco-md.json", {}), drives + "/kinco-md.json");
  EXPECT_EQ(find_profile("kinco-md.json", {drives}), std::nullopt) << "a path is not searched for";
}

}  // namespace
}  // namespace axisgate::profile
