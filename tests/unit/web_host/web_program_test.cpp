// SPDX-License-Identifier: Apache-2.0
// What axisgate-web is given on its command line, and the words for its ends.
#include "gateway/upstream/web_host/web_program.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "gateway/upstream/host/restart_plan.hpp"
#include "gateway/upstream/link/exit_codes.hpp"

namespace axisgate::web {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Optional;
using testing::SizeIs;

TEST(WebProgram, IsGivenItsSectionOfTheConfigurationWithAllDefaults) {
  const auto arguments = serve_arguments({}, 3);
  ASSERT_THAT(arguments, SizeIs(3));
  EXPECT_EQ(arguments[0], "serve");
  EXPECT_EQ(arguments[1], "--link-fd=3");
  const std::string option = "--settings=";
  ASSERT_TRUE(arguments[2].starts_with(option));
  EXPECT_EQ(json::parse(arguments[2].substr(option.size())),
            json::parse(R"({"listen": ["127.0.0.1:8080"], "hosts": [], "insecure": false, "allow": ["127.0.0.1/32"],
                            "max_connections": 100, "max_streams": 50, "history_mb": 48,
                            "memory_limit_mb": 128})"));
}

TEST(WebProgram, IsGivenEachSetting) {
  WebSettings settings;
  settings.listen = "[::]:80";
  settings.hosts = {"press.example"};
  settings.insecure = true;
  settings.allow = {"192.168.1.0/24", "fd00::/8"};
  settings.max_connections = 10;
  settings.max_streams = 5;
  settings.memory_limit_mib = 64;
  settings.recorder = R"({"captures": {"keep": 3}, "triggers": []})";
  const std::string text = serve_arguments(settings, 3)[2];
  EXPECT_EQ(json::parse(text.substr(text.find('=') + 1)),
            json::parse(R"({"listen": ["[::]:80"], "hosts": ["press.example"], "insecure": true,
                            "allow": ["192.168.1.0/24", "fd00::/8"], "max_connections": 10, "max_streams": 5,
                            "history_mb": 32, "memory_limit_mb": 64,
                            "captures": {"keep": 3}, "triggers": []})"))
      << "the history has half of the memory at most";
}

TEST(WebProgram, HasWordsOfItsOwnForWhatItCannotServe) {
  host::RestartPlan plan(kProgram);
  EXPECT_THAT(plan.on_end({host::ProcessEnd::How::exited, link::kExitCannotServe}, Instant{}).report,
              Optional(HasSubstr("axisgate-web cannot listen on the address of `web`: it is in use, or needs rights")));
  EXPECT_THAT(plan.on_end({host::ProcessEnd::How::exited, link::kExitNoAddress}, Instant{}).report,
              Optional(std::string("axisgate-web has no such address yet on this computer as `listen` of `web` names; "
                                   "trying again each second")));
}

}  // namespace
}  // namespace axisgate::web
