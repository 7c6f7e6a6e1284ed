// axisgate-sim itself, started as a user would: ptys, control socket, unplugging, and an end that leaves nothing
// behind.
#include "tests/simulated/rtu_frame.hpp"
#include "tests/unit/simulated/program_bench.hpp"

namespace axisgate::simulated {
namespace {

class Program : public ProgramBench {
 protected:
  const Bytes read_status = from_hex("01 40 41 60 00 00 00 00 00 1E");
};

TEST_F(Program, AnswersOnItsPtysAndEndsWithoutATrace) {
  start({"--line", folder / "lift:jd@1", "--line", folder / "table:md@1,jd@2", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  EXPECT_THAT(log(), testing::HasSubstr("ready " + (folder / "lift").string() + " -> /dev/pts/"));
  const Descriptor lift = open_port("lift");
  EXPECT_EQ(exchange(lift, read_status, 10), from_hex("01 4B 41 60 00 50 40 00 00 83"));
  const Descriptor table = open_port("table");
  EXPECT_EQ(exchange(table, read_status, 20).size(), 20U);  // a chain returns the host's frame first
  EXPECT_EQ(end(SIGINT), 0);
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder / "lift")));
  EXPECT_FALSE(fs::exists(folder / "control"));
}

TEST_F(Program, KeepsAnsweringWhenAUserClosesAndOpensThePort) {
  start({"--line", folder / "lift:jd@1"});
  ASSERT_TRUE(wait_for_log("ready "));
  for (int i = 0; i < 5; ++i) {
    const Descriptor port = open_port("lift");
    EXPECT_EQ(exchange(port, read_status, 10).size(), 10U) << i;
  }
  EXPECT_EQ(end(SIGTERM), 0);
}

TEST_F(Program, ObeysTheControlSocket) {
  start({"--line", folder / "lift:jd@1", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  const Descriptor port = open_port("lift");
  EXPECT_EQ(control("mute lift/1 on"), "ok");
  EXPECT_TRUE(exchange(port, read_status, 10, 100).empty());
  EXPECT_EQ(control("mute lift/1 off"), "ok");
  EXPECT_EQ(exchange(port, from_hex("01 2B 40 60 00 0F 00 00 00 25"), 10).size(), 10U);
  EXPECT_EQ(control("state lift/1"), "ok operation_enabled");
  EXPECT_EQ(control("writes lift/1 6040.00"), "ok 1");
  EXPECT_EQ(control("get lift/1 6041.00"), "ok 16439 0x00004037");
  EXPECT_EQ(control("fault lift/1 2601 0x0020"), "ok");
  EXPECT_EQ(control("get lift/1 2601.00"), "ok 32 0x00000020");
  EXPECT_EQ(control("clear lift/1 2601 0x0020"), "ok");
  EXPECT_EQ(control("set lift/1 6079.00 305"), "ok");
  EXPECT_EQ(control("restart lift/1"), "ok");
  EXPECT_EQ(control("state lift/1"), "ok booting");
  EXPECT_THAT(control("state lift/7"), testing::HasSubstr("it has jd@1"));
  EXPECT_THAT(control("fly lift/1"), testing::StartsWith("error 'fly' is no command"));
  EXPECT_THAT(control("get lift/1 6041"), testing::HasSubstr("INDEX.SUB"));
  EXPECT_THAT(control("help"), testing::StartsWith("ok "));
}

TEST_F(Program, SpeaksModbusRtuOnALineOfSeveralKinds) {
  start({"--line", folder / "axes:rtu:id286pro@1+305=2,jd@2", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  EXPECT_THAT(log(), testing::HasSubstr(" rtu:id286pro@1,jd@2"));
  const Descriptor port = open_port("axes");
  EXPECT_EQ(exchange(port, from_hex("01 03 00 6C 00 02 04 16"), 9), from_hex("01 03 04 00 00 00 02 7B F2"));
  EXPECT_EQ(exchange(port, seal_rtu(2, read_pdu(0x3200, 1)), 7), seal_rtu(2, Bytes{0x03, 2, 0x40, 0x50}));
  const Bytes stop = from_hex("01 06 01 43 00 06 F9 E0");
  EXPECT_EQ(exchange(port, stop, 8), stop);
  EXPECT_EQ(control("exchanges axes"), "ok 3");
  EXPECT_EQ(control("half axes/1 next"), "ok");
  EXPECT_LT(exchange(port, stop, 8, 200).size(), 8U);
  EXPECT_EQ(control("exception axes/1 6 next"), "ok");
  EXPECT_EQ(exchange(port, stop, 5), seal_rtu(1, Bytes{0x86, 6}));
  EXPECT_EQ(control("wrong-length axes/2 next"), "ok");
  EXPECT_EQ(exchange(port, seal_rtu(2, read_pdu(0x3200, 1)), 9).size(), 9U);
}

TEST_F(Program, ControlsAnId286pro) {
  start({"--line", folder / "axes:rtu:id286pro@7", "--line", folder / "lift:jd@1", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  const Descriptor port = open_port("axes");
  for (const auto& pdu : {write_pdu(305, 1), write_pdu(305, 1), write_pdu(306, 900), write_long_pdu(313, 500)}) {
    EXPECT_EQ(exchange(port, seal_rtu(7, pdu), 8).size(), 8U);
  }
  EXPECT_EQ(control("eeprom axes/7"), "ok 305:2 unknown 313:1 segments 0");
  EXPECT_EQ(control("writes axes/7 306"), "ok 1");
  EXPECT_EQ(control("get axes/7 306"), "ok 900 0x00000384");
  EXPECT_EQ(control("state axes/7"), "ok stopped");
  EXPECT_EQ(exchange(port, seal_rtu(7, write_pdu(323, 1)), 8).size(), 8U);
  for (int i = 0; i < 6000 && control("position axes/7") != "ok 500"; ++i)
    std::this_thread::sleep_for(milliseconds(10));
  EXPECT_EQ(control("position axes/7"), "ok 500");
  EXPECT_THAT(control("starts axes/7"), testing::MatchesRegex("ok 1 [0-9]+ms:#5:1"));
  EXPECT_EQ(control("fault axes/7 14 hardware"), "ok");
  EXPECT_EQ(control("state axes/7"), "ok disabled fault 14");
  EXPECT_THAT(control("clear axes/7 11"), testing::HasSubstr("no fault 11"));
  EXPECT_EQ(control("clear axes/7 14"), "ok");
  EXPECT_EQ(control("restart axes/7"), "ok");
  EXPECT_EQ(control("state axes/7"), "ok booting");
  EXPECT_EQ(control("restarts axes/7"), "ok 1");
  EXPECT_EQ(control("enable axes/7 off"), "ok");
  EXPECT_EQ(control("input axes/7 3 on"), "ok");
  EXPECT_THAT(control("input axes/7 4 on"), testing::HasSubstr("no input 4"));
  EXPECT_EQ(control("set axes/7 400 11"), "ok");
  EXPECT_THAT(control("set axes/7 400 99"), testing::HasSubstr("exception 3"));
  EXPECT_THAT(control("get axes/7 107"), testing::HasSubstr("no register 107"));
  EXPECT_THAT(control("stores axes/7"), testing::HasSubstr("no command"));
  EXPECT_EQ(control("position lift/1"), "ok 0");
  EXPECT_THAT(control("half lift/1 next"), testing::HasSubstr("Modbus RTU alone"));
  EXPECT_THAT(control("eeprom lift/1"), testing::HasSubstr("no command"));
}

TEST_F(Program, UnplugsAndPlugsALineUnderTheSameName) {
  start({"--line", folder / "lift:jd@1", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  const Descriptor old_port = open_port("lift");
  EXPECT_EQ(control("unplug lift"), "ok");
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder / "lift")));
  pollfd gone{old_port.get(), POLLIN, 0};
  EXPECT_EQ(::poll(&gone, 1, 60000), 1);
  EXPECT_NE(gone.revents & POLLHUP, 0);
  EXPECT_EQ(control("plug lift"), "ok");
  const Descriptor port = open_port("lift");
  EXPECT_EQ(exchange(port, read_status, 10).size(), 10U);
}

TEST_F(Program, SaysWhatIsWrongAndEndsWith1) {
  start({"--line", folder / "nowhere" / "lift:jd@1"});
  ASSERT_TRUE(wait_for_log("does its folder exist?"));
  int status = 0;
  ::waitpid(child, &status, 0);
  child = 0;
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

TEST_F(Program, LeavesAFileOfTheUsersAlone) {
  std::ofstream(folder / "lift") << "mine";
  start({"--line", folder / "lift:jd@1"});
  ASSERT_TRUE(wait_for_log("exists and is no link"));
  int status = 0;
  ::waitpid(child, &status, 0);
  child = 0;
  EXPECT_TRUE(fs::is_regular_file(folder / "lift"));
}

TEST_F(Program, AnswersAfterTheReplyDelay) {
  start({"--line", folder / "lift:jd@1", "--reply-delay-ms", "30"});
  ASSERT_TRUE(wait_for_log("ready "));
  const Descriptor port = open_port("lift");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(exchange(port, read_status, 10).size(), 10U);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(29));
}

}  // namespace
}  // namespace axisgate::simulated
