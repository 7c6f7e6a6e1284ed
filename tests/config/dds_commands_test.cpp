// SPDX-License-Identifier: Apache-2.0
// The commands of the real program where DDS is configured: what they say and start, also where axisgate-dds is
// missing.
#include "tests/config/program.hpp"

namespace axisgate::config {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kMissing = "/nowhere/axisgate-dds";

class DdsCommands : public ProgramTest {
 protected:
  [[nodiscard]] std::string config(const std::string& dds) const {
    return write("gateway.json", one_drive((folder() / "device").string(), 1, dds));
  }
  /// `program`: what stands for axisgate-dds.
  [[nodiscard]] Ended run(const std::string& program, const std::string& command) const {
    return run_command("export AXISGATE_DDS_PROGRAM=" + program + "; " + command);
  }

  const std::string axisgate_ = AXISGATE_PROGRAM;
};

TEST_F(DdsCommands, CheckTellsOfDdsAndWhoPublishes) {
  const Ended ended = run("/bin/echo", axisgate_ + " check " + config(R"(, "dds": {"domain": 5})"));
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, HasSubstr("\nDDS: domain 5 on lo\n"));
  EXPECT_THAT(ended.out, HasSubstr("axisgate-dds, which publishes the topics: /bin/echo\n"));
  EXPECT_THAT(ended.out, Not(HasSubstr("not installed")));
}

TEST_F(DdsCommands, CheckWarnsWhereTheProgramIsMissing) {
  const Ended ended = run(kMissing, axisgate_ + " check " + config(R"(, "dds": {})"));
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, HasSubstr("warning: there will be no DDS topics, axisgate-dds is not installed: "
                                   "AXISGATE_DDS_PROGRAM names /nowhere/axisgate-dds"));
}

TEST_F(DdsCommands, CheckIsSilentWithoutDds) {
  EXPECT_THAT(run(kMissing, axisgate_ + " check " + config("")).out, Not(HasSubstr("DDS")));
}

TEST_F(DdsCommands, RunGoesOnWithoutTheProgramAndSaysSo) {
  // It catches SIGTERM (bit 14 of what /proc tells) as the last thing before it serves.
  const Ended ended = run(kMissing, axisgate_ + " run " + config(R"(, "dds": {})") + R"( & pid=$!
      until [ $(( 0x$(sed -n 's/^SigCgt:[[:space:]]*//p' /proc/$pid/status || echo 4000) & 0x4000 )) -ne 0 ]
      do sleep 0.01; done
      kill -TERM $pid; wait $pid)");
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.err, HasSubstr("warning gateway: axisgate-dds is not installed: AXISGATE_DDS_PROGRAM names "));
  EXPECT_THAT(ended.err, HasSubstr("listening on " + listen()));
  EXPECT_THAT(ended.err, HasSubstr("signal 15: ending"));
}

TEST_F(DdsCommands, TopicsListensWhereTheConfigurationSaysThatTheGatewaySpeaks) {
  const std::string file = config(R"(, "dds": {"domain": 5, "interfaces": ["eth0"], "peers": ["10.0.0.2"]})");
  EXPECT_EQ(run("/bin/echo", axisgate_ + " topics " + file).out,
            "topics --domain=5 --interface=eth0 --peer=10.0.0.2 --gateway=\n");
  EXPECT_EQ(
      run("/bin/echo", axisgate_ + " topics --domain 6 --interface eth1 --interface eth2 " + file + " --json").out,
      "topics --domain=6 --interface=eth1 --interface=eth2 --peer=10.0.0.2 --gateway= --json\n");
  EXPECT_EQ(run("/bin/echo", axisgate_ + " topics --once").out, "topics --domain=0 --interface=lo --once\n");
}

TEST_F(DdsCommands, TopicsEndsAsThatProgramEnds) {
  EXPECT_EQ(run("/bin/false", axisgate_ + " topics").code, 1);
  EXPECT_EQ(run("/bin/true", axisgate_ + " topics").code, 0);
}

TEST_F(DdsCommands, TopicsSaysWhatIsMissing) {
  Ended ended = run(kMissing, axisgate_ + " topics");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("axisgate-dds is not installed: "));
  ended = run("/bin/echo", axisgate_ + " topics " + config(""));
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("gateway.json: there is no key \"dds\", so this gateway publishes no topics: add"));
  ended = run("/bin/echo", axisgate_ + " topics --domain 233");
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("--domain"));
}

}  // namespace
}  // namespace axisgate::config
