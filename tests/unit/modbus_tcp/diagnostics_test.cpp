#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

TEST(Diagnostics, ReturnQueryDataEchoesWhateverItIsGiven) {
  Desk desk;
  Line plc(desk);
  EXPECT_EQ(plc.ask("08 00 00 A5 37"), "08 00 00 A5 37");
  EXPECT_EQ(plc.ask("08 00 00 01 02 03 04 05 06"), "08 00 00 01 02 03 04 05 06");
}

TEST(Diagnostics, CountersCountAndAreCleared) {
  Desk desk;
  Line plc(desk);
  EXPECT_EQ(plc.ask("08 00 0A 00 00"), "08 00 0A 00 00");
  static_cast<void>(plc.read(100));
  EXPECT_EQ(plc.read(300), "83 02");
  {
    Line broken(desk, Role::viewer, kPanel);
    broken.feed(bytes("00 01 00 07"));
    Line leaves(desk, Role::operator_, kPanel);
    desk.port.slow = true;
    leaves.send("06 00 92 00 01");
  }
  // Five requests: the clear itself was counted before it cleared.
  EXPECT_EQ(plc.ask("08 00 0B 00 00"), "08 00 0B 00 04") << "messages";
  EXPECT_EQ(plc.ask("08 00 0C 00 00"), "08 00 0C 00 01") << "malformed";
  EXPECT_EQ(plc.ask("08 00 0D 00 00"), "08 00 0D 00 01") << "exceptions";
  EXPECT_EQ(plc.ask("08 00 0E 00 00"), "08 00 0E 00 06") << "processed: the clear, two reads, three counters";
  EXPECT_EQ(plc.ask("08 00 0F 00 00"), "08 00 0F 00 01") << "not answered";
  EXPECT_EQ(plc.ask("08 00 0A 00 00"), "08 00 0A 00 00");
  EXPECT_EQ(plc.ask("08 00 0C 00 00"), "08 00 0C 00 00");
}

TEST(Diagnostics, CountersShowTheirLow16Bits) {
  Desk desk;
  Line plc(desk);
  desk.registry.counters.malformed = 0x12345;
  EXPECT_EQ(plc.ask("08 00 0C 00 00"), "08 00 0C 23 45");
}

TEST(Diagnostics, SubFunctionsOfSerialLinesDoNotExistHere) {
  Desk desk;
  Line plc(desk);
  for (const int sub : {1, 2, 3, 4, 9, 16, 17, 18, 20, 21, 0xFFFF}) {
    EXPECT_EQ(plc.ask("08" + word(sub) + "00 00"), "88 01") << sub;
  }
}

TEST(Diagnostics, ADataFieldOtherThan0IsRefusedWhereNoneIsMeant) {
  Desk desk;
  Line plc(desk);
  EXPECT_EQ(plc.ask("08 00 0B 00 01"), "88 03");
  EXPECT_EQ(plc.ask("08 00 0B 00 00 00 00"), "88 03");
  EXPECT_EQ(plc.ask("08 00 0A FF 00"), "88 03");
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
