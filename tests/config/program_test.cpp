// SPDX-License-Identifier: Apache-2.0
// The real program, given a wrong configuration: exit code 1, each mistake on stderr, and neither port nor device
// touched.
#include <sys/inotify.h>
#include <unistd.h>

#include <regex>
#include <sstream>

#include "tests/config/program.hpp"
#include "tests/places.hpp"

namespace axisgate::config {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Program = ProgramTest;

TEST_F(Program, OpensNothingWhereTheConfigurationIsWrong) {
  const int watch = inotify_init1(IN_NONBLOCK);
  ASSERT_GE(watch, 0);
  const std::string device = write("device", "");
  ASSERT_GE(inotify_add_watch(watch, device.c_str(), IN_OPEN), 0);
  const std::string config = one_drive(device, 127, "");
  const std::string file = write("wrong.json", config);
  const std::string told =
      file + fmt::format(":1:{}", config.find("\"node\"") + 1) +
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

TEST_F(Program, CheckEndsWithOneWhereABusIsOverloaded) {
  std::string config = one_drive("/dev/ttyUSB0", 1, "");
  EXPECT_EQ(run("check " + write("right.json", config)).code, 0);
  config.insert(config.find(R"("drives")"), R"("poll": {"fast": 5}, )");
  const Ended ended = run("check " + write("overloaded.json", config));
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.out, HasSubstr("OVERLOADED"));
  EXPECT_THAT(ended.err, HasSubstr("a bus is planned over 100 %"));
}

TEST_F(Program, CheckTellsOfALineWithTwoNames) {
  const std::string line = write("line", "");
  const std::string name = (folder() / "by-id").string();
  fs::create_symlink(line, name);
  std::string config = one_drive(line, 1, "");
  const auto first = config.find(R"({"name": "a")");
  std::string second = ", " + config.substr(first, config.find("]}]}]}", first) + 4 - first);
  for (const auto& [from, to] : {std::pair{std::string(R"("name": "a")"), std::string(R"("name": "b")")},
                                 {line, name},
                                 {std::string(R"("axis": 1)"), std::string(R"("axis": 2)")}})
    second.replace(second.find(from), from.size(), to);
  config.insert(config.find("]}]}]}", first) + 4, second);
  const Ended ended = run("check " + write("two.json", config));
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("warning: " + line + " and " + name + " are one line, "));
}

/// What stands between `begins` and the end of the block.
std::string block(const std::string& page, const std::string& begins) {
  const std::size_t at = page.find(begins) + begins.size();
  return page.substr(at, page.find("\n```", at) - at + 1);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(Program, TheWorkedCaseOfUnitsAndLimitsIsWhatCheckSays) {
  const std::string page = test::content(test::source_path("docs/configuration.md"));
  const std::string config = block(page, "```json\n");
  const Ended ended = run("check " + write("case.json", config));
  EXPECT_EQ(ended.code, 0) << ended.err;
  std::istringstream said(block(page, "says:\n\n```text\n"));
  int lines = 0;
  for (std::string line; std::getline(said, line); ++lines) EXPECT_THAT(ended.out, HasSubstr("  " + line));
  EXPECT_EQ(lines, 2);
  EXPECT_THAT(ended.out, Not(HasSubstr("limits/")));

  // | gear | metres of one motor turn | wanted | motor | "velocity" | |
  std::istringstream rows(page.substr(page.find("| gear |")));
  int counted = 0;
  for (std::string row; std::getline(rows, row) && row.starts_with('|');) {
    std::smatch cell;
    if (!std::regex_match(row, cell,
                          std::regex(R"(\|[^|]*\| ([\d.]+) \| ([\d.]+ m/s) \| (\d+ rpm) \| (\d+) \| ?(.*?) ?\|)")))
      continue;
    ++counted;
    const std::string metres = "\"dds_unit\": \"m\", \"metres_per_rev\": \"" + cell.str(1) + "\", \"units_per_rev\"";
    const std::string changed = replaced(replaced(config, "\"units_per_rev\"", metres), "\"velocity\": 3000000",
                                         "\"velocity\": " + cell.str(4));
    const Ended checked = run("check " + write("row.json", changed));
    EXPECT_EQ(checked.code, 0) << checked.err;
    const std::string rpm = cell.str(3);
    EXPECT_THAT(checked.out, HasSubstr("velocity " + rpm + " (" + cell.str(2) + ")"));
    if (const std::string odd = cell.str(5); odd.empty())
      EXPECT_THAT(checked.out, Not(HasSubstr("limits/velocity")));
    else
      EXPECT_THAT(checked.out, HasSubstr("/limits/velocity: " + cell.str(4) + " is " + rpm + ", " + odd + ": "));
  }
  EXPECT_EQ(counted, 3);
  // And the mistake at its head.
  const std::string wrong = replaced(config, "\"axis\": 1,", "\"axis\": 1,\n        \"lease\": 2000,");
  const std::string shown = block(page, "```text\n");
  EXPECT_EQ(run("check " + write("gateway.json", wrong)).err,
            (folder() / "gateway.json").string() + shown.substr(shown.find(':')));
}

TEST_F(Program, WhatAFullDiskHasNotTakenIsNotDone) {
  const std::string file = write("right.json", one_drive("/dev/ttyUSB0", 1, ""));
  for (const std::string command : {"check ", "profile check "}) {
    const Ended ended =
        run(command + (command == "check " ? file : test::source_path("schemas/drives/kinco-jd.json")) + " >/dev/full");
    EXPECT_EQ(ended.code, 1) << command;
    EXPECT_THAT(ended.err, HasSubstr("could not all be written to standard output")) << command;
  }
}

TEST_F(Program, WrongCommandLinesEndWithTwoAndNameTheWord) {
  const std::pair<std::string, std::string> cases[] = {
      {"chekc x.json", "axisgate: there is no command 'chekc'; did you mean \"check\"?"},
      {"banana", "axisgate: there is no command 'banana'; axisgate --help lists them"},
      {"profile chekc x.json", "axisgate profile: there is no command 'chekc'; did you mean \"check\"?"},
      {"top 127.0.0.1:1 --interfal 5", "--interfal: did you mean \"--interval\"?"},
      {"top 127.0.0.1:1 --interfal=5", "--interfal: did you mean \"--interval\"?"},
      {"run x.json --log-level waring", "'waring' is none of: error, warning, info, debug; did you mean \"warning\"?"},
      {"map x.json --format jsno", "'jsno' is none of: table, md, csv, json, st; did you mean \"json\"?"},
      {"check", "CONFIG"},
      {"check x.json --profiles /nowhere", "--profiles: '/nowhere' is no folder"},
      {"explain --profiles /dev/null", "--profiles: '/dev/null' is no folder"},
      {"map x.json --format xml", "--format"},
      {"scan", "DEVICE"},
      {"scan slcan:", "slcan: must be followed by the path of a serial port"},
      {"scan /dev/ttyACM0 --protocol kinco", "'kinco' is none of: kinco-serial, modbus-rtu"},
      {"scan /dev/ttyACM0 --stations 0-5", "'0-5' is no station and no range of them"},
      {"move 127.0.0.1:1502 1", "TURNS"},
      {"move 127.0.0.1:1502 1 12,5", "'12,5' is no number of turns: write 12.5"},
      {"move 127.0.0.1 1 2", "'127.0.0.1' is no HOST:PORT"},
      {"stop 127.0.0.1 1", "'127.0.0.1' is no HOST:PORT"},
      {"stop 127.0.0.1:x 1", "'127.0.0.1:x' is no HOST:PORT"},
      {"move lift", "TURNS"},
      {"move lift up --enable", "'up' is no number of turns: write 12.5"},
      {"stop", "AXIS"},
      {"stop 0", "'0' is no axis: write its number, 1 to 499, or its name"},
      {"stop 127.0.0.1:1502 1 --config x.json", "HOST:PORT"},
      {"jog 127.0.0.1:1502 1 --velocity -5", "'-5' is no speed"},
      {"jog 127.0.0.1:1502 1", "axisgate jog: needs a terminal"},
      {"enable 127.0.0.1:1502 500", "AXIS"},
      {"scan can0 --bitrate 5000", "5000 bit/s is no bit rate of CAN"},
      {"scan slcan:/dev/ttyACM0 --bitrate 300000", "serial CAN adapters offer 10000, 20000"},
      {"scan can0 --nodes 0-5", "'0-5' is no node-ID and no range of them"},
      {"scan can0 --nodes 9-5", "--nodes"},
      {"scan can0 --timeout-ms 1", "--timeout-ms"},
  };
  for (const auto& [arguments, told] : cases) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, 2) << arguments;
    EXPECT_THAT(ended.err, HasSubstr(told)) << arguments;
    EXPECT_EQ(ended.out, "") << arguments;
  }
}

TEST_F(Program, ANameInPlaceOfHostPortIsToldOnceAndAWrongOptionIsNone) {
  EXPECT_THAT(run("stop lift 1").err, testing::MatchesRegex("'lift' is no HOST:PORT: [^\n]*\n"));
  EXPECT_THAT(run("stop lift --confg").err, testing::AllOf(HasSubstr("\"--config\""), Not(HasSubstr("HOST:PORT: "))));
  EXPECT_EQ(run("stop lift 1 --help").code, 0);
}

TEST_F(Program, ExplainNamesTheNearestWord) {
  const Ended ended = run("explain stop_lached");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr("nothing is called 'stop_lached'; did you mean \"stop_latched\"?"));
  EXPECT_EQ(run("explain bananarama").err,
            "axisgate explain: nothing is called 'bananarama'; axisgate explain, without a word, lists all names\n");
}

TEST_F(Program, AProfilesPathCountsFromItsConfigurationWhereverTheProgramIsStarted) {
  fs::create_directories(folder() / "site/drives");
  fs::copy(test::source_path("schemas/drives/kinco-jd.json"), folder() / "site/drives/kinco-jd.json");
  std::string config = one_drive("/dev/ttyUSB0", 1, "");
  config.replace(config.find("kinco-jd"), 8, "drives/kinco-jd.json");
  write("site/gateway.json", config);
  const std::string program = AXISGATE_PROGRAM;
  for (const std::string from : {"site", "site/drives", "."}) {
    const fs::path file = fs::relative(folder() / "site/gateway.json", folder() / from);
    const Ended ended = run_command("cd " + (folder() / from).string() + " && " + program + " check " + file.string());
    EXPECT_EQ(ended.code, 0) << from << ": " << ended.err;
  }
  // What lies where the program is started is no profile of that configuration.
  fs::rename(folder() / "site/drives", folder() / "drives");
  const Ended ended = run_command("cd " + folder().string() + " && " + program + " check site/gateway.json");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err,
              HasSubstr("there is no file site/drives/kinco-jd.json: a path that does not begin with / counts "
                        "from this file"));
}

TEST_F(Program, CheckReadsAPipeAndRunDoesNot) {
  const std::string good = write("good.json", one_drive("/dev/ttyUSB0", 1, ""));
  const std::string pipe = (folder() / "pipe").string();
  const std::string fed = "mkfifo " + pipe + "; cat " + good + " >" + pipe + " & ";
  const Ended by_file = run("check " + good);
  const Ended checked = run_command(fed + AXISGATE_PROGRAM + " check " + pipe);
  EXPECT_EQ(checked.code, by_file.code);
  EXPECT_NE(by_file.out, "");
  std::string out = by_file.out;
  for (std::size_t at = 0; (at = out.find(good)) != std::string::npos;) out.replace(at, good.size(), pipe);
  EXPECT_EQ(checked.out, out);
  const Ended ran = run("run " + pipe);
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.err, HasSubstr("cannot be read: it is no regular file"));
}

TEST_F(Program, ScanOfWhatIsNotThereEndsWithTheReason) {
  Ended ended = run("scan slcan:" + (folder() / "no-adapter").string());
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(ended.err, (folder() / "no-adapter").string() +
                           ": No such file or directory\nIs the adapter plugged in? ls -l /dev/serial/by-id lists "
                           "those that are there.\n");
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
  for (const char* command :
       {"", "run ", "check ", "map ", "top ", "profile check ", "profile from-eds ", "profile new ", "profile upgrade ",
        "commission ", "scan ", "enable ", "move ", "jog ", "stop "}) {
    const Ended ended = run(std::string(command) + "--help");
    EXPECT_EQ(ended.code, 0) << command;
    EXPECT_THAT(ended.out, HasSubstr(std::string("Example: axisgate ") + command)) << command;
  }
}

TEST_F(Program, AProfilesOpenQuestionsAreListed) {
  const Ended ended = run("profile check " + test::source_path("tests/profiles/valid/asking.json"));
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("\n  open          counts: How many counts does one turn have? (manual: 'encoder "
                                   "resolution'); before it is answered no position, no velocity\n"));
  EXPECT_THAT(ended.out, HasSubstr("\n  open          /nvm: Does each write go into the drive's memory?\n"));
}

TEST_F(Program, TheShippedProfilesAreFoundAndRight) {
  const fs::path drives = fs::path(test::source_path("schemas/drives"));
  for (const auto& entry : fs::directory_iterator(drives)) {
    const Ended ended = run("profile check " + entry.path().string());
    if (test::content(entry.path()).find("\"base_only\": true") != std::string::npos) {
      EXPECT_EQ(ended.code, 1);
      EXPECT_THAT(ended.err, HasSubstr("/base_only: is no drive but a base: name or check a profile that extends it"));
      continue;
    }
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("is valid"));
  }
  const Ended ended = run("check " + test::source_path("deploy/demo.json"));
  EXPECT_EQ(ended.code, 0) << ended.err;
}

TEST_F(Program, ComparesAProfileWithTheMakersEds) {
  const std::string profile = test::source_path("schemas/drives/kinco-md.json");
  const fs::path eds = test::source_path("tests/profiles/eds/kinco-md.eds");
  Ended ended = run("profile check " + profile + " --eds " + eds.string());
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("Made for tests MD80, vendor 0x300, product 0x4d44, revision 0x10002"));
  EXPECT_THAT(ended.out, HasSubstr("nothing in it contradicts the profile"));
  EXPECT_EQ(ended.err, "");

  std::string other = test::content(eds);
  other.replace(other.find("[6041]"), 6, "[6049]");
  const std::string file = write("other.eds", other);
  ended = run("profile check " + profile + " --eds " + file);
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(ended.err, test::source_path("schemas/drives/cia402.json: /objects/statusword/at/canopen: ") + file +
                           " [6041]: the EDS has no such object\n");

  write("other.eds", "stray\n" + test::content(eds));
  ended = run("profile check " + profile + " --eds " + file);
  EXPECT_EQ(ended.code, 0) << "an oddity is no contradiction\n" << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("remark        line 1: \"stray\" is neither [section] nor key=value: left out\n"));

  write("other.eds", "no EDS at all\n");
  const std::pair<std::string, std::string> cases[] = {
      {profile + " --eds " + file, "other.eds: has no object: is this an EDS?"},
      {profile + " --eds " + (folder() / "none.eds").string(), "none.eds: cannot be read: No such file or directory"},
      {test::source_path("schemas/drives/id286pro.json") + " --eds " + eds.string(), "/protocols: has no canopen"},
  };
  for (const auto& [arguments, told] : cases) {
    ended = run("profile check " + arguments);
    EXPECT_EQ(ended.code, 1) << arguments;
    EXPECT_THAT(ended.err, HasSubstr(told)) << arguments;
  }
}

TEST_F(Program, MakesAProfileOfAnEdsOnceAndPrintsWhatItAsks) {
  const std::string eds = test::source_path("tests/profiles/eds/sparse.eds");
  const std::string made = (folder() / "my-drive.json").string();
  const std::string command = "profile from-eds " + eds + " --name my-drive -o " + folder().string();
  Ended ended = run(command);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr(made + " is written\n"));
  EXPECT_THAT(ended.out, HasSubstr("note          without homing_method (6098h): not in the EDS\n"));
  EXPECT_THAT(ended.out, HasSubstr("question      position_units_per_rev: How many counts of the position"));
  EXPECT_EQ(ended.err, "");
  ended = run("profile check " + made + " --eds " + eds);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("nothing in it contradicts the profile"));

  const std::string content = test::content(made);
  ended = run(command);
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err, HasSubstr(made + ": is there already, and is not written over"));
  EXPECT_EQ(test::content(made), content);
}

TEST_F(Program, SaysWhyOfAFileNoProfileIsMade) {
  const std::pair<std::string, std::string> cases[] = {
      {"from-eds " + write("drive.xdd", "<?xml version=\"1.0\"?>\n"), "drive.xdd: is an XDD or XDC (XML): ask"},
      {"from-eds " + write("io.eds", "[1000]\nDataType=7\n"), "io.eds: 6040h (controlword): not in the EDS"},
      {"new --modbus " + write("one.csv", "speed,1,u16,rw\n"), "one.csv: needs a row \"control\""},
      {"new --modbus " + write("bad.csv", "speed,1,float\n"), "bad.csv: line 1: \"float\" is no type"},
      {"upgrade " + write("list.json", "[]"), "list.json: is no profile: it has no name"},
  };
  for (const auto& [arguments, told] : cases) {
    const Ended ended = run("profile " + arguments + " -o " + folder().string());
    EXPECT_EQ(ended.code, 1) << arguments;
    EXPECT_THAT(ended.err, HasSubstr(told)) << arguments;
  }
  EXPECT_EQ(run("profile new").code, 2);
  EXPECT_THAT(run("profile from-eds x.eds --name My_Drive").err, HasSubstr("such as 'my-drive'"));
}

TEST_F(Program, MakesAFormOfATableOfRegisters) {
  const std::string table = write("my drive.csv",
                                  "name,address,type,access,unit,range\ncontrol,8192,u16,rw,,\nstatus,4096,u16,ro,,\n"
                                  "fault,4097,u16,ro,,\ntarget_velocity,8193,i16,rw,rpm,-3000..3000\n");
  Ended ended = run("profile new --modbus '" + table + "' -o " + folder().string());
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("question      /commands/quick_stop: Which number in control stops the motor"));
  ended = run("profile check " + (folder() / "my-drive.json").string());
  EXPECT_EQ(ended.code, 0) << ended.err;
}

TEST_F(Program, CarriesAnOldProfileOver) {
  std::string old = test::content(test::source_path("schemas/drives/leadshine-ld2-can.json"));
  for (const auto& [from, to] :
       {std::pair{std::string("\"name\": \"leadshine-ld2-can\""), std::string("\"name\": \"mine\"")},
        {std::string("\"source\": \"2\","), std::string("\"source\": \"2\", \"fence\": [\"error_code\", \"mode\"],")}})
    old.replace(old.find(from), from.size(), to);
  fs::create_directories(folder() / "new");
  const std::string command = "profile upgrade " + write("mine.json", old) + " -o " + (folder() / "new").string();
  const Ended ended = run(command);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("note          /protocols/canopen/fence: is called resynchronisation\n"));
  EXPECT_EQ(run("profile check " + (folder() / "new/mine.json").string()).code, 0);
  EXPECT_THAT(run("profile upgrade " + (folder() / "new/mine.json").string()).out,
              HasSubstr("nothing in it is of an earlier axisgate"));
}

TEST_F(Program, FindsItsProfilesWhereItIsInstalled) {
  fs::create_directories(folder() / "bin");
  fs::create_directories(folder() / "share/axisgate");
  fs::copy(AXISGATE_PROGRAM, folder() / "bin/axisgate");
  fs::copy(fs::path(test::source_path("schemas")), folder() / "share/axisgate/schemas", fs::copy_options::recursive);
  const Ended ended =
      run_command((folder() / "bin/axisgate").string() + " check " + test::source_path("deploy/demo.json"));
  EXPECT_EQ(ended.code, 0) << ended.err;
}

}  // namespace
}  // namespace axisgate::config
