// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_loader.hpp"
#include "tests/places.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::vector<std::string> kShipped{test::source_path("schemas/drives")};

/// A configuration file that lives as long as the test.
class ConfigLoader : public ::testing::Test {
 protected:
  ~ConfigLoader() override { std::filesystem::remove(path_); }

  LoadResult load(const std::string& text) {
    std::ofstream(path_) << text;
    return load_config(path_, kShipped);
  }
  LoadedConfig load_good(const std::string& text) {
    LoadResult result = load(text);
    if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) {
      for (const ConfigFault& fault : *faults) ADD_FAILURE() << axisgate::config::text(fault);
      return {};
    }
    return std::move(std::get<LoadedConfig>(result));
  }
  std::vector<ConfigFault> load_bad(const std::string& text) {
    LoadResult result = load(text);
    const auto* faults = std::get_if<std::vector<ConfigFault>>(&result);
    if (faults == nullptr) ADD_FAILURE() << "taken for right";
    return faults == nullptr ? std::vector<ConfigFault>{} : *faults;
  }

  /// One Kinco JD; the texts are put into listener, bus, drive and axis.
  static std::string one_drive(const std::string& listener = "", const std::string& bus = "",
                               const std::string& drive = "", const std::string& axis = "") {
    return R"({"modbus_tcp": [{"listen": "127.0.0.1:1502")" + listener +
           R"(}], "buses": [{"name": "lift-serial", "adapter": "kinco-serial", "device": "/dev/ttyUSB0")" + bus +
           R"(, "drives": [{"profile": "kinco-jd", "node": 1, )" + (drive.empty() ? kConstants : drive) +
           R"(, "axes": [{"axis": 1)" + axis + "}]}]}]}";
  }

  static constexpr const char* kConstants = R"("constants": {"encoder_counts_per_rev": 65536, "peak_current_a": 27.5})";
  const std::string path_ =
      std::filesystem::temp_directory_path() / ("axisgate-config-" + std::to_string(getpid()) + ".json");
};

TEST_F(ConfigLoader, FillsInEveryDefault) {
  const LoadedConfig loaded = load_good(one_drive());
  ASSERT_THAT(loaded.config.modbus_tcp, SizeIs(1));
  const auto& listener = loaded.config.modbus_tcp[0];
  EXPECT_EQ(listener.host, "127.0.0.1");
  EXPECT_EQ(listener.port, 1502);
  EXPECT_FALSE(listener.low_word_first || listener.per_axis_units || listener.client_is_address ||
               listener.posted_writes || listener.offline_reads_fail || listener.has_allow || listener.float_numbers ||
               listener.staged_halves);
  EXPECT_EQ(listener.rearm, milliseconds(1000));
  EXPECT_EQ(listener.start_deadline, milliseconds(500));
  EXPECT_EQ(listener.reply_deadline, milliseconds(900));
  EXPECT_EQ(listener.max_clients, 1000U);
  EXPECT_EQ(listener.max_clients_per_address, 64U);

  ASSERT_THAT(loaded.config.buses, SizeIs(1));
  const BusConfig& bus = loaded.config.buses[0];
  EXPECT_EQ(bus.baud, 38400U);
  EXPECT_EQ(bus.parity, "none");
  EXPECT_EQ(bus.rs485, "auto");
  EXPECT_FALSE(bus.cascade || bus.decode);
  EXPECT_EQ(bus.timeout, milliseconds(100));
  EXPECT_EQ(bus.min_gap, Duration{});
  EXPECT_EQ(bus.settle, milliseconds(10));
  EXPECT_THAT(bus.poll, ElementsAre(milliseconds(50), milliseconds(250), milliseconds(2500)));

  const AxisConfig& axis = bus.drives.at(0).axes.at(0);
  EXPECT_EQ(axis.name, "axis 1");
  EXPECT_EQ(axis.units_per_rev, Rational(10000));
  EXPECT_FALSE(axis.inverted);
  EXPECT_EQ(axis.standstill_velocity, 1000);
  EXPECT_EQ(axis.homing_timeout, milliseconds(60000));
  EXPECT_TRUE(axis.lease.on);
  EXPECT_EQ(axis.lease.timeout, milliseconds(2000));
  EXPECT_EQ(axis.lease.on_expiry, LeaseAction::quick_stop);
  EXPECT_EQ(axis.lease.renew, LeaseRenewal::any);
  EXPECT_EQ(axis.jog_timeout, milliseconds(500));
  EXPECT_EQ(axis.watch, model::WatchRules{});
  EXPECT_EQ(axis.motor, "");
  EXPECT_FALSE(axis.vertical);
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST_F(ConfigLoader, ReadsEveryKeyOfAListener) {
  const LoadedConfig loaded = load_good(one_drive(
      R"(, "word_order": "low-first", "numbers": "float", "halves": "staged", "unit_ids": "per-axis", "client": "address", "writes": "posted",
         "offline_reads": "exception", "rearm_ms": 0, "start_deadline_ms": 200, "reply_deadline_ms": 700, "max_clients": 5,
         "max_clients_per_address": 0, "allow": [{"from": "192.168.1.0/24", "role": "operator", "rank": 3},
                                                 {"from": "::1", "role": "engineer"}])"));
  const auto& listener = loaded.config.modbus_tcp.at(0);
  EXPECT_TRUE(listener.low_word_first && listener.per_axis_units && listener.client_is_address &&
              listener.posted_writes && listener.offline_reads_fail && listener.has_allow && listener.float_numbers &&
              listener.staged_halves);
  EXPECT_EQ(listener.rearm, Duration{});
  EXPECT_EQ(listener.start_deadline, milliseconds(200));
  EXPECT_EQ(listener.reply_deadline, milliseconds(700));
  EXPECT_EQ(listener.max_clients, 5U);
  EXPECT_EQ(listener.max_clients_per_address, 0U);
  ASSERT_THAT(listener.allow, SizeIs(2));
  EXPECT_EQ(listener.allow[0].role, Role::operator_);
  EXPECT_EQ(listener.allow[0].prefix, 120);
  EXPECT_EQ(listener.allow[0].rank, 3);
  EXPECT_EQ(listener.allow[1].role, Role::engineer);
  EXPECT_EQ(listener.allow[1].prefix, 128);
}

TEST_F(ConfigLoader, ReadsEveryKeyOfABusAndItsAxis) {
  const LoadedConfig loaded = load_good(one_drive(
      "",
      R"(, "baud": 115200, "parity": "none", "rs485": "off", "cascade": true, "timeout_ms": 50, "min_gap_ms": 1, "settle_ms": 20,
         "poll": {"fast": 30, "slow": 2000}, "decode": true)",
      R"("constants": {"encoder_counts_per_rev": 65536, "peak_current_a": 27.5, "rated_current_a": 4.5})",
      R"(, "name": "lift", "units_per_rev": {"numerator": 60000, "denominator": 37}, "direction": "inverted",
         "limits": {"position": [-1000, 500000], "velocity": 1500000, "acceleration": 20000, "torque": 900,
                    "quick_stop_deceleration_min": 3000},
         "lease": null, "standstill_velocity": 2000, "homing_timeout_ms": 90000)"));
  const BusConfig& bus = loaded.config.buses.at(0);
  EXPECT_EQ(bus.baud, 115200U);
  EXPECT_EQ(bus.rs485, "off");
  EXPECT_TRUE(bus.cascade && bus.decode);
  EXPECT_EQ(bus.timeout, milliseconds(50));
  EXPECT_EQ(bus.min_gap, milliseconds(1));
  EXPECT_EQ(bus.settle, milliseconds(20));
  EXPECT_THAT(bus.poll, ElementsAre(milliseconds(30), milliseconds(250), milliseconds(2000)));
  const AxisConfig& axis = bus.drives.at(0).axes.at(0);
  EXPECT_EQ(axis.name, "lift");
  EXPECT_EQ(axis.units_per_rev, Rational(60000, 37));
  EXPECT_TRUE(axis.inverted);
  EXPECT_EQ(axis.limits.position, (Range{-1000, 500000}));
  EXPECT_EQ(axis.limits.velocity, 1500000);
  EXPECT_EQ(axis.limits.acceleration, 20000);
  EXPECT_EQ(axis.limits.torque, 900);
  EXPECT_EQ(axis.limits.quick_stop_deceleration_min, 3000);
  EXPECT_FALSE(axis.lease.on);
  EXPECT_EQ(axis.standstill_velocity, 2000);
  EXPECT_EQ(axis.homing_timeout, milliseconds(90000));
}

TEST_F(ConfigLoader, HandsTheLeaseAndTheJogTimeToTheDrive) {
  const LoadedConfig loaded = load_good(one_drive("", "", "", R"(, "vertical": true, "jog_timeout_ms": 250,
    "lease": {"timeout_ms": 750, "on_expiry": "none", "renew": "write"})"));
  EXPECT_TRUE(loaded.config.buses.at(0).drives.at(0).axes.at(0).vertical);
  const model::AxisModel& axis = loaded.models.at(0).at(0).axes.at(0);
  EXPECT_TRUE(axis.lease.on);
  EXPECT_EQ(axis.lease.timeout, milliseconds(750));
  EXPECT_EQ(axis.lease.on_expiry, LeaseAction::none);
  EXPECT_EQ(axis.lease.renew, LeaseRenewal::write);
  EXPECT_EQ(axis.jog_timeout, milliseconds(250));
}

TEST_F(ConfigLoader, HandsTheWatchToTheDrive) {
  const auto watched = [this](const std::string& watch) {
    return load_good(one_drive("", "", "", R"(, "watch": )" + watch)).models.at(0).at(0).axes.at(0);
  };
  const model::AxisModel axis =
      watched(R"({"travel_rev": 0.25, "settle_ms": 2000, "reaction": "stop", "units": "off"})");
  EXPECT_EQ(axis.watch.travel, Rational(1, 4));
  EXPECT_EQ(axis.watch.settle, milliseconds(2000));
  EXPECT_EQ(axis.watch.reaction, model::WatchReaction::stop);
  EXPECT_FALSE(axis.watch.units);
  EXPECT_FALSE(axis.position_commanded);
  model::WatchRules rules;
  EXPECT_EQ(watched("{}").watch, rules);
  rules.reaction = model::WatchReaction::off;
  EXPECT_EQ(watched(R"({"reaction": "off", "units": "on"})").watch, rules);
}

TEST_F(ConfigLoader, AKeyThatALeaseDoesNotNameHasItsDefault) {
  const LoadedConfig loaded = load_good(one_drive("", "", "", R"(, "lease": {"renew": "heartbeat"})"));
  const LeaseRules& lease = loaded.models.at(0).at(0).axes.at(0).lease;
  EXPECT_EQ(lease.renew, LeaseRenewal::heartbeat);
  EXPECT_EQ(lease.timeout, milliseconds(2000));
  EXPECT_EQ(lease.on_expiry, LeaseAction::quick_stop);
}

TEST_F(ConfigLoader, KeepsConstantsExactly) {
  const LoadedConfig loaded =
      load_good(one_drive("", "", R"("constants": {"encoder_counts_per_rev": 65536, "peak_current_a": "27.55"})"));
  const auto& constants = loaded.config.buses.at(0).drives.at(0).constants;
  EXPECT_EQ(constants.at("peak_current_a"), Rational(551, 20));
  EXPECT_EQ(constants.at("encoder_counts_per_rev"), Rational(65536));
}

TEST_F(ConfigLoader, KeepsWhatItHasReadAndWhereItLookedInVain) {
  const auto text_of = [](const std::string& file) {
    std::ifstream stream(file);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const std::string own = path_ + ".folder";  // that nobody has
  const std::string shipped = kShipped.front() + "/";
  std::ofstream(path_) << one_drive("", "");
  const LoadResult loaded = load_config(path_, {own, kShipped.front()});
  std::vector<profile::FileRead> expected{{path_, one_drive("", "")}, {own + "/kinco-jd.json"}};
  for (const char* file : {"kinco-jd.json", "kinco.json", "cia402.json"})
    expected.push_back({shipped + file, text_of(shipped + file)});
  EXPECT_EQ(std::get<LoadedConfig>(loaded).config.read, expected);
}

TEST_F(ConfigLoader, WarnsWithoutRefusing) {
  const LoadedConfig loaded = load_good(one_drive(
      "", R"(, "baud": 57600)", "", R"(, "jog_timeout_ms": 300, "dds_unit": "m", "metres_per_rev": "0.005")"));
  ASSERT_THAT(loaded.warnings, SizeIs(1)) << "check shows metres without DDS too";
  EXPECT_THAT(loaded.warnings[0], HasSubstr("/buses/0/baud: 57600 is not among the rates of Kinco drives"));
}

TEST_F(ConfigLoader, WarnsOfAListenerThatIsOpenToNobodyOrToEverybodyAsEngineer) {
  const auto warnings = [&](const std::string& allow, bool reached = true) {
    std::string file = one_drive(R"(, "allow": )" + allow);
    if (reached) file.replace(file.find("127.0.0.1"), 9, "0.0.0.0");
    return load_good(file).warnings;
  };
  const auto nobody = ElementsAre(HasSubstr("/modbus_tcp/0/allow: names nobody, so nobody can connect"));
  EXPECT_THAT(warnings("[]"), nobody);
  EXPECT_THAT(warnings("[]", false), nobody);
  const auto all =
      ElementsAre(HasSubstr("/modbus_tcp/0/allow/0/role: every host that reaches this address is engineer"));
  EXPECT_THAT(warnings(R"([{"from": "0.0.0.0/0", "role": "engineer"}])"), all);
  EXPECT_THAT(warnings(R"([{"from": "::/0", "role": "engineer"}])"), all);
  EXPECT_THAT(warnings(R"([{"from": "0.0.0.0/0", "role": "engineer"}])", false), IsEmpty());
  EXPECT_THAT(warnings(R"([{"from": "0.0.0.0/0", "role": "operator"}])"), IsEmpty());
  EXPECT_THAT(warnings(R"([{"from": "fd00::/96", "role": "engineer"}])"), IsEmpty());
}

TEST_F(ConfigLoader, ToldOfAFileThatIsNotThereNamesIt) {
  const LoadResult result = load_config("/nowhere/gateway.json", kShipped);
  const auto& faults = std::get<std::vector<ConfigFault>>(result);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_THAT(text(faults[0]), HasSubstr("/nowhere/gateway.json: cannot be read: No such file or directory"));
}

// The power went while somebody saved it: no beginning of a good file is a file.
TEST_F(ConfigLoader, NoHalfOfAFileIsTaken) {
  const std::string whole = one_drive();
  ASSERT_EQ(whole.find_last_not_of(" \n"), whole.rfind('}'));
  for (std::size_t size = 0; size < whole.rfind('}') + 1; ++size)
    EXPECT_THAT(load_bad(whole.substr(0, size)), Not(IsEmpty())) << size;
}

TEST_F(ConfigLoader, NothingThatJsonCanSayEndsItByException) {
  for (
      const char* wrong :
      {"", "[]", "null", "1", "\"text\"", "{}", R"({"buses": null})", R"({"buses": [null]})", R"({"buses": [{}]})",
       R"({"buses": {"a": 1}})", R"({"buses": [{"name": 1, "adapter": [], "device": {}, "drives": 3}]})",
       R"({"buses": [{"adapter": "kinco-serial", "baud": 0, "timeout_ms": -1, "poll": 7, "drives": [[], {"axes": [{"axis": -1}]}]}]})",
       R"({"buses": [{"adapter": "kinco-serial", "baud": 99999999999999999999, "drives": [{"node": 1e99, "constants": {"x": null}}]}]})",
       R"({"modbus_tcp": [{"listen": 5, "allow": [{"from": 1}, null]}, 9], "buses": []})",
       R"({"modbus_tcp": {"listen": "x"}, "dds": 1, "web": [], "buses": [{"drives": [{"axes": [{"axis": 1, "limits": {"position": ["a", 2]},
            "units_per_rev": {"numerator": 0}, "lease": {"on_expiry": 5}, "homing_method": 1e300}]}]}]})"}) {
    EXPECT_THAT(load_bad(wrong), Not(IsEmpty())) << wrong;
  }
}

}  // namespace
}  // namespace axisgate::config
