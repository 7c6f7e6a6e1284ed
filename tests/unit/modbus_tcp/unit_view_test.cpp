#include "gateway/upstream/modbus_tcp/unit_view.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

TEST(UnitIds, AnyShowsTheFlatMapByDefault) {
  Desk desk;
  Line plc(desk);
  for (const int unit : {0, 1, 17, 247, 255}) {
    EXPECT_EQ(plc.read(0, 1, static_cast<std::uint8_t>(unit)), "00 01") << unit;
    EXPECT_EQ(plc.read(518, 1, static_cast<std::uint8_t>(unit)), "00 02") << unit;
  }
}

class PerAxisUnits : public ::testing::Test {
 protected:
  PerAxisUnits() {
    desk.settings.per_axis_units = true;
    desk.axis(5)[Quantity::position_actual].value = 0x01020304;
    desk.axis(5).level_coils = 1;
    desk.axis(5).inputs = bit(AxisInput::online) | bit(AxisInput::enabled);
  }
  Desk desk;
  Line plc{desk};
};

TEST_F(PerAxisUnits, ShowTheirAxisAloneFrom0To99) {
  EXPECT_EQ(plc.read(2, 2, 5), "01 02 03 04");
  EXPECT_EQ(plc.ask("03 00 00 00 64", 5).size(), 3U * 202 - 1);
  EXPECT_EQ(plc.ask("03 00 00 00 65", 5), "83 02");
  EXPECT_EQ(plc.ask("03 01 F6 00 02", 5), "83 02") << "502: the flat address";
}

TEST_F(PerAxisUnits, ShowCoilsAndInputsAlike) {
  EXPECT_EQ(plc.ask("01 00 00 00 08", 5), "01 01 01");
  EXPECT_EQ(plc.ask("02 00 00 00 08", 5), "02 01 05");
  EXPECT_EQ(plc.ask("02 01 F4 00 08", 5), "82 02");
  EXPECT_EQ(plc.ask("05 00 02 FF 00", 5), "05 00 02 FF 00");
  EXPECT_EQ(desk.port.submitted.back().axis, 5);
  EXPECT_EQ(desk.port.submitted.back().group.command, Command::quick_stop);
}

TEST_F(PerAxisUnits, WriteToTheirAxis) {
  EXPECT_EQ(plc.ask("06 00 36 00 03", 5), "06 00 36 00 03");
  EXPECT_EQ(desk.port.submitted.back().axis, 5);
}

TEST_F(PerAxisUnits, ShowTheFlatMapAtUnit255) {
  EXPECT_EQ(plc.read(502, 2, 255), "01 02 03 04");
  EXPECT_EQ(plc.read(10, 2, 255), "01 02 03 04");
}

TEST_F(PerAxisUnits, AnswerOtherUnits0x0A) {
  for (const int unit : {0, 3, 4, 6, 254}) {
    EXPECT_EQ(plc.ask("03 00 00 00 01", static_cast<std::uint8_t>(unit)), "83 0A") << unit;
    EXPECT_EQ(plc.ask("06 00 36 00 03", static_cast<std::uint8_t>(unit)), "86 0A") << unit;
  }
  EXPECT_TRUE(desk.port.submitted.empty());
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
