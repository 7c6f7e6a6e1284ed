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
      std::string line = text(fault);
      for (std::size_t at = 0; (at = line.find(here)) != std::string::npos;) line.erase(at, here.size());
      if (fault.file == here + "gateway.json") line.erase(0, std::string("gateway.json: ").size());
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
