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
          "max_connections": 10000, "max_streams": 1000, "memory_limit_mb": 4096, "history_mb": 1024})"));
  EXPECT_EQ(settings.listen.size(), 2U);
  EXPECT_THAT(settings.hosts, ElementsAre("plant"));
  EXPECT_TRUE(settings.insecure);
  EXPECT_EQ(settings.allow.size(), 1U);
  EXPECT_EQ(settings.max_connections, 10000U);
  EXPECT_EQ(settings.history_mb, 1024U);
}

TEST(Settings, NameWhatIsWrong) {
  EXPECT_EQ(fault_of("no json"), "no object");
  EXPECT_THAT(fault_of(R"({"listen": []})"), StartsWith("listen: "));
  EXPECT_THAT(fault_of(R"({"hosts": [1]})"), StartsWith("hosts: "));
  EXPECT_THAT(fault_of(R"({"insecure": 1})"), StartsWith("insecure: "));
  EXPECT_THAT(fault_of(R"({"allow": ["plant"]})"), StartsWith("allow: 'plant'"));
  EXPECT_THAT(fault_of(R"({"max_connections": 0})"), StartsWith("max_connections: "));
  EXPECT_THAT(fault_of(R"({"max_streams": 1001})"), StartsWith("max_streams: "));
  EXPECT_THAT(fault_of(R"({"history_mb": 3})"), StartsWith("history_mb: "));
  EXPECT_THAT(fault_of(R"({"memory_limit_mb": -1})"), StartsWith("memory_limit_mb: "));
}

CaptureSettings captures_of(std::string_view json) { return std::get<CaptureSettings>(parse_captures(json)); }

std::string capture_fault_of(std::string_view json) {
  const auto parsed = parse_captures(json);
  const auto* fault = std::get_if<std::string>(&parsed);
  return fault == nullptr ? "" : *fault;
}

TEST(Settings, OfCapturesAreTenSecondsBeforeAndFiveBehind) {
  const CaptureSettings settings = captures_of("{}");
  EXPECT_EQ(settings.before, 10 * kSecond);
  EXPECT_EQ(settings.after, 5 * kSecond);
  EXPECT_EQ(settings.keep, 20U);
  EXPECT_EQ(settings.folder, "");
  EXPECT_TRUE(settings.triggers.empty());
  EXPECT_EQ(captures_of(R"({"captures": {"folder": null}})").folder, "");
}

TEST(Settings, OfCapturesAreWhatIsSaid) {
  const CaptureSettings settings = captures_of(
      R"({"captures": {"before_s": 0.5, "after_s": 60, "keep": 200, "folder": "/var/lib/axisgate/captures"},
          "triggers": [{"name": "hard stop", "axis": 7, "quantity": "following_error_rev", "is": "above", "value": 0.2},
                       {"name": "a bit", "axis": 1, "quantity": "inputs", "is": "bit_clear", "value": 31},
                       {"name": "a band", "axis": 1, "quantity": "mode", "is": "outside", "min": -1, "max": 2.5},
                       {"name": "low", "axis": 1, "quantity": "velocity_rpm", "is": "below", "value": -3}]})");
  EXPECT_EQ(settings.before, kSecond / 2);
  EXPECT_EQ(settings.after, 60 * kSecond);
  EXPECT_EQ(settings.keep, 200U);
  EXPECT_EQ(settings.folder, "/var/lib/axisgate/captures");
  ASSERT_EQ(settings.triggers.size(), 4U);
  EXPECT_EQ(settings.triggers[0].axis, 7U);
  EXPECT_EQ(settings.triggers[0].max, 0.2);
  EXPECT_EQ(settings.triggers[0].quantity, Quantity::following_error);
  EXPECT_EQ(settings.triggers[1].is, TriggerIs::bit_clear);
  EXPECT_EQ(settings.triggers[1].bit, 31U);
  EXPECT_EQ(settings.triggers[2].min, -1);
  EXPECT_EQ(settings.triggers[2].max, 2.5);
  EXPECT_EQ(settings.triggers[2].quantity, Quantity::mode_display);
  EXPECT_EQ(settings.triggers[3].min, -3);
}

TEST(Settings, OfCapturesNameWhatIsWrong) {
  EXPECT_THAT(capture_fault_of("[]"), StartsWith("no object"));
  EXPECT_THAT(capture_fault_of(R"({"captures": []})"), StartsWith("captures, triggers: "));
  EXPECT_THAT(capture_fault_of(R"({"captures": {"before_s": 61}})"), StartsWith("before_s: a number from 0 to 60"));
  EXPECT_THAT(capture_fault_of(R"({"captures": {"after_s": "5"}})"), StartsWith("after_s: "));
  EXPECT_THAT(capture_fault_of(R"({"captures": {"keep": 0}})"), StartsWith("keep: "));
  EXPECT_THAT(capture_fault_of(R"({"captures": {"folder": 1}})"), StartsWith("folder: "));
  EXPECT_THAT(capture_fault_of(R"({"triggers": [1]})"), StartsWith("name: "));
  EXPECT_THAT(capture_fault_of(R"({"triggers": [{"name": "n", "axis": 1, "quantity": "speed", "is": "above"}]})"),
              StartsWith("triggers: 'n' is none"));
  EXPECT_THAT(capture_fault_of(
                  R"({"triggers": [{"name": "n", "axis": 1, "quantity": "inputs", "is": "bit_set", "value": 32}]})"),
              StartsWith("value: "));
}

}  // namespace
}  // namespace axisgate::web
