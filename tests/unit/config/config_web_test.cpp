// SPDX-License-Identifier: Apache-2.0
// The section "web": its defaults, who may look and from where, and what is said of it at a start and by check.
#include <gmock/gmock.h>

#include "gateway/check/check_sections.hpp"
#include "tests/unit/config/one_bus.hpp"

namespace axisgate::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Web : public ::testing::Test {
 protected:
  /// `section`: in JSON.
  void load(const std::string& section) {
    const auto file = std::filesystem::temp_directory_path() / ("axisgate-web-" + std::to_string(getpid()) + ".json");
    std::ofstream(file) << R"({"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "gateway": {"name": "cell_7"}, "web": )"
                        << section << R"(, "buses": [{"name": "lift", "adapter": "kinco-serial", "device": "/dev/x",
        "drives": [{"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1}]}]}]})";
    LoadResult result = load_config(file, {test::source_path("schemas/drives")});
    std::filesystem::remove(file);
    if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) {
      for (const ConfigFault& fault : *faults) ADD_FAILURE() << text(fault);
      return;
    }
    loaded = std::move(std::get<LoadedConfig>(result));
    said.clear();
    check::add_lines(said, check::web_lines(settings(), 64));
  }
  [[nodiscard]] const web::WebSettings& settings() const { return loaded.config.web.value(); }
  [[nodiscard]] std::string warnings() const {
    std::string out;
    for (const std::string& each : loaded.warnings) out += each + "\n";
    return out;
  }

  LoadedConfig loaded;
  std::string said;  ///< by check
};

TEST_F(Web, IsThePageOnThisComputerAloneWhereItIsEmpty) {
  load("{}");
  web::WebSettings expected;
  expected.gateway = "cell_7";
  EXPECT_EQ(settings(), expected);
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_EQ(check::web_title(settings()), "Web: http://127.0.0.1:8080/");
  EXPECT_THAT(said, HasSubstr("127.0.0.1/32"));
  EXPECT_THAT(said, Not(HasSubstr("insecure")));
}

TEST_F(Web, TakesEachKey) {
  load(R"({"listen": "192.168.1.10:80", "hosts": ["press", "press.example"], "insecure": true,
           "allow": [{"from": "192.168.1.0/24"}, {"from": "10.0.0.1"}], "sample_ms": 100, "history_mb": 4,
           "max_connections": 7, "max_streams": 3, "memory_limit_mb": 64})");
  EXPECT_EQ(settings().listen, "192.168.1.10:80");
  EXPECT_THAT(settings().hosts, ElementsAre("press", "press.example"));
  EXPECT_THAT(settings().allow, ElementsAre("192.168.1.0/24", "10.0.0.1"));
  EXPECT_EQ(settings().sample_period, std::chrono::milliseconds(100));
  EXPECT_EQ(settings().history_mib, 4U);
  EXPECT_EQ(settings().max_connections, 7U);
  EXPECT_EQ(settings().max_streams, 3U);
  EXPECT_EQ(settings().memory_limit_mib, 64U);
}

TEST_F(Web, SaysHowManySecondsTheHistoryHolds) {
  load("{}");
  EXPECT_THAT(said, HasSubstr("617 s where each of 64 values is another one in each sample"));
  load(R"({"history_mb": 200})");
  EXPECT_THAT(warnings(), HasSubstr("half of memory_limit_mb is the most that the history gets: it has 64 MiB"));
  EXPECT_THAT(said, HasSubstr("822 s where"));
}

TEST_F(Web, HandsOverWhatIsCaptured) {
  load("{}");
  EXPECT_EQ(settings().recorder, "{}");
  load(R"({"captures": {"before_s": 60, "after_s": 0, "keep": 1, "folder": null}, "triggers": [
           {"name": "hard stop", "axis": 1, "quantity": "following_error_rev", "is": "above", "value": 0.2},
           {"name": "a bit", "axis": 1, "quantity": "inputs", "is": "bit_set", "value": 31},
           {"name": "a band", "axis": 1, "quantity": "velocity_rpm", "is": "outside", "min": -10, "max": 10.5},
           {"name": "another", "axis": 1, "quantity": "error_code", "is": "changes"}]})");
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_THAT(settings().recorder, HasSubstr(R"("keep":1)"));
  EXPECT_THAT(settings().recorder, HasSubstr(R"("triggers": [{)"));
}

TEST_F(Web, SaysAtEachStartWhoMayLookWithoutEncryption) {
  load(R"({"listen": "0.0.0.0:8080", "insecure": true, "allow": [{"from": "192.168.1.0/24"}]})");
  EXPECT_THAT(warnings(),
              HasSubstr("/web/insecure: the page at 0.0.0.0:8080 is neither encrypted nor has it passwords: "
                        "it shows all axes to 192.168.1.0/24"));
  EXPECT_THAT(said, HasSubstr("neither encrypted nor with passwords"));
  EXPECT_THAT(said, HasSubstr("192.168.1.0/24"));
}

TEST_F(Web, IsForThisComputerAloneAlsoOnAnotherAddressUntilSomebodyIsAllowed) {
  load(R"({"listen": "0.0.0.0:8080", "insecure": true})");
  EXPECT_THAT(settings().allow, ElementsAre("127.0.0.1/32"));
  EXPECT_THAT(warnings(), HasSubstr("without `allow`, this computer alone may look"));
}

TEST_F(Web, HasTheLoopbackOfItsOwnKind) {
  load(R"({"listen": "[::1]:8080"})");
  EXPECT_THAT(settings().allow, ElementsAre("127.0.0.1/32", "::1/128"));
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST_F(Web, SaysWhatHasNoEffect) {
  load(R"({"insecure": true, "allow": []})");
  EXPECT_THAT(warnings(), HasSubstr("/web/insecure: on the loopback this has no effect"));
  EXPECT_THAT(warnings(), HasSubstr("/web/allow: names nobody, so nobody can look"));
  EXPECT_THAT(said, HasSubstr("nobody"));
}

}  // namespace
}  // namespace axisgate::config
