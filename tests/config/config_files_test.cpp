// Each file in invalid/ causes exactly the lines in the .expected file beside it; each in valid/ and deploy/ is taken.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "gateway/app/check.hpp"

namespace axisgate::app {
namespace {

namespace fs = std::filesystem;
const fs::path kFolder = fs::path(AXISGATE_SOURCE_DIR) / "tests/config";
/// Relative, as the tests run in the folder of their files: messages are the same on every machine.
const std::vector<std::string> kProfiles{"../../../schemas/drives"};

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> json_files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string sentence(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = fs::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

class InvalidConfig : public ::testing::TestWithParam<std::string> {};

TEST_P(InvalidConfig, CausesExactlyTheExpectedLines) {
  fs::current_path(kFolder / "invalid");
  const LoadResult result = load_config(GetParam(), kProfiles);
  const auto* faults = std::get_if<std::vector<ConfigFault>>(&result);
  ASSERT_NE(faults, nullptr) << "taken for right";
  std::string said;
  for (const ConfigFault& fault : *faults) said += text(fault) + "\n";
  EXPECT_EQ(said, content(fs::path(GetParam()).replace_extension(".expected")));
}

INSTANTIATE_TEST_SUITE_P(Files, InvalidConfig, ::testing::ValuesIn(json_files(kFolder / "invalid")), sentence);

class ValidConfig : public ::testing::TestWithParam<std::string> {};

TEST_P(ValidConfig, IsTakenAndPlannedBelowItsLinesLimit) {
  fs::current_path(kFolder / "valid");
  const LoadResult result = load_config(GetParam(), kProfiles);
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) {
    for (const ConfigFault& fault : *faults) ADD_FAILURE() << text(fault);
    return;
  }
  EXPECT_FALSE(check(std::get<LoadedConfig>(result)).overloaded);
}

INSTANTIATE_TEST_SUITE_P(Files, ValidConfig, ::testing::ValuesIn(json_files(kFolder / "valid")), sentence);
INSTANTIATE_TEST_SUITE_P(Shipped, ValidConfig,
                         ::testing::Values("../../../deploy/demo.json", "../../../deploy/example/gateway.json"),
                         sentence);

}  // namespace
}  // namespace axisgate::app
