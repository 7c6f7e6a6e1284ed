// SPDX-License-Identifier: Apache-2.0
// Where axisgate-dds is looked for, and what it is told on its command line.
#include "gateway/upstream/dds_host/dds_program.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

namespace axisgate::dds {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class WhereItIs : public ::testing::Test {
 protected:
  ~WhereItIs() override { unsetenv("AXISGATE_DDS_PROGRAM"); }
};

TEST_F(WhereItIs, IsWhereTheEnvironmentSays) {
  setenv("AXISGATE_DDS_PROGRAM", "/bin/true", 1);
  EXPECT_EQ(host::find_program(kProgram).path, "/bin/true");
}

TEST_F(WhereItIs, IsNoFolderAndNoFileThatCannotBeRun) {
  for (const char* const wrong : {"/bin", "/etc/passwd", "/nowhere"}) {
    setenv("AXISGATE_DDS_PROGRAM", wrong, 1);
    EXPECT_EQ(host::find_program(kProgram).path, "");
    EXPECT_EQ(host::find_program(kProgram).why_not,
              std::string("AXISGATE_DDS_PROGRAM names ") + wrong + ", which is no program");
  }
}

TEST_F(WhereItIs, IsToldWithWhatToDoWhereItIsNotInstalled) {
  const host::FoundProgram program = host::find_program(kProgram);  // beside this test there is none
  EXPECT_EQ(program.path, "");
  EXPECT_THAT(program.why_not, HasSubstr("/axisgate-dds nor "));
  EXPECT_THAT(program.why_not, HasSubstr("/libexec/axisgate/axisgate-dds; it is built with"));
  EXPECT_THAT(program.why_not, HasSubstr("AXISGATE_DDS=ON"));
}

TEST(CommandLine, NamesTheDefaults) {
  EXPECT_THAT(serve_arguments(DdsSettings{}, 3),
              ElementsAre("serve", "--link-fd=3", "--domain=0", "--interface=lo", "--memory-limit-mib=512"));
}

TEST(CommandLine, NamesEverySetting) {
  DdsSettings settings;
  settings.domain = 7;
  settings.interfaces = {"eth0", "192.168.1.2"};
  settings.shared_memory = true;
  settings.peers = {"192.168.1.5", "192.168.1.6:7410"};
  settings.discovery_servers = {"192.168.1.7:11811"};
  settings.qos_file = "/etc/qos file.xml";
  settings.commands = true;
  settings.roles = {{"/etc/a.pem", Role::operator_}, {"/etc/b.pem", Role::engineer}};
  settings.ros2 = true;
  settings.min_period = std::chrono::milliseconds(20);
  settings.memory_limit_mib = 64;
  EXPECT_THAT(serve_arguments(settings, 3),
              ElementsAre("serve", "--link-fd=3", "--domain=7", "--interface=eth0", "--interface=192.168.1.2",
                          "--shared-memory", "--peer=192.168.1.5", "--peer=192.168.1.6:7410",
                          "--discovery-server=192.168.1.7:11811", "--qos-file=/etc/qos file.xml", "--commands",
                          "--certificate=/etc/a.pem", "--certificate=/etc/b.pem", "--ros2", "--min-period-ms=20",
                          "--memory-limit-mib=64"));
}

}  // namespace
}  // namespace axisgate::dds
