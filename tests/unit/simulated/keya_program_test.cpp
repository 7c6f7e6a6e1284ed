// axisgate-sim with Keya drives on ptys, and its words for what their motors really do.
#include "tests/unit/simulated/program_bench.hpp"

namespace axisgate::simulated {
namespace {

class KeyaProgram : public ProgramBench {
 protected:
  // Heartbeats may come before it.
  bool answers(const Descriptor& port, const std::string& text, const std::string& wanted) {
    Bytes reply = exchange(port, {text.begin(), text.end()}, 1);
    for (int i = 0; i < 500; ++i) {
      if (std::string(reply.begin(), reply.end()).find(wanted) != std::string::npos) return true;
      const Bytes more = exchange(port, {}, 1, 10);
      reply.insert(reply.end(), more.begin(), more.end());
    }
    return false;
  }
  static void send(const Descriptor& port, const char* hex) {
    const Bytes bytes = from_hex(hex);
    (void)!::write(port.get(), bytes.data(), bytes.size());
  }
  bool comes_true(const std::string& line, const std::string& answer) const {
    for (int i = 0; i < 6000 && control(line) != answer; ++i) std::this_thread::sleep_for(milliseconds(10));
    return control(line) == answer;
  }
};

TEST_F(KeyaProgram, TellsWhatBothMotorsOnASerialLineDo) {
  start({"--line", folder / "cart:keya-rs232+0020=3+heartbeat=0", "--control", folder / "control", "--boot-ms",
         "600000"});
  ASSERT_TRUE(wait_for_log("control "));
  EXPECT_THAT(log(), testing::HasSubstr("keya-rs232@1"));
  const Descriptor port = open_port("cart");
  EXPECT_EQ(control("set cart/1 voltage 49"), "ok");
  EXPECT_EQ(exchange(port, from_hex("ED 05 00 00 00 00 00 00 00 00 00 00"), 12),
            from_hex("ED 05 31 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(control("state cart/1"), "ok disabled disabled");
  EXPECT_EQ(control("enabled cart/1"), "ok 0 0");
  EXPECT_EQ(control("last-command cart/1"), "ok never");
  EXPECT_EQ(control("faults cart/1"), "ok 0x00000001 0x00000001");
  send(port, "E0 03 00 00 00 00 00 64 00 00 00 00");
  EXPECT_TRUE(comes_true("enabled cart/1", "ok 1 1"));
  EXPECT_EQ(control("state cart/1"), "ok absolute speed");
  EXPECT_EQ(control("moves cart/1"), "ok 1 0");
  EXPECT_THAT(control("last-command cart/1"), testing::MatchesRegex("ok [0-9]+ ms ago"));
  EXPECT_TRUE(comes_true("position cart/1", "ok 100 0"));
  EXPECT_TRUE(comes_true("trips cart/1", "ok 1"));
  EXPECT_EQ(control("faults cart/1"), "ok 0x00008001 0x00008001");
  EXPECT_EQ(control("commands cart/1"), "ok 1");
  EXPECT_EQ(control("fault cart/1 B 0x0800"), "ok");
  EXPECT_EQ(control("faults cart/1"), "ok 0x00008001 0x00008801");
  EXPECT_EQ(control("clear cart/1 B 0x0800"), "ok");
  EXPECT_EQ(control("set cart/1 count B -7"), "ok");
  EXPECT_EQ(control("position cart/1"), "ok 100 -7");
  EXPECT_EQ(control("jam cart/1 A on"), "ok");
  EXPECT_EQ(control("heartbeat cart/1 20"), "ok");
  EXPECT_EQ(exchange(port, {}, 12).front(), 0xEE);
  EXPECT_THAT(control("fault cart/1 C 1"), testing::HasSubstr("write A or B"));
  EXPECT_THAT(control("exception cart/1 4"), testing::HasSubstr("Modbus RTU alone"));
  EXPECT_EQ(control("restart cart/1"), "ok");
  EXPECT_EQ(control("state cart/1"), "ok booting");
  EXPECT_EQ(control("restarts cart/1"), "ok 1");
}

TEST_F(KeyaProgram, SpeaksBothCanProtocolsBehindALawicelAdapter) {
  start({"--line", folder / "bus:lawicel:keya-can@1,keya-kydas4860-2e@2", "--control", folder / "control"});
  ASSERT_TRUE(wait_for_log("control "));
  const Descriptor port = open_port("bus");
  ASSERT_TRUE(answers(port, "S5\rO\r", "\r\r"));
  EXPECT_EQ(control("heartbeat-twice bus/1 on"), "ok");
  EXPECT_EQ(control("heartbeat-twice bus/1 off"), "ok");
  EXPECT_TRUE(answers(port, "T060000018400D210200000000\r", "T058000018600D210200000030\r"));
  EXPECT_TRUE(answers(port, "t60284013200000000000\r", "t58284B13200030000000\r"));
  EXPECT_EQ(control("set bus/2 temperature 40"), "ok");
  EXPECT_EQ(control("get bus/2 203C.00"), "ok 40 0x00000028");
  EXPECT_EQ(control("set bus/2 2013.00 51"), "ok");
  EXPECT_EQ(control("get bus/2 2013.00"), "ok 51 0x00000033");
  EXPECT_EQ(control("nmt bus/2"), "ok pre_operational");
  EXPECT_THAT(control("nmt bus/1"), testing::HasSubstr("no command"));
  EXPECT_EQ(control("enabled bus/1"), "ok 0 0");
}

}  // namespace
}  // namespace axisgate::simulated
