// The commands of the real program where DDS is configured: what they say and start, also where axisgate-dds is
// missing.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace axisgate::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kMissing = "/nowhere/axisgate-dds";

class DdsCommands : public ::testing::Test {
 protected:
  DdsCommands() {
    std::string name = (fs::temp_directory_path() / "axisgate-dds-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~DdsCommands() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string config(const std::string& dds) const {
    const fs::path file = folder_ / "gateway.json";
    std::ofstream(file) << R"({"modbus_tcp": [{"listen": "127.0.0.1:15989"}], )" << dds
                        << R"("buses": [{"name": "a", "adapter": "kinco-serial", "device": ")"
                        << (folder_ / "device").string()
                        << R"(", "drives": [{"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5},
      "axes": [{"axis": 1}]}]}]})";
    return file.string();
  }

  struct Ended {
    int code = -1;
    std::string out;
    std::string err;
  };
  /// `program`: what stands for axisgate-dds.
  [[nodiscard]] Ended run(const std::string& program, const std::string& arguments) const {
    const std::string out = (folder_ / "out").string();
    const std::string err = (folder_ / "err").string();
    const int status = std::system(
        ("AXISGATE_DDS_PROGRAM=" + program + " " + arguments + " >" + out + " 2>" + err + " </dev/null").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
  }
  static std::string content(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  const std::string axisgate_ = AXISGATE_PROGRAM;
  fs::path folder_;
};

TEST_F(DdsCommands, CheckTellsOfDdsAndWhoPublishes) {
  const Ended ended = run("/bin/echo", axisgate_ + " check " + config(R"("dds": {"domain": 5}, )"));
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, HasSubstr("\nDDS: domain 5 on lo\n"));
  EXPECT_THAT(ended.out, HasSubstr("axisgate-dds, which publishes the topics: /bin/echo\n"));
  EXPECT_THAT(ended.out, Not(HasSubstr("not installed")));
}

TEST_F(DdsCommands, CheckWarnsWhereTheProgramIsMissing) {
  const Ended ended = run(kMissing, axisgate_ + " check " + config(R"("dds": {}, )"));
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, HasSubstr("warning: there will be no DDS topics, axisgate-dds is not installed: "
                                   "AXISGATE_DDS_PROGRAM names /nowhere/axisgate-dds"));
}

TEST_F(DdsCommands, CheckIsSilentWithoutDds) {
  EXPECT_THAT(run(kMissing, axisgate_ + " check " + config("")).out, Not(HasSubstr("DDS")));
}

TEST_F(DdsCommands, RunGoesOnWithoutTheProgramAndSaysSo) {
  const Ended ended =
      run(kMissing, "timeout --preserve-status -s TERM 2 " + axisgate_ + " run " + config(R"("dds": {}, )"));
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.err, HasSubstr("warning gateway: axisgate-dds is not installed: AXISGATE_DDS_PROGRAM names "));
  EXPECT_THAT(ended.err, HasSubstr("listening on 127.0.0.1:15989"));
  EXPECT_THAT(ended.err, HasSubstr("signal 15: ending"));
}

TEST_F(DdsCommands, TopicsListensWhereTheConfigurationSaysThatTheGatewaySpeaks) {
  const std::string file = config(R"("dds": {"domain": 5, "interfaces": ["eth0"], "peers": ["10.0.0.2"]}, )");
  EXPECT_EQ(run("/bin/echo", axisgate_ + " topics " + file).out,
            "topics --domain=5 --interface=eth0 --peer=10.0.0.2\n");
  EXPECT_EQ(
      run("/bin/echo", axisgate_ + " topics --domain 6 --interface eth1 --interface eth2 " + file + " --json").out,
      "topics --domain=6 --interface=eth1 --interface=eth2 --peer=10.0.0.2 --json\n");
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
}  // namespace axisgate::app
