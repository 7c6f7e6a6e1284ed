// SPDX-License-Identifier: Apache-2.0
// What registers show of the image, block by block.
#include "gateway/upstream/modbus_tcp/read/reads.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

using Reads = AtTheDesk;

TEST_F(Reads, EachQuantityOfTheAxisBlockStandsAtItsOffset) {
  std::int64_t number = 100;
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (row.source != Source::quantity) continue;
    const bool is_signed = row.type == RegisterType::i16 || row.type == RegisterType::i32;
    const std::int64_t value = is_signed ? -++number : ++number;
    desk.axis(2)[row.quantity].value = value;
    const auto address = static_cast<std::uint16_t>(200 + row.offset);
    EXPECT_EQ(plc.read(address, static_cast<std::uint16_t>(row.registers())),
              row.registers() == 2 ? words(value) : word(value))
        << row.name;
  }
}

TEST_F(Reads, TheOtherRowsOfTheAxisBlockShowTheAxis) {
  AxisImage& axis = desk.axis(1);
  axis.supported = 0x81234567;
  axis.link_state = LinkState::suspect;
  axis.axis_state = AxisState::homing;
  axis.motion_state = MotionState::aborted;
  axis.motion_id = 77;
  axis.alarms = 0x00000802;
  axis.supported_commands = 0x00000FFE;
  axis.supported_modes = 0x002D;
  axis.sequence = 0x00012345;
  EXPECT_EQ(plc.read(118), "00 03");
  EXPECT_EQ(plc.read(120, 2), "81 23 45 67");
  EXPECT_EQ(plc.read(122, 2), words(axis.valid_bits()));
  EXPECT_EQ(plc.read(124), "23 45") << "the low 16 bits";
  EXPECT_EQ(plc.read(128, 2), "00 00 00 00") << "owner and lease";
  EXPECT_EQ(plc.read(131, 3), "00 04 00 03 00 4D");
  EXPECT_EQ(plc.read(134, 2), "00 00 08 02");
  EXPECT_EQ(plc.read(136, 2), "00 00 0F FE");
  EXPECT_EQ(plc.read(138), "00 2D");
}

TEST_F(Reads, TellThePositionUnitOfTheAxisAndTheMotorsSpeed) {
  EXPECT_EQ(plc.read(190, 8), words(10000) + " " + words(1) + " FF FF FF FF 00 00 00 00") << "not known, and nobody";
  desk.axis(1).units_per_rev = Rational(60000, 37);
  desk.axis(1).rated_speed = 3'000'000;
  EXPECT_EQ(plc.read(190, 6), words(60000) + " " + words(37) + " " + words(3'000'000));
  EXPECT_EQ(plc.read(290, 6), words(10000) + " " + words(1) + " FF FF FF FF") << "another axis";
  desk.settings.low_word_first = true;
  EXPECT_EQ(plc.read(194, 2), "C6 C0 00 2D");
  desk.settings.per_axis_units = true;
  EXPECT_EQ(plc.read(94, 2, 1), "C6 C0 00 2D");
  EXPECT_EQ(plc.read(94, 2, 2), "FF FF FF FF");
  desk.axis(1).link_state = LinkState::offline;
  EXPECT_EQ(plc.read(94, 2, 1), "C6 C0 00 2D") << "no value of the drive's";
}

TEST_F(Reads, AgeIsOfTheOldestCyclicValueAndSaturates) {
  EXPECT_EQ(plc.read(119), "00 00");
  desk.runtime.advance_by(1234ms);
  EXPECT_EQ(plc.read(119), word(1234));
  desk.runtime.advance_by(70s);
  EXPECT_EQ(plc.read(119), "FF FF");
  desk.axis(1).oldest_cyclic = kLongAgo;
  EXPECT_EQ(plc.read(119), "FF FF") << "never";
}

TEST_F(Reads, TheGatewayBlockShowsTheGatewayAndWhoAsks) {
  int refreshed = 0;
  desk.image.refresh = [&] {
    ++refreshed;
    desk.image.gateway = {GatewayState::degraded, 2, 0x00012345, 0x0103};
  };
  EXPECT_EQ(plc.read(0, 12), "00 01 00 03 00 02 00 02 00 01 23 45 01 03 00 03 00 00 00 00 01 02 03 04");
  EXPECT_EQ(refreshed, 1);
  static_cast<void>(plc.read(100, 40));
  EXPECT_EQ(refreshed, 1) << "nobody looked";
  Line panel(desk, Role::viewer, kPanel);
  EXPECT_EQ(panel.read(7), "00 01");
}

TEST_F(Reads, ABusBlockShowsItsBus) {
  desk.image.buses[1] = {"can0", 1, 123, 45, 6, 70000, 69999, 1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(
      plc.read(50100, 24),
      "00 01 00 7B 00 2D 00 06 00 01 11 70 00 01 11 6F 00 00 00 01 00 00 00 02 00 00 00 03 00 00 00 04 00 00 00 05 "
      "00 00 00 06 00 00 00 07 00 00 00 08");
  EXPECT_EQ(plc.ask("03" + word(50200) + word(1)), "83 02") << "no third bus";
}

TEST_F(Reads, TheOverviewShowsTwelveAxesInOneRequestAndGapsAs0) {
  AxisImage& axis = desk.axis(5);
  axis[Quantity::statusword].value = 0x1637;
  axis[Quantity::mode_display].value = -3;
  axis[Quantity::position_actual].value = -2;
  axis[Quantity::velocity_actual].value = 0x10002;
  axis[Quantity::torque_actual].value = -7;
  axis[Quantity::error_code].value = 0x2310;
  axis.sequence = 9;
  EXPECT_EQ(plc.read(60050, 10), "16 37 FF FD FF FF FF FE 00 01 00 02 FF F9 23 10 00 02 00 09");
  EXPECT_EQ(bytes(plc.read(60010, 50)).size(), 100U) << "axes 3 and 4 are a gap";
  EXPECT_EQ(plc.read(60030, 10), "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
  EXPECT_EQ(plc.ask("03" + word(60060) + word(1)), "83 02") << "beyond the last axis";
  EXPECT_EQ(plc.ask("03" + word(60050) + word(11)), "83 02");
  for (AxisNumber n = 6; n <= 13; ++n) desk.image.add_axis(n, "", 0);
  EXPECT_EQ(bytes(plc.read(60010, 120)).size(), 240U);
}

TEST_F(Reads, BitsOfSeveralAxesAreReadInOneRequest) {
  desk.axis(1).inputs = 1;
  desk.axis(2).inputs = 1;
  const std::string answer = plc.ask("02" + word(100) + word(200));
  ASSERT_EQ(bytes(answer).size(), 27U);
  EXPECT_EQ(bytes(answer)[2], 0x01);
  EXPECT_EQ(bytes(answer)[2 + 12], 0x10) << "bit 100";
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
