// SPDX-License-Identifier: Apache-2.0
// What `axisgate support` gives away of a configuration, and the list that it shows.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "gateway/commands/support/plan/manifest.hpp"
#include "gateway/commands/support/plan/places.hpp"
#include "gateway/commands/support/plan/redaction.hpp"
#include "gateway/config/config_schema.hpp"

namespace axisgate::commands::support {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

const std::string kRight = R"({
  // Ask Jane Doe, 555-0199, for the password of the panel.
  "modbus_tcp": [{"listen": "0.0.0.0:1502", "allow": [{"from": "192.168.1.20", "role": "operator"}]}],
  "dds": {"qos_file": "keys/pin-0000.xml", "roles": [{"certificate": "/home/jane/hmi.pem", "role": "operator"}]},
  "web": {"hosts": ["press.plant.example"], "insecure": true},
  "buses": [{"name": "lift-serial", "adapter": "kinco-serial", "device": "/dev/axisgate/lift", "drives": [
    {"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": "27.5"}, "axes": [{"axis": 1, "name": "lift"}]}]}]
})";

TEST(SupportRedaction, KeepsWhatHelpsAndNoComment) {
  const Redaction redaction = redact(kRight);
  EXPECT_THAT(redaction.json, Not(HasSubstr("Jane")));
  EXPECT_THAT(redaction.json, AllOf(HasSubstr("192.168.1.20"), HasSubstr("/dev/axisgate/lift"), HasSubstr("27.5")));
  EXPECT_EQ(json::parse(redaction.json)["buses"], json::parse(kRight, nullptr, true, true)["buses"]);
}

TEST(SupportRedaction, LeavesHostsAndFilesOfDdsSecurityOut) {
  const Redaction redaction = redact(kRight);
  for (const char* const secret : {"pin-0000", "jane", "press.plant.example"})
    EXPECT_THAT(redaction.json, Not(HasSubstr(secret)));
  EXPECT_THAT(redaction.left_out, ElementsAre(StartsWith("/dds/qos_file: "), StartsWith("/dds/roles/0/certificate: "),
                                              StartsWith("/web/hosts: ")));
}

TEST(SupportRedaction, LeavesOutWhatIsNoKeyWhateverItHolds) {
  const Redaction redaction = redact(R"({"pasword": "hunter2", "web": {"user": {"name": "jane", "pin": ["0000"]}},
    "buses": [{"name": {"token": "s3cret"}, "baud": 38400, "drives": [{"constants": {"key": "hunter3", "rated_current_a": "10/3"}}]}],
    "modbus_tcp": {"listen": "hunter4"}, "gateway": "hunter5", "dds": {"peers": "hunter6"}})");
  for (const char* const secret : {"hunter", "jane", "0000", "s3cret"})
    EXPECT_THAT(redaction.json, Not(HasSubstr(secret)));
  EXPECT_THAT(redaction.json, AllOf(HasSubstr("38400"), HasSubstr("10/3"), HasSubstr("pasword")));
  EXPECT_EQ(redact("\"hunter2\"").json, "\"(left out)\"\n");
  EXPECT_EQ(redact("[\"hunter2\"]").json, "[\n  \"(left out)\"\n]\n");
}

TEST(SupportRedaction, LeavesOutAllOfATextThatIsNoJson) {
  for (const char* const text :
       {"{\"hosts\": [\"press.example\"],, \"pin\": 1}", "hosts: press.example", "{\"hosts\": 'press.example'}",
        "{\"press.example\": 1, \"press.example\": 2}", "", "{\"hosts\": \"press.example"}) {
    const Redaction redaction = redact(text);
    EXPECT_EQ(redaction.json, "") << text;
    EXPECT_THAT(redaction.why_none, AllOf(StartsWith("it is no JSON"), Not(HasSubstr("press")))) << text;
  }
  EXPECT_THAT(redact("{\n  \"pin\" 1}").why_none, HasSubstr(": line 2, column 8"));
}

TEST(SupportRedaction, TakesTheSameWordsOutOfWhatGoesAlong) {
  const Redaction redaction = redact(R"({"web": {"hosts": ["press", "press.plant"]}, "note": "say \"hunter2\""})");
  EXPECT_EQ(scrubbed("http://press.plant:8080/ and press, not pressure or a-press\n", redaction),
            "http://(left out):8080/ and (left out), not pressure or a-press\n");
  EXPECT_EQ(scrubbed(R"({"detail": "say \"hunter2\""})", redaction), R"j({"detail": "(left out)"})j");
  EXPECT_EQ(scrubbed("/home/jane/gateway.json: x; /home/joe\n", redaction),
            "/home/(user)/gateway.json: x; /home/(user)\n");
  EXPECT_EQ(scrubbed("line 3: invalid literal; last read: '\"pin\": 0000x'\nnext\n", redaction),
            "line 3: invalid literal; last read: (left out)\nnext\n");
}

TEST(SupportRedaction, NamesSoManyPlacesAndNoMore) {
  json many = json::object();
  for (int i = 0; i < 100; ++i) many["key" + std::to_string(i)] = "x";
  const Redaction redaction = redact(many.dump());
  EXPECT_THAT(redaction.left_out, SizeIs(kMostNamed));
  EXPECT_EQ(redaction.left_out.back(), "and 51 more");
}

/// Keys of the schema that take any text.
void free_texts(const json& schema, std::set<std::string>& out) {
  if (!schema.is_structured()) return;
  if (schema.is_object() && schema.contains("properties"))
    for (const auto& [key, below] : schema["properties"].items()) {
      const json& of = below.contains("items") ? below["items"] : below;
      const json type = of.value("type", json());
      const bool takes_text =
          type == "string" || (type.is_array() && std::ranges::find(type, json("string")) != type.end());
      if (takes_text && !of.contains("enum")) out.insert(key);
    }
  for (const json& below : schema) free_texts(below, out);
}

TEST(SupportRedaction, SomebodyHasDecidedAboutEachKeyThatTakesAnyText) {
  std::set<std::string> free;
  free_texts(json::parse(config::gateway_schema_text()), free);
  const std::set<std::string> kept{"$schema", "device", "discovery_servers", "folder", "from",  "interfaces",
                                   "listen",  "motor",  "metres_per_rev",    "name",   "peers", "profile"};
  const std::set<std::string> left_out{"certificate", "hosts", "qos_file"};
  std::set<std::string> decided = kept;
  decided.insert(left_out.begin(), left_out.end());
  EXPECT_EQ(free, decided) << "does it hold a secret? Then it is a row of kPrivate in redaction.cpp";
}

TEST(SupportPlaces, AreFoundInAConfigurationThatIsOnlyNearlyRight) {
  Places places = places_of(redact(kRight).json);
  ASSERT_THAT(places.devices, SizeIs(1));
  EXPECT_EQ(places.devices[0].path, "/dev/axisgate/lift");
  EXPECT_EQ(places.page->host + std::to_string(places.page->port), "127.0.0.18080");
  EXPECT_EQ(places.listener->host + std::to_string(places.listener->port), "127.0.0.11502");
  EXPECT_THAT(places.profiles, ElementsAre("kinco-jd"));
  places = places_of(R"({"web": {"listen": 8080}, "modbus_tcp": [7, {"listen": "plc:1502"}, {"listen": "[::]:1502"}],
    "buses": [{"device": 7}, "x", {"device": "can0"}, {"device": "slcan:/dev/ttyACM0@921600", "drives": {"profile": "a"}}]})");
  EXPECT_EQ(places.page->port, 8080);
  EXPECT_EQ(places.listener->host, "::1");
  ASSERT_THAT(places.devices, SizeIs(2));
  EXPECT_EQ(places.devices[0].interface, "can0");
  EXPECT_EQ(places.devices[1].path, "/dev/ttyACM0");
  EXPECT_EQ(device_of("", "/dev/serial/by-id/usb-x@1").path, "/dev/serial/by-id/usb-x@1");
  for (const char* const text : {"", "[]", "{", "7"}) {
    places = places_of(text);
    EXPECT_TRUE(places.devices.empty() && !places.page && !places.listener) << text;
  }
}

TEST(SupportManifest, SaysWhatIsInItWhatWasTakenOutAndWhatCouldNotBeHad) {
  const Redaction redaction = redact(kRight);
  const auto files = fit({{.file = "configuration.json", .what = "the configuration", .text = redaction.json},
                          {.file = "log.txt", .what = "the log", .text = "http://press.plant.example/ refused\n"},
                          {.file = "page/axes.json", .what = "axes", .why_not = "press.plant.example refuses"}},
                         redaction);
  EXPECT_EQ(files[1].text, "http://(left out)/ refused\n");
  const std::string list = manifest(files, redaction, "2026-11-29T07:20:00Z", "1.2");
  EXPECT_THAT(list, StartsWith("Made by axisgate 1.2 at 2026-11-29T07:20:00Z.\n"));
  EXPECT_THAT(list, HasSubstr("  log.txt                     27 bytes  the log\n"));
  EXPECT_THAT(list, HasSubstr("  /web/hosts: a name of the plant's network\n"));
  EXPECT_THAT(list, EndsWith("\nNot there, or not all of it:\n  page/axes.json       (left out) refuses\n"));
  EXPECT_THAT(list, Not(HasSubstr("axes.json              0")));
}

TEST(SupportManifest, NothingIsLargerThanItMayBe) {
  const std::string line = std::string(99, 'x') + "\n";
  std::string much = "first\n";
  while (much.size() <= kMostOfFile) much += line;
  much += "last\n";
  std::vector<Gathered> files{{.file = "a", .text = much}, {.file = "log", .text = much, .newest_is_last = true}};
  for (int i = 0; i < 4; ++i) files.push_back({.file = "more", .text = much});
  files = fit(files, {});
  EXPECT_THAT(files[0].text, AllOf(StartsWith("first\nx"), EndsWith("x\n"), Not(HasSubstr("last"))));
  EXPECT_THAT(files[1].text, AllOf(StartsWith("xxx"), EndsWith("x\nlast\n"), Not(HasSubstr("first"))));
  EXPECT_THAT(files[1].why_not, HasSubstr("there is room for no more"));
  std::size_t all = 0;
  for (const Gathered& file : files) {
    EXPECT_LE(file.text.size(), kMostOfFile);
    all += file.text.size();
  }
  EXPECT_LE(all, kMostOfAll);
  EXPECT_LT(files.back().text.size(), line.size());
  EXPECT_THAT(files.back().why_not, HasSubstr("are here: there is room for no more"));
  EXPECT_EQ(fit({{.file = "b", .text = line}}, {})[0].why_not, "");
}

}  // namespace
}  // namespace axisgate::commands::support
