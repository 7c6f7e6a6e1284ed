// SPDX-License-Identifier: Apache-2.0
// The section "web" as the gateway hands it over.
#include "gateway/upstream/web_process/options.hpp"

#include <gmock/gmock.h>

namespace axisgate::web {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

std::string fault_of(std::string_view json) {
  const auto parsed = parse_settings(json);
  const auto* fault = std::get_if<std::string>(&parsed);
  return fault == nullptr ? "" : *fault;
}

TEST(Settings, AreThisComputerAloneWhereNothingIsSaid) {
  const Settings settings = std::get<Settings>(parse_settings("{}"));
  EXPECT_THAT(settings.listen, ElementsAre("127.0.0.1:8080"));
  EXPECT_TRUE(settings.allow.empty());
  EXPECT_EQ(settings.max_connections, 100U);
  EXPECT_EQ(settings.max_streams, 50U);
  EXPECT_EQ(settings.memory_limit_mb, 128U);
}

TEST(Settings, AreWhatIsSaid) {
  const Settings settings = std::get<Settings>(parse_settings(
      R"({"listen": ["0.0.0.0:80", "[::]:80"], "hosts": ["plant"], "insecure": true, "allow": ["10.0.0.0/8"],
          "max_connections": 10000, "max_streams": 1000, "memory_limit_mb": 4096, "history_mb": 48})"));
  EXPECT_EQ(settings.listen.size(), 2U);
  EXPECT_THAT(settings.hosts, ElementsAre("plant"));
  EXPECT_TRUE(settings.insecure);
  EXPECT_EQ(settings.allow.size(), 1U);
  EXPECT_EQ(settings.max_connections, 10000U);
}

TEST(Settings, NameWhatIsWrong) {
  EXPECT_EQ(fault_of("no json"), "no object");
  EXPECT_THAT(fault_of(R"({"listen": []})"), StartsWith("listen: "));
  EXPECT_THAT(fault_of(R"({"hosts": [1]})"), StartsWith("hosts: "));
  EXPECT_THAT(fault_of(R"({"insecure": 1})"), StartsWith("insecure: "));
  EXPECT_THAT(fault_of(R"({"allow": ["plant"]})"), StartsWith("allow: 'plant'"));
  EXPECT_THAT(fault_of(R"({"max_connections": 0})"), StartsWith("max_connections: "));
  EXPECT_THAT(fault_of(R"({"max_streams": 1001})"), StartsWith("max_streams: "));
  EXPECT_THAT(fault_of(R"({"memory_limit_mb": -1})"), StartsWith("memory_limit_mb: "));
}

}  // namespace
}  // namespace axisgate::web
