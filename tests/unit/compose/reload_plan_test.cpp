// SPDX-License-Identifier: Apache-2.0
// What a reload does about each key of the configuration: nothing, a listener, a bus, or it is refused.
#include "gateway/compose/reload_plan.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/config/config_loader.hpp"
#include "tests/places.hpp"

namespace axisgate::compose {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<std::string> kProfiles{test::source_path("schemas/drives")};

const char* const kRunning = R"({
  "modbus_tcp": [
    {"listen": "127.0.0.1:1502", "allow": [{"from": "127.0.0.1", "role": "engineer"}]},
    {"listen": "127.0.0.1:1503"}],
  "dds": {"interfaces": ["lo"], "commands": true, "qos_file": "/etc/passwd",
          "roles": [{"certificate": "/etc/passwd", "role": "operator"}]},
  "web": {"allow": [{"from": "127.0.0.1"}], "captures": {},
          "triggers": [{"name": "hard", "axis": 5, "quantity": "current_a", "is": "above", "value": 2}]},
  "buses": [
    {"name": "serial", "adapter": "kinco-serial", "device": "/dev/ttyUSB0", "drives": [
      {"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5, "rated_current_a": 4.5}, "axes": [{"axis": 1, "lease": {}}]}]},
    {"name": "rtu", "adapter": "modbus-rtu", "device": "/dev/ttyUSB1", "drives": [
      {"profile": "id286pro", "node": 3, "axes": [{"axis": 3}]}]},
    {"name": "can", "adapter": "canopen", "device": "can0", "drives": [
      {"profile": "leadshine-ld2-can", "node": 5, "axes": [{"axis": 5}]}]},
    {"name": "keya", "adapter": "keya-rs232", "device": "/dev/ttyUSB2", "drives": [
      {"profile": "keya-kydas4860-2e", "node": 1, "axes": [{"axis": 7, "motor": "A"}]}]}]
})";

struct Row {
  const char* key;      ///< in the schema; * for a place in a list
  const char* pointer;  ///< in kRunning
  const char* value;    ///< JSON
  const char* does;     ///< the changes, or "nothing", "refused: " and what is named, "wrong"
};

const Row kRows[] = {
    {"/$schema", "/$schema", R"("gateway.schema.json")", "nothing"},
    {"/modbus_tcp/*/listen", "/modbus_tcp/1/listen", R"("127.0.0.1:1504")",
     "listener 127.0.0.1:1504: added, listener 127.0.0.1:1503: removed"},
    {"/modbus_tcp/*/word_order", "/modbus_tcp/1/word_order", R"("low-first")", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/numbers", "/modbus_tcp/1/numbers", R"("float")", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/halves", "/modbus_tcp/1/halves", R"("staged")", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/unit_ids", "/modbus_tcp/1/unit_ids", R"("per-axis")", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/client", "/modbus_tcp/1/client", R"("address")", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/writes", "/modbus_tcp/1/writes", R"("posted")", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/offline_reads", "/modbus_tcp/1/offline_reads", R"("exception")",
     "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/rearm_ms", "/modbus_tcp/1/rearm_ms", "1500", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/start_deadline_ms", "/modbus_tcp/1/start_deadline_ms", "600", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/reply_deadline_ms", "/modbus_tcp/1/reply_deadline_ms", "950", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/allow", "/modbus_tcp/1/allow", R"([{"from": "127.0.0.1", "role": "viewer"}])",
     "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/allow/*/from", "/modbus_tcp/0/allow/0/from", R"("127.0.0.0/8")",
     "listener 127.0.0.1:1502: changed"},
    {"/modbus_tcp/*/allow/*/role", "/modbus_tcp/0/allow/0/role", R"("operator")", "listener 127.0.0.1:1502: changed"},
    {"/modbus_tcp/*/allow/*/rank", "/modbus_tcp/0/allow/0/rank", "3", "listener 127.0.0.1:1502: changed"},
    {"/modbus_tcp/*/max_clients", "/modbus_tcp/1/max_clients", "20", "listener 127.0.0.1:1503: changed"},
    {"/modbus_tcp/*/max_clients_per_address", "/modbus_tcp/1/max_clients_per_address", "10",
     "listener 127.0.0.1:1503: changed"},
    {"/dds/domain", "/dds/domain", "3", "refused: domain"},
    {"/dds/interfaces", "/dds/interfaces", R"(["eth0"])", "refused: interfaces, max_age_ms"},
    {"/dds/shared_memory", "/dds/shared_memory", "true", "refused: shared_memory"},
    {"/dds/peers", "/dds/peers", R"(["127.0.0.1"])", "refused: peers"},
    {"/dds/discovery_servers", "/dds/discovery_servers", R"(["127.0.0.1:11811"])", "refused: discovery_servers"},
    {"/dds/qos_file", "/dds/qos_file", R"("/etc/group")", "refused: qos_file"},
    {"/dds/roles", "/dds/roles", R"([{"certificate": "/etc/group", "role": "viewer"}])", "refused: roles"},
    {"/dds/roles/*/certificate", "/dds/roles/0/certificate", R"("/etc/group")", "refused: roles"},
    {"/dds/roles/*/role", "/dds/roles/0/role", R"("engineer")", "refused: roles"},
    {"/dds/commands", "/dds/commands", "false", "refused: commands"},
    {"/dds/role", "/dds/role", R"("operator")", "refused: role"},
    {"/dds/ros2", "/dds/ros2", "true", "refused: shared_memory, ros2"},
    {"/dds/multicast", "/dds/multicast", "true", "refused: multicast"},
    {"/dds/max_age_ms", "/dds/max_age_ms", "0", "refused: max_age_ms"},
    {"/gateway/name", "/gateway", R"({"name": "cell_7"})", "refused: /gateway/name"},
    {"/dds/min_period_ms", "/dds/min_period_ms", "20", "refused: min_period_ms"},
    {"/dds/sync_tolerance", "/dds/sync_tolerance", "0.02", "refused: sync_tolerance"},
    {"/dds/max_period_ms", "/dds/max_period_ms", "2000", "refused: max_period_ms"},
    {"/dds/start_deadline_ms", "/dds/start_deadline_ms", "600", "refused: start_deadline_ms"},
    {"/dds/reply_deadline_ms", "/dds/reply_deadline_ms", "950", "refused: reply_deadline_ms"},
    {"/dds/memory_limit_mb", "/dds/memory_limit_mb", "600", "refused: memory_limit_mb"},
    {"/web/listen", "/web/listen", R"("127.0.0.1:8081")", "web: changed"},
    {"/web/hosts", "/web/hosts", R"(["press.example"])", "web: changed"},
    {"/web/insecure", "/web/insecure", "true", "web: changed"},
    {"/web/allow/*/from", "/web/allow/0/from", R"("127.0.0.0/8")", "web: changed"},
    {"/web/sample_ms", "/web/sample_ms", "20", "web: changed"},
    {"/web/history_mb", "/web/history_mb", "4", "web: changed"},
    {"/web/max_connections", "/web/max_connections", "10", "web: changed"},
    {"/web/max_streams", "/web/max_streams", "10", "web: changed"},
    {"/web/memory_limit_mb", "/web/memory_limit_mb", "64", "web: changed"},
    {"/web/captures/before_s", "/web/captures/before_s", "3.5", "web: changed"},
    {"/web/captures/after_s", "/web/captures/after_s", "0", "web: changed"},
    {"/web/captures/keep", "/web/captures/keep", "200", "web: changed"},
    {"/web/captures/folder", "/web/captures/folder", R"("/var/lib/axisgate")", "web: changed"},
    {"/web/triggers/*/name", "/web/triggers/0/name", R"("soft")", "web: changed"},
    {"/web/triggers/*/axis", "/web/triggers/0/axis", "3", "web: changed"},
    {"/web/triggers/*/quantity", "/web/triggers/0/quantity", R"("velocity_rpm")", "web: changed"},
    {"/web/triggers/*/is", "/web/triggers/0/is", R"("below")", "web: changed"},
    {"/web/triggers/*/value", "/web/triggers/0/value", "2.5", "web: changed"},
    {"/web/triggers/*/min", "/web/triggers/0",
     R"({"name": "hard", "axis": 5, "quantity": "current_a", "is": "outside", "min": 1, "max": 2})", "web: changed"},
    {"/web/triggers/*/max", "/web/triggers/0",
     R"({"name": "hard", "axis": 5, "quantity": "current_a", "is": "outside", "min": 1, "max": 3})", "web: changed"},
    {"/buses/*/name", "/buses/0/name", R"("serial-2")", "bus serial-2: added, bus serial: removed"},
    {"/buses/*/adapter", "/buses/0/adapter", R"("modbus-rtu")", "bus serial: changed"},
    {"/buses/*/device", "/buses/0/device", R"("/dev/ttyUSB9")", "bus serial: changed"},
    {"/buses/*/baud", "/buses/0/baud", "19200", "bus serial: changed"},
    {"/buses/*/parity", "/buses/1/parity", R"("even")", "bus rtu: changed"},
    {"/buses/*/bitrate", "/buses/2/bitrate", "250000", "bus can: changed"},
    {"/buses/*/rs485", "/buses/0/rs485", R"("off")", "bus serial: changed"},
    {"/buses/*/cascade", "/buses/0/cascade", "true", "bus serial: changed"},
    {"/buses/*/timeout_ms", "/buses/0/timeout_ms", "200", "bus serial: changed"},
    {"/buses/*/min_gap_ms", "/buses/0/min_gap_ms", "3", "bus serial: changed"},
    {"/buses/*/settle_ms", "/buses/0/settle_ms", "70", "bus serial: changed"},
    {"/buses/*/poll/fast", "/buses/0/poll", R"({"fast": 25})", "bus serial: changed"},
    {"/buses/*/poll/normal", "/buses/0/poll", R"({"normal": 150})", "bus serial: changed"},
    {"/buses/*/poll/slow", "/buses/0/poll", R"({"slow": 1500})", "bus serial: changed"},
    {"/buses/*/decode", "/buses/0/decode", "true", "bus serial: changed"},
    {"/buses/*/drives/*/profile", "/buses/0/drives/0/profile", R"("kinco-md")", "bus serial: changed"},
    {"/buses/*/drives/*/node", "/buses/0/drives/0/node", "2", "bus serial: changed"},
    {"/buses/*/drives/*/identity/vendor", "/buses/2/drives/0/identity", R"({"vendor": 16})", "bus can: changed"},
    {"/buses/*/drives/*/identity/product", "/buses/2/drives/0/identity", R"({"product": 16})", "bus can: changed"},
    {"/buses/*/drives/*/identity/revision", "/buses/2/drives/0/identity", R"({"revision": 16})", "bus can: changed"},
    {"/buses/*/drives/*/identity/serial", "/buses/2/drives/0/identity", R"({"serial": 16})", "bus can: changed"},
    {"/buses/*/drives/*/constants", "/buses/0/drives/0/constants/peak_current_a", "30", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/axis", "/buses/0/drives/0/axes/0/axis", "2", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/name", "/buses/0/drives/0/axes/0/name", R"("lift")", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/units_per_rev", "/buses/0/drives/0/axes/0/units_per_rev", "3600", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/units_per_rev/numerator", "/buses/0/drives/0/axes/0/units_per_rev",
     R"({"numerator": 7200, "denominator": 1})", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/units_per_rev/denominator", "/buses/0/drives/0/axes/0/units_per_rev",
     R"({"numerator": 10000, "denominator": 3})", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/direction", "/buses/0/drives/0/axes/0/direction", R"("inverted")",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/limits/position", "/buses/0/drives/0/axes/0/limits", R"({"position": [-10, 10]})",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/limits/velocity", "/buses/0/drives/0/axes/0/limits", R"({"velocity": 1000})",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/limits/acceleration", "/buses/0/drives/0/axes/0/limits", R"({"acceleration": 1000})",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/limits/torque", "/buses/0/drives/0/axes/0/limits", R"({"torque": 500})",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/limits/quick_stop_deceleration_min", "/buses/0/drives/0/axes/0/limits",
     R"({"quick_stop_deceleration_min": 1000})", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/motor", "/buses/3/drives/0/axes/0/motor", R"("B")", "bus keya: changed"},
    {"/buses/*/drives/*/axes/*/vertical", "/buses/0/drives/0/axes/0/vertical", "true", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/lease", "/buses/0/drives/0/axes/0/lease", "null", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/lease/timeout_ms", "/buses/0/drives/0/axes/0/lease/timeout_ms", "3000",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/lease/on_expiry", "/buses/0/drives/0/axes/0/lease/on_expiry", R"("disable")",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/lease/renew", "/buses/0/drives/0/axes/0/lease/renew", R"("write")",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/watch/travel_rev", "/buses/0/drives/0/axes/0/watch/travel_rev", "0.5",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/watch/settle_ms", "/buses/0/drives/0/axes/0/watch/settle_ms", "2000",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/watch/reaction", "/buses/0/drives/0/axes/0/watch/reaction", R"("stop")",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/watch/units", "/buses/0/drives/0/axes/0/watch/units", R"("off")", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/jog_timeout_ms", "/buses/0/drives/0/axes/0/jog_timeout_ms", "400",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/standstill_velocity", "/buses/0/drives/0/axes/0/standstill_velocity", "2000",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/homing_method", "/buses/0/drives/0/axes/0/homing_method", "33", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/homing_timeout_ms", "/buses/0/drives/0/axes/0/homing_timeout_ms", "30000",
     "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/dds_unit", "/buses/0/drives/0/axes/0",
     R"({"axis": 1, "lease": {}, "dds_unit": "m", "metres_per_rev": 0.01})", "bus serial: changed"},
    {"/buses/*/drives/*/axes/*/metres_per_rev", "/buses/0/drives/0/axes/0",
     R"({"axis": 1, "lease": {}, "dds_unit": "m", "metres_per_rev": 0.02})", "bus serial: changed"},
};

class ReloadPlanTest : public ::testing::Test {
 protected:
  ~ReloadPlanTest() override { std::filesystem::remove(path_); }

  /// The faults as text, where there are some.
  std::variant<config::Config, std::string> load(const json& document) {
    std::ofstream(path_) << document;
    config::LoadResult result = config::load_config(path_, kProfiles);
    if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return text(faults->front());
    return std::get<config::LoadedConfig>(result).config;
  }
  config::Config good(const json& document) {
    auto loaded = load(document);
    if (const auto* fault = std::get_if<std::string>(&loaded)) ADD_FAILURE() << *fault;
    return std::holds_alternative<config::Config>(loaded) ? std::get<config::Config>(loaded) : config::Config{};
  }
  static std::string does(const config::Config& before, const config::Config& after) {
    const ReloadPlan plan = plan_reload(before, after);
    // "/dds: domain: it is read when ..."
    if (!plan.refusals.empty())
      return "refused" + plan.refusals.front().substr(4, plan.refusals.front().find(": it is read") - 4);
    std::string out;
    for (const std::string& change : plan.changes) out += (out.empty() ? "" : ", ") + change;
    return out.empty() ? "nothing" : out;
  }

  const json running_ = json::parse(kRunning);
  const std::string path_ =
      std::filesystem::temp_directory_path() / ("axisgate-reload-" + std::to_string(getpid()) + ".json");
};

TEST_F(ReloadPlanTest, EachKeyDoesWhatItsRowSays) {
  const config::Config before = good(running_);
  for (const Row& row : kRows) {
    json document = running_;
    document[json::json_pointer(row.pointer)] = json::parse(row.value);
    const auto wanted = load(document);
    if (std::string_view(row.does) == "wrong") {
      EXPECT_TRUE(std::holds_alternative<std::string>(wanted)) << row.key;
      continue;
    }
    ASSERT_TRUE(std::holds_alternative<config::Config>(wanted)) << row.key << ": " << std::get<std::string>(wanted);
    EXPECT_EQ(does(before, std::get<config::Config>(wanted)), row.does) << row.key;
    EXPECT_EQ(does(std::get<config::Config>(wanted), std::get<config::Config>(wanted)), "nothing") << row.key;
  }
}

/// All keys of the schema that hold no others, or may be left out as a whole.
void gather(const json& schema, const json& part, const std::string& at, std::set<std::string>& keys) {
  if (const auto reference = part.find("$ref"); reference != part.end()) {
    const std::string pointer = reference->get<std::string>().substr(1);
    gather(schema, schema[json::json_pointer(pointer)], at, keys);
  }
  if (const auto properties = part.find("properties"); properties != part.end())
    for (const auto& [key, what] : properties->items()) gather(schema, what, at + "/" + key, keys);
  if (const auto items = part.find("items"); items != part.end() && items->is_object())
    gather(schema, *items, at + "/*", keys);
  for (const char* const which : {"oneOf", "anyOf"})
    if (const auto others = part.find(which); others != part.end())
      for (const json& other : *others) gather(schema, other, at, keys);
  const bool inner = part.contains("properties") || (part.contains("items") && part["items"].contains("properties"));
  if (!inner && !at.empty() && !at.ends_with("*")) keys.insert(at);
}

TEST_F(ReloadPlanTest, NoKeyOfTheSchemaIsWithoutARow) {
  std::ifstream stream(test::source_path("schemas/gateway.schema.json"));
  const json schema = json::parse(stream);
  std::set<std::string> keys;
  gather(schema, schema, "", keys);
  ASSERT_GT(keys.size(), 60U);
  for (const Row& row : kRows) keys.erase(row.key);
  // Lists and tables whose own keys have rows.
  for (const char* const outer : {"/buses", "/modbus_tcp", "/dds", "/web", "/buses/*/drives", "/buses/*/drives/*/axes"})
    keys.erase(outer);
  EXPECT_THAT(keys, IsEmpty());
}

// What stands where is no change, nor is a default that is written out, nor space or a comment.
TEST_F(ReloadPlanTest, AnotherOrderChangesNothing) {
  json wanted = running_;
  std::swap(wanted["buses"][0], wanted["buses"][2]);
  std::swap(wanted["modbus_tcp"][0], wanted["modbus_tcp"][1]);
  wanted["buses"][1]["decode"] = false;
  const ReloadPlan plan = plan_reload(good(running_), good(wanted));
  EXPECT_THAT(plan.kept_buses, ElementsAre(2, 1, 0, 3));
  EXPECT_THAT(plan.kept_listeners, ElementsAre(1, 0));
  EXPECT_THAT(plan.changes, IsEmpty());
  EXPECT_THAT(plan.leaving_buses, IsEmpty());
  EXPECT_THAT(plan.leaving_listeners, IsEmpty());
}

// One more axis in front: the others stay what they are.
TEST_F(ReloadPlanTest, ABusThatIsPutInFrontLeavesTheOthersAlone) {
  json wanted = running_;
  json more = wanted["buses"][0];
  more["name"] = "new";
  more["device"] = "/dev/ttyUSB8";
  more["drives"][0]["axes"][0]["axis"] = 20;
  wanted["buses"].insert(wanted["buses"].begin(), more);
  const ReloadPlan plan = plan_reload(good(running_), good(wanted));
  EXPECT_THAT(plan.kept_buses, ElementsAre(std::nullopt, 0, 1, 2, 3));
  EXPECT_THAT(plan.changes, ElementsAre("bus new: added"));
  EXPECT_THAT(plan.leaving_buses, IsEmpty());
}

// Its profile was edited in place: the section of the bus says the same as before.
TEST_F(ReloadPlanTest, AnEditedProfileChangesItsBuses) {
  const config::Config before = good(running_);
  config::Config after = before;
  after.buses[0].drives[0].profile_text += " ";
  const ReloadPlan plan = plan_reload(before, after);
  EXPECT_THAT(plan.leaving_buses, ElementsAre(0));
  EXPECT_FALSE(before.buses[0].drives[0].profile_text.empty());
}

// Whoever reloads hears what the change was, not only where.
TEST_F(ReloadPlanTest, EachChangedKeyIsToldWithItsValues) {
  json wanted = running_;
  std::swap(wanted["buses"][0], wanted["buses"][2]);
  std::swap(wanted["modbus_tcp"][0], wanted["modbus_tcp"][1]);
  wanted["buses"][2]["drives"][0]["axes"][0]["name"] = "hoist";
  wanted["modbus_tcp"][1]["rearm_ms"] = 2000;
  wanted["web"]["captures"]["keep"] = 5;
  EXPECT_THAT(plan_reload(good(running_), good(wanted)).lines,
              ElementsAre("bus serial: changed", "bus serial: drives/0/axes/0/name (not given) -> \"hoist\"",
                          "listener 127.0.0.1:1502: changed", "listener 127.0.0.1:1502: rearm_ms (not given) -> 2000",
                          "web: changed", "web: captures/keep (not given) -> 5"));
}

TEST_F(ReloadPlanTest, AKeyOfAnEditedProfileIsTold) {
  const config::Config before = good(running_);
  config::Config after = before;
  json profile = json::parse(after.buses[0].drives[0].profile_text);
  profile["title"] = "Another";
  after.buses[0].drives[0].profile_text = profile.dump();
  EXPECT_THAT(plan_reload(before, after).lines,
              ElementsAre("bus serial: changed", testing::AllOf(HasSubstr("bus serial: profile kinco-jd of drives/0: "),
                                                                HasSubstr("title "), HasSubstr(" -> \"Another\""))));
}

TEST_F(ReloadPlanTest, ThePageIsBegunAndEndedByIt) {
  json without = running_;
  without.erase("web");
  EXPECT_EQ(does(good(running_), good(without)), "web: removed");
  EXPECT_EQ(does(good(without), good(running_)), "web: added");
}

TEST_F(ReloadPlanTest, DdsIsNotBegunOrEndedByIt) {
  json without = running_;
  without.erase("dds");
  EXPECT_EQ(does(good(running_), good(without)), "refused: the section is gone");
  EXPECT_EQ(does(good(without), good(running_)), "refused: the section is new");
  EXPECT_THAT(plan_reload(good(running_), good(without)).refusals.front(), HasSubstr("restart the gateway"));
}

}  // namespace
}  // namespace axisgate::compose
