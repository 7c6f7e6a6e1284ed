// SPDX-License-Identifier: Apache-2.0
// Each mistake of mistakes.txt causes exactly its words; each file of valid/ and deploy/ is taken.
#include <gmock/gmock.h>

#include "gateway/check/check.hpp"
#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"

namespace axisgate::config {
namespace {

namespace fs = std::filesystem;
using test::Mistake;
using ::testing::Values;
using ::testing::ValuesIn;

const fs::path kFolder = fs::path(test::source_path("tests/config"));
/// Relative, as the tests run in a folder of the sources: messages are the same on every machine.
const std::vector<std::string> kProfiles{"../../../schemas/drives"};

class ConfigWith : public ::testing::TestWithParam<Mistake> {};

TEST_P(ConfigWith, IsToldInExactlyTheExpectedWords) {
  fs::current_path(kFolder / "invalid");
  const test::OwnFolder folder;
  const std::string here = folder.path().string() + "/";
  // A profile's path counts from the configuration; of the name "profiles" there is a folder and no file.
  fs::create_directory_symlink(kFolder / "invalid/profiles", here + "profiles");
  fs::create_directory_symlink(kFolder.parent_path() / "profiles/valid", here + "valid");
  const LoadResult result = load_config(folder.write("gateway.json", GetParam().file).string(), kProfiles);
  std::string told;
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) {
    for (const ConfigFault& fault : *faults) {
      // Where a pointer says the place, line and column are looked at elsewhere.
      ConfigFault shown{fault.file, fault.pointer, fault.message,
                        fault.pointer.empty() ? fault.place : profile::JsonPlace{}};
      const bool own = fault.file == here + "gateway.json";
      if (own) shown.file.clear();
      std::string line = text(shown);
      for (std::size_t at = 0; (at = line.find(here)) != std::string::npos;) line.erase(at, here.size());
      if (own) line.erase(0, shown.place.line > 0 ? 1 : 2);
      told += line + "\n";
    }
  }
  EXPECT_EQ(told, GetParam().words);
}

const auto kName = [](const auto& info) { return test::as_test_name(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Mistake, ConfigWith, ValuesIn(test::mistakes_of(kFolder)), kName);
INSTANTIATE_TEST_SUITE_P(No_mistake_as, ConfigWith, ValuesIn(test::bases_of(kFolder)), kName);

TEST(ConfigFiles, NoneOfTheMistakesWasLost) {
  EXPECT_GE(test::mistakes_of(kFolder).size(), 102U);
  EXPECT_EQ(test::bases_of(kFolder).size(), 6U);
}

const std::string kAsking = R"({"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "buses": [{"name": "lift",
  "adapter": "kinco-serial", "device": "/dev/ttyUSB0",
  "drives": [{"profile": "valid/asking.json", "node": 1, "axes": [{"axis": 1}]}]}]})";

/// Who finds it out beside the machine is only reminded; and what nothing that moves depends on is a remark to anybody.
TEST(OpenQuestions, DoNotKeepWhoLooksForTheAnswerFromTheAxis) {
  const test::OwnFolder folder;
  fs::create_directory_symlink(kFolder.parent_path() / "profiles/valid", folder.path() / "valid");
  const std::string file = folder.write("gateway.json", kAsking).string();
  ASSERT_TRUE(std::holds_alternative<std::vector<ConfigFault>>(load_config(file, kProfiles)));
  const LoadResult allowed = load_config(file, kProfiles, profile::Pipes::refused, OpenAsks::allowed);
  ASSERT_TRUE(std::holds_alternative<LoadedConfig>(allowed));
  const std::vector<std::string>& told = std::get<LoadedConfig>(allowed).warnings;
  const auto of = [&](const std::string& words) { return ::testing::Contains(::testing::HasSubstr(words)).Times(1); };
  EXPECT_THAT(told, of("/ask/0: open question, and no position, no velocity before it is answered: How many"));
  EXPECT_THAT(told, of("/ask/1: open question: Does each write go into the drive's memory? Once you know, write the "
                       "answer at /nvm and take this entry out"));
}

class ValidConfig : public ::testing::TestWithParam<std::string> {};

TEST_P(ValidConfig, IsTakenAndPlannedBelowItsLinesLimit) {
  fs::current_path(kFolder / "valid");
  const LoadResult result = load_config(GetParam(), kProfiles);
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) {
    for (const ConfigFault& fault : *faults) ADD_FAILURE() << text(fault);
    return;
  }
  EXPECT_FALSE(check::report(std::get<LoadedConfig>(result)).overloaded);
}

std::vector<std::string> valid_files() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kFolder / "valid"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

const auto kStem = [](const auto& info) { return test::as_test_name(fs::path(info.param).stem().string()); };
INSTANTIATE_TEST_SUITE_P(Files, ValidConfig, ValuesIn(valid_files()), kStem);
INSTANTIATE_TEST_SUITE_P(Shipped, ValidConfig,
                         Values("../../../deploy/demo.json", "../../../deploy/example/gateway.json"), kStem);

}  // namespace
}  // namespace axisgate::config
