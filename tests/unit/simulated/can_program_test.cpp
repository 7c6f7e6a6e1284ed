// axisgate-sim with CAN drives behind a Lawicel adapter on a pty, and its words for them.
#include "tests/unit/simulated/program_bench.hpp"

namespace axisgate::simulated {
namespace {

class CanProgram : public ProgramBench {
 protected:
  std::string ask(const Descriptor& port, const std::string& text, std::size_t length, int timeout_ms = 2000) {
    const Bytes reply = exchange(port, {text.begin(), text.end()}, length, timeout_ms);
    return {reply.begin(), reply.end()};
  }
  const std::string read_status = "t60184041600000000000\r";
};

TEST_F(CanProgram, AnswersBehindALawicelAdapterAndObeysTheControlSocket) {
  start({"--line", folder / "bus:lawicel:ld2@1,jd@2", "--control", folder / "control", "--boot-ms", "600000"});
  ASSERT_TRUE(wait_for_log("control "));
  EXPECT_THAT(log(), testing::HasSubstr("lawicel:ld2@1,jd@2"));
  const Descriptor port = open_port("bus");
  EXPECT_EQ(ask(port, "S6\rO\r", 2), "\r\r");
  EXPECT_EQ(ask(port, read_status, 24), "z\rt58184B41600050020000\r");
  EXPECT_EQ(control("state bus/1"), "ok switch_on_disabled");
  EXPECT_EQ(control("nmt bus/1"), "ok pre_operational");
  EXPECT_EQ(control("get bus/1 6041.00"), "ok 592 0x00000250");
  EXPECT_EQ(control("get bus/1 1008.00"), "ok LD2-CAN7010");
  EXPECT_EQ(control("set bus/2 1017.00 500"), "ok");
  EXPECT_EQ(control("get bus/2 1017.00"), "ok 500 0x000001F4");
  EXPECT_EQ(control("exchanges bus"), "ok 1");
  EXPECT_EQ(control("overlaps bus"), "ok 0");
  EXPECT_EQ(control("exception bus/1 0x08000022 next"), "ok");
  EXPECT_EQ(ask(port, read_status, 24), "z\rt58188041600022000008\r");
  EXPECT_EQ(control("twin bus/1 on"), "ok");
  EXPECT_EQ(ask(port, read_status, 46), "z\rt58184B41600050020000\rt58184B41600050020000\r");
  EXPECT_EQ(control("twin bus/1 off"), "ok");
  EXPECT_EQ(control("connect bus/1 off"), "ok");
  EXPECT_EQ(ask(port, read_status, 24, 100), "z\r");
  EXPECT_EQ(control("connect bus/1 on"), "ok");
  EXPECT_EQ(control("restart bus/1 before"), "ok");
  EXPECT_EQ(ask(port, read_status, 24, 100), "z\r");
  EXPECT_EQ(control("nmt bus/1"), "ok initialising");
  EXPECT_EQ(control("restarts bus/1"), "ok 1");
}

TEST_F(CanProgram, SpeaksOfFaultsBusOffAndWhatItDoesNotUnderstand) {
  start({"--line", folder / "bus:lawicel:ld2@1,jd@2", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  const Descriptor port = open_port("bus");
  EXPECT_EQ(ask(port, "S6\rO\r", 2), "\r\r");
  EXPECT_EQ(control("fault bus/1 0x2211"), "ok");
  EXPECT_EQ(ask(port, "", 22), "t08181122020000000000\r");
  EXPECT_EQ(control("state bus/1"), "ok fault");
  EXPECT_EQ(control("clear bus/1 0x2211"), "ok");
  EXPECT_EQ(control("emergency bus/2 0x1000"), "ok");
  EXPECT_EQ(ask(port, "", 22), "t08280010000000000000\r");
  EXPECT_EQ(control("bus-off bus on"), "ok");
  EXPECT_EQ(ask(port, "F\r", 4), "FA0\r");
  EXPECT_EQ(ask(port, read_status, 24, 100), "z\r");
  EXPECT_EQ(control("bus-off bus off"), "ok");
  EXPECT_EQ(ask(port, read_status, 24), "z\rt58184B41600018020000\r");
  EXPECT_EQ(control("no-ack bus"), "ok");
  EXPECT_THAT(control("corrupt bus/1 on"), testing::HasSubstr("cannot happen on CAN"));
  EXPECT_THAT(control("mute bus/1 0x12"), testing::HasSubstr("takes no number"));
  EXPECT_THAT(control("get bus/1 9999.00"), testing::HasSubstr("no object"));
  EXPECT_THAT(control("input bus/1 7 on"), testing::HasSubstr("no input"));
  EXPECT_THAT(control("fly bus/2"), testing::HasSubstr("no command"));
}

}  // namespace
}  // namespace axisgate::simulated
