// Every file of tests/profiles and schemas/drives is read as a user's would be.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/profiles/resolving.hpp"

namespace axisgate::drive {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> json_files(const std::string& folder) {
  std::vector<fs::path> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(AXISGATE_SOURCE_DIR + folder))
    if (entry.path().extension() == ".json") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

std::string content(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

TEST(ProfileFiles, TheShippedProfilesHaveNoFault) {
  const auto files = json_files("/schemas/drives");
  EXPECT_GE(files.size(), 5U);
  for (const fs::path& path : files) EXPECT_EQ(text(load_profile(path.string()).faults), "") << path;
}

TEST(ProfileFiles, MadeUpProfilesOfOtherKindsOfDrivesHaveNoFault) {
  const auto files = json_files("/tests/profiles/valid");
  EXPECT_GE(files.size(), 4U);
  for (const fs::path& path : files) EXPECT_EQ(text(load_profile(path.string()).faults), "") << path;
}

TEST(ProfileFiles, EachMistakeIsToldInTheExpectedWords) {
  const auto files = json_files("/tests/profiles/invalid");
  EXPECT_GE(files.size(), 100U);
  for (const fs::path& path : files) {
    std::string told;
    for (Fault fault : load_profile(path.string()).faults) {
      fault.file = path.filename().string();
      told += text(fault) + "\n";
    }
    fs::path expected = path;
    expected.replace_extension(".expected");
    EXPECT_EQ(told, content(expected)) << path;
    EXPECT_NE(told, "") << path << " was accepted";
  }
}

TEST(ProfileFiles, AMissingFileIsAFault) {
  const LoadedProfile loaded = load_profile("/nowhere/kinco-jd.json");
  ASSERT_EQ(loaded.faults.size(), 1U);
  EXPECT_EQ(text(loaded.faults[0]), "/nowhere/kinco-jd.json: cannot be read: No such file or directory");
}

TEST(ProfileFiles, AFolderIsAFault) { EXPECT_EQ(load_profile(AXISGATE_SOURCE_DIR "/schemas").faults.size(), 1U); }

TEST(ProfileFiles, AreFoundByNameInTheFirstFolderThatHasThemOrByPath) {
  const std::string drives = AXISGATE_SOURCE_DIR "/schemas/drives";
  EXPECT_EQ(find_profile("kinco-jd", {"/nowhere", drives}), drives + "/kinco-jd.json");
  EXPECT_EQ(find_profile("kinco-xx", {drives}), std::nullopt);
  EXPECT_EQ(find_profile(drives + "/kinco-md.json", {}), drives + "/kinco-md.json");
  EXPECT_EQ(find_profile("kinco-md.json", {drives}), std::nullopt) << "a path is not searched for";
}

}  // namespace
}  // namespace axisgate::drive
