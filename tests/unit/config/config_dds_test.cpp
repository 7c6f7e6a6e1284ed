// SPDX-License-Identifier: Apache-2.0
// The section "dds" of a configuration, and what axes say of their units: defaults, values and warnings.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "gateway/config/config_loader.hpp"
#include "gateway/process/descriptor_needs.hpp"
#include "tests/places.hpp"

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::SizeIs;

class ConfigDds : public ::testing::Test {
 protected:
  ~ConfigDds() override { std::filesystem::remove_all(folder_); }

  /// Two axes of one Kinco each; `dds` is the section, `axis` what the first axis says beside its number.
  LoadedConfig load(const std::string& dds, const std::string& axis = "") {
    std::filesystem::create_directory(folder_);
    const std::string file = folder_ + "/gateway.json";
    std::ofstream(file) << R"({"modbus_tcp": [{"listen": "127.0.0.1:1502"}], )" << (dds.empty() ? "" : "\"dds\": ")
                        << dds << (dds.empty() ? "" : ", ")
                        << R"("buses": [{"name": "a", "adapter": "kinco-serial", "device": "/dev/ttyUSB0", "drives": [
      {"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 3)"
                        << axis << R"(}]},
      {"profile": "kinco-jd", "node": 2, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1,
       "units_per_rev": 3600}]}]}]})";
    LoadResult result = load_config(file, {test::source_path("schemas/drives")});
    if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) {
      for (const ConfigFault& fault : *faults) ADD_FAILURE() << text(fault);
      return {};
    }
    return std::move(std::get<LoadedConfig>(result));
  }
  dds::DdsSettings settings(const std::string& dds) {
    const LoadedConfig loaded = load(dds);
    return loaded.config.dds.value_or(dds::DdsSettings{});
  }
  std::vector<std::string> warnings(const std::string& dds, const std::string& axis = "") {
    return load(dds, axis).warnings;
  }

  const std::string folder_ = std::filesystem::temp_directory_path() / ("axisgate-dds-" + std::to_string(getpid()));
};

TEST_F(ConfigDds, IsWhereRos2NodesOfThisMachineLookForIt) {
  EXPECT_TRUE(settings(R"({"ros2": true})").shared_memory);
  EXPECT_FALSE(settings(R"({"ros2": true, "shared_memory": false})").shared_memory);
  EXPECT_FALSE(settings(R"({"ros2": true, "interfaces": ["eth0"]})").shared_memory);
  EXPECT_FALSE(settings("{}").shared_memory);
}

TEST_F(ConfigDds, JudgesAgesOnTheLoopbackAloneUnlessItIsToldOtherwise) {
  EXPECT_THAT(settings("{}").max_age, Optional(milliseconds(500)));
  EXPECT_FALSE(settings(R"({"interfaces": ["eth0"]})").max_age);
  EXPECT_THAT(settings(R"({"interfaces": ["eth0"], "commands": true, "max_age_ms": 70})").max_age,
              Optional(milliseconds(70)));
  EXPECT_FALSE(settings(R"({"commands": true, "max_age_ms": 0})").max_age);
}

TEST_F(ConfigDds, TakesATolerance) {
  EXPECT_EQ(settings("{}").sync_tolerance, 0.01);
  EXPECT_EQ(settings(R"({"ros2": true, "commands": true, "sync_tolerance": 0.05})").sync_tolerance, 0.05);
  EXPECT_THAT(warnings(R"({"ros2": true, "sync_tolerance": 0.05})"),
              ElementsAre(HasSubstr("/dds/sync_tolerance: without \"ros2\" and \"commands\" this has no effect")));
}

TEST_F(ConfigDds, FillsInEveryDefault) {
  const LoadedConfig loaded = load("{}");
  ASSERT_TRUE(loaded.config.dds);
  const dds::DdsSettings& settings = *loaded.config.dds;
  EXPECT_EQ(settings.domain, 0U);
  EXPECT_THAT(settings.interfaces, ElementsAre("lo"));
  EXPECT_FALSE(settings.shared_memory || settings.commands || settings.ros2);
  EXPECT_THAT(settings.peers, IsEmpty());
  EXPECT_THAT(settings.discovery_servers, IsEmpty());
  EXPECT_EQ(settings.qos_file, "");
  EXPECT_EQ(settings.min_period, milliseconds(10));
  EXPECT_EQ(settings.max_period, milliseconds(1000));
  EXPECT_EQ(settings.start_deadline, milliseconds(500));
  EXPECT_EQ(settings.reply_deadline, milliseconds(900));
  EXPECT_EQ(settings.memory_limit_mib, 512U);
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST_F(ConfigDds, TakesEveryKey) {
  std::filesystem::create_directory(folder_);
  std::ofstream(folder_ + "/qos.xml") << "<profiles/>";
  const auto settings = this->settings(
      R"({"domain": 232, "interfaces": ["eth0", "10.0.0.1"], "shared_memory": true, "peers": ["10.0.0.2", "10.0.0.3:7410"],
          "qos_file": "qos.xml", "commands": true, "role": "viewer", "ros2": true, "min_period_ms": 20,
          "max_period_ms": 20, "start_deadline_ms": 100, "reply_deadline_ms": 200, "memory_limit_mb": 64})");
  EXPECT_EQ(settings.domain, 232U);
  EXPECT_THAT(settings.interfaces, ElementsAre("eth0", "10.0.0.1"));
  EXPECT_TRUE(settings.shared_memory && settings.commands && settings.ros2);
  EXPECT_THAT(settings.peers, ElementsAre("10.0.0.2", "10.0.0.3:7410"));
  EXPECT_EQ(settings.qos_file, folder_ + "/qos.xml") << "counts from the configuration file";
  EXPECT_EQ(settings.role, Role::viewer);
  EXPECT_EQ(settings.min_period, milliseconds(20));
  EXPECT_EQ(settings.max_period, milliseconds(20));
  EXPECT_EQ(settings.start_deadline, milliseconds(100));
  EXPECT_EQ(settings.reply_deadline, milliseconds(200));
  EXPECT_EQ(settings.memory_limit_mib, 64U);
  EXPECT_THAT(this->settings(R"({"interfaces": ["eth0"], "discovery_servers": ["10.0.0.2:11811"]})").discovery_servers,
              ElementsAre("10.0.0.2:11811"));
}

TEST_F(ConfigDds, MakesWhoReachesLoopbackAnEngineerAndOthersOperators) {
  EXPECT_EQ(settings(R"({"commands": true})").role, Role::engineer);
  EXPECT_EQ(settings(R"({"commands": true, "interfaces": ["127.0.0.1"]})").role, Role::engineer);
  EXPECT_EQ(settings(R"({"commands": true, "interfaces": ["lo", "eth0"]})").role, Role::operator_);
  EXPECT_EQ(settings(R"({"commands": true, "interfaces": ["eth0"], "role": "engineer"})").role, Role::engineer);
}

TEST_F(ConfigDds, GivesRolesByCertificateAndAllOthersNone) {
  std::filesystem::create_directory(folder_);
  for (const char* const name : {"/qos.xml", "/a.pem", "/b.pem"}) std::ofstream(folder_ + name) << "";
  const std::string roles =
      R"("commands": true, "qos_file": "qos.xml", "roles": [{"certificate": "a.pem", "role": "operator"}, {"certificate": "b.pem", "role": "engineer"}])";
  const auto given = settings("{" + roles + "}");
  EXPECT_THAT(given.roles, ElementsAre(dds::CertificateRole{folder_ + "/a.pem", Role::operator_},
                                       dds::CertificateRole{folder_ + "/b.pem", Role::engineer}));
  EXPECT_EQ(given.role, Role::viewer);
  EXPECT_EQ(settings("{" + roles + R"(, "role": "operator"})").role, Role::operator_);
  EXPECT_THAT(warnings("{" + roles + R"(, "interfaces": ["eth0"]})"), IsEmpty());
}

// For gateway alarm 8.
TEST_F(ConfigDds, TellsWhichFilesItsProcessReadsButThePrivateKey) {
  std::filesystem::create_directory(folder_);
  const auto put = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder_ + name) << text;
    return profile::FileRead{folder_ + name, text};
  };
  const auto value = [&](const std::string& name, const std::string& file) {
    return "<property><name>dds.sec." + name + "</name><value> file://" + folder_ + file + "\n</value></property>";
  };
  const auto qos =
      put("/qos.xml", "<dds>" + value("auth.builtin.PKI-DH.identity_certificate", "/a.pem") +
                          value("auth.builtin.PKI-DH.private_key", "/a.key") +
                          value("access.builtin.Access-Permissions.permissions", "/gone.smime") + "</dds>");
  const auto a = put("/a.pem", "A"), b = put("/b.pem", "B");
  static_cast<void>(put("/a.key", "secret"));
  const LoadedConfig loaded =
      load(R"({"commands": true, "qos_file": "qos.xml", "roles": [{"certificate": "b.pem", "role": "operator"}]})");
  EXPECT_THAT(loaded.config.read_by_dds, ElementsAre(qos, b, a, profile::FileRead{folder_ + "/gone.smime"}));
  EXPECT_THAT(watched_files(loaded.config), SizeIs(loaded.config.read.size() + 4));
  EXPECT_THAT(load("{}").config.read_by_dds, IsEmpty());
}

TEST_F(ConfigDds, KnowsTheUnitsOfEveryAxis) {
  const LoadedConfig loaded = load("{}", R"(, "dds_unit": "m", "metres_per_rev": "0.005")");
  ASSERT_THAT(loaded.config.dds->units, SizeIs(2));
  const auto& metres = loaded.config.dds->units[0];
  EXPECT_EQ(metres.axis, 3);
  EXPECT_EQ(metres.units_per_rev, Rational(10000));
  EXPECT_THAT(metres.metres_per_rev, Optional(Rational(5, 1000)));
  const auto& rad = loaded.config.dds->units[1];
  EXPECT_EQ(rad.axis, 1);
  EXPECT_EQ(rad.units_per_rev, Rational(3600));
  EXPECT_FALSE(rad.metres_per_rev);
}

TEST_F(ConfigDds, WarnsOfALengthThatNobodyUses) {
  EXPECT_THAT(warnings("{}", R"(, "metres_per_rev": 0.005)"),
              ElementsAre(HasSubstr("/buses/0/drives/0/axes/0/metres_per_rev: without \"dds_unit\": \"m\" this has no "
                                    "effect: DDS shows the axis in rad")));
}

TEST_F(ConfigDds, WarnsOfWhatHasNoEffectWithoutCommands) {
  EXPECT_THAT(warnings(R"({"role": "operator", "start_deadline_ms": 100})"),
              ElementsAre(HasSubstr("/dds/role: without \"commands\": true this has no effect"),
                          HasSubstr("/dds/start_deadline_ms: without \"commands\": true")));
}

TEST_F(ConfigDds, WarnsThatEverybodyOnTheNetworkMayCommand) {
  EXPECT_THAT(warnings(R"({"commands": true, "interfaces": ["eth0"]})"),
              ElementsAre(HasSubstr("/dds/commands: DDS has no passwords: every host that reaches eth0 may command all "
                                    "axes as operator")));
  EXPECT_THAT(warnings(R"({"interfaces": ["eth0"]})"), IsEmpty());
}

TEST_F(ConfigDds, WarnsThatAViewerCommandsNothing) {
  EXPECT_THAT(warnings(R"({"commands": true, "role": "viewer"})"),
              ElementsAre(HasSubstr("/dds/role: every request of a DDS client is refused")));
}

TEST_F(ConfigDds, IsCountedInTheNeedForDescriptors) {
  EXPECT_GT(process::descriptor_needs(load("{}").config).reserve(),
            process::descriptor_needs(load("").config).reserve());
}

}  // namespace
}  // namespace axisgate::config
