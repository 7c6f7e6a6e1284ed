// The real program, given a wrong configuration: exit code 1, each mistake on stderr, and neither port nor device
// touched.
#include <gmock/gmock.h>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace axisgate::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Ended {
  int code = -1;
  std::string out;
  std::string err;
};

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class Program : public ::testing::Test {
 protected:
  Program() {
    std::string name = (fs::temp_directory_path() / "axisgate-config-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    std::ofstream(device_ = folder_ / "device") << "";
  }
  ~Program() override { fs::remove_all(folder_); }

  Ended run(const std::string& arguments) const { return run_program(AXISGATE_PROGRAM, arguments); }
  Ended run_program(const fs::path& program, const std::string& arguments) const {
    const fs::path out = folder_ / "out";
    const fs::path err = folder_ / "err";
    const std::string command =
        program.string() + " " + arguments + " >" + out.string() + " 2>" + err.string() + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
  }

  /// One mistake (node 127) beside a device and a port that would be opened if the file were right.
  fs::path wrong_config() const {
    const fs::path file = folder_ / "wrong.json";
    std::ofstream(file) << R"({"modbus_tcp": [{"listen": "127.0.0.1:)" << kPort << R"("}], "buses": [{"name": "a",
      "adapter": "kinco-serial", "device": ")"
                        << device_.string() << R"(", "drives": [{"profile": "kinco-jd", "node": 127,
      "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1}]}]}]})";
    return file;
  }

  static constexpr int kPort = 15987;
  fs::path folder_;
  fs::path device_;
};

TEST_F(Program, OpensNothingWhereTheConfigurationIsWrong) {
  const int watch = inotify_init1(IN_NONBLOCK);
  ASSERT_GE(watch, 0);
  ASSERT_GE(inotify_add_watch(watch, device_.c_str(), IN_OPEN), 0);
  const std::string file = wrong_config().string();
  const std::string told =
      file +
      ": /buses/0/drives/0/node: 127 is the address with which Kinco's PC tool reaches every drive: "
      "give the drive a station number of 1 to 126 (object 100B:00 or its DIP switches)\n";
  for (const std::string command : {"run ", "check ", "map ", "commission "}) {
    const Ended ended = run(command + file + (command == "commission " ? " 1" : ""));
    EXPECT_EQ(ended.code, 1) << command;
    EXPECT_EQ(ended.err, told) << command;
    EXPECT_EQ(ended.out, "") << command;
  }
  char event[4096];
  EXPECT_EQ(read(watch, event, sizeof event), -1) << "the device was opened";
  close(watch);
}

TEST_F(Program, EndsWithOneOnEachWrongFile) {
  const fs::path invalid = fs::path(AXISGATE_SOURCE_DIR) / "tests/config/invalid";
  for (const auto& entry : fs::directory_iterator(invalid)) {
    if (entry.path().extension() != ".json") continue;
    const Ended ended = run("run " + entry.path().string());
    EXPECT_EQ(ended.code, 1) << entry.path();
    EXPECT_NE(ended.err, "") << entry.path();
    EXPECT_EQ(ended.out, "") << entry.path();
  }
}

TEST_F(Program, CheckEndsWithOneWhereABusIsOverloaded) {
  const fs::path file = folder_ / "overloaded.json";
  std::ofstream(file)
      << R"({"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "buses": [{"name": "a", "adapter": "kinco-serial",
      "device": "/dev/ttyUSB0", "poll": {"fast": 5}, "drives": [{"profile": "kinco-jd", "node": 1,
      "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1}]}]}]})";
  const Ended ended = run("check " + file.string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.out, HasSubstr("OVERLOADED"));
  EXPECT_THAT(ended.err, HasSubstr("a bus is planned over 100 %"));
}

TEST_F(Program, WrongCommandLinesEndWithTwoAndNameTheWord) {
  Ended ended = run("chekc x.json");
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("'chekc'"));
  ended = run("check");
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("CONFIG"));
  ended = run("map x.json --format xml");
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("--format"));
}

TEST_F(Program, ScanSaysWhatIsWrongWithItsWords) {
  struct Case {
    std::string arguments;
    std::string told;
  };
  for (const Case& it : {
           Case{"", "DEVICE"},
           Case{"slcan:", "slcan: must be followed by the path of a serial port"},
           Case{"/dev/ttyACM0", "a serial CAN adapter is given as slcan:PATH"},
           Case{"can0 --bitrate 5000", "5000 bit/s is no bit rate of CAN"},
           Case{"slcan:/dev/ttyACM0 --bitrate 300000", "serial CAN adapters offer 10000, 20000"},
           Case{"can0 --nodes 0-5", "'0-5' is no node-ID and no range of them"},
           Case{"can0 --nodes 9-5", "--nodes"},
           Case{"can0 --timeout-ms 1", "--timeout-ms"},
       }) {
    const Ended ended = run("scan " + it.arguments);
    EXPECT_EQ(ended.code, 2) << it.arguments;
    EXPECT_THAT(ended.err, HasSubstr(it.told)) << it.arguments;
    EXPECT_EQ(ended.out, "") << it.arguments;
  }
}

TEST_F(Program, ScanOfWhatIsNotThereEndsWithTheReason) {
  Ended ended = run("scan slcan:" + (folder_ / "no-adapter").string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(ended.err, (folder_ / "no-adapter").string() +
                           ": No such file or directory\nIs the adapter plugged in, and may you open it (group "
                           "dialout)? ls -l /dev/serial/by-id lists those that are there.\n");
  EXPECT_EQ(ended.out, "");
  // With a kernel that has CAN, and with one that has not.
  ended = run("scan nosuchcan9");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, AnyOf(HasSubstr("nosuchcan9 does not exist: is the adapter plugged in"),
                               HasSubstr("nosuchcan9: this kernel has no CAN")));
  EXPECT_THAT(ended.err, Not(HasSubstr("trying again")));
  EXPECT_EQ(ended.out, "");
}

TEST_F(Program, ScanHelpWarnsOfAGatewayOnTheSameBus) {
  const Ended ended = run("scan --help");
  EXPECT_THAT(ended.out, HasSubstr("A gateway that runs on the same bus is another SDO client"));
}

TEST_F(Program, EveryCommandHasHelpWithAnExample) {
  for (const char* command : {"", "run ", "check ", "map ", "top ", "profile check ", "commission ", "scan "}) {
    const Ended ended = run(std::string(command) + "--help");
    EXPECT_EQ(ended.code, 0) << command;
    EXPECT_THAT(ended.out, HasSubstr(std::string("Example: axisgate ") + command)) << command;
  }
}

TEST_F(Program, TheShippedProfilesAreFoundAndRight) {
  const fs::path drives = fs::path(AXISGATE_SOURCE_DIR) / "schemas/drives";
  for (const auto& entry : fs::directory_iterator(drives)) {
    const Ended ended = run("profile check " + entry.path().string());
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("is valid"));
  }
  const Ended ended = run("check " AXISGATE_SOURCE_DIR "/deploy/demo.json");
  EXPECT_EQ(ended.code, 0) << ended.err;
}

TEST_F(Program, ComparesAProfileWithTheMakersEds) {
  const std::string profile = AXISGATE_SOURCE_DIR "/schemas/drives/kinco-md.json";
  const fs::path eds = AXISGATE_SOURCE_DIR "/tests/profiles/eds/kinco-md.eds";
  Ended ended = run("profile check " + profile + " --eds " + eds.string());
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("Made for tests MD80, vendor 0x300, product 0x4d44, revision 0x10002"));
  EXPECT_THAT(ended.out, HasSubstr("nothing in it contradicts the profile"));
  EXPECT_EQ(ended.err, "");

  const fs::path other = folder_ / "other.eds";
  std::string text = content(eds);
  text.replace(text.find("[6041]"), 6, "[6049]");
  std::ofstream(other) << text;
  ended = run("profile check " + profile + " --eds " + other.string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(ended.err,
            profile + ": /objects/statusword/at/canopen: " + other.string() + " [6041]: the EDS has no such object\n");

  std::ofstream(other) << "no EDS at all\n";
  ended = run("profile check " + profile + " --eds " + other.string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("other.eds: line 1: \"no EDS at all\" is neither [section] nor key=value"));
  ended = run("profile check " + profile + " --eds " + (folder_ / "none.eds").string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("none.eds: cannot be read: No such file or directory"));
  ended = run("profile check " AXISGATE_SOURCE_DIR "/schemas/drives/id286pro.json --eds " + eds.string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("/protocols: has no canopen"));
}

TEST_F(Program, FindsItsProfilesWhereItIsInstalled) {
  fs::create_directories(folder_ / "bin");
  fs::create_directories(folder_ / "share/axisgate");
  fs::copy(AXISGATE_PROGRAM, folder_ / "bin/axisgate");
  fs::copy(fs::path(AXISGATE_SOURCE_DIR) / "schemas", folder_ / "share/axisgate/schemas", fs::copy_options::recursive);
  const Ended ended = run_program(folder_ / "bin/axisgate", "check " AXISGATE_SOURCE_DIR "/deploy/demo.json");
  EXPECT_EQ(ended.code, 0) << ended.err;
}

}  // namespace
}  // namespace axisgate::app
