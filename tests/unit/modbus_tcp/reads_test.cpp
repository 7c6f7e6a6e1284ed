#include "gateway/upstream/modbus_tcp/reads.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

class Reads : public ::testing::Test {
 protected:
  Desk desk;
  Line plc{desk};
};

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

TEST_F(Reads, AgeIsOfTheOldestCyclicValueAndSaturates) {
  EXPECT_EQ(plc.read(119), "00 00");
  desk.runtime.advance_by(1234ms);
  EXPECT_EQ(plc.read(119), word(1234));
  desk.runtime.advance_by(70s);
  EXPECT_EQ(plc.read(119), "FF FF");
  desk.axis(1).oldest_cyclic = kLongAgo;
  EXPECT_EQ(plc.read(119), "FF FF") << "never";
}

TEST_F(Reads, UnlistedOffsetsRead0) {
  for (const int offset : {39, 57, 61, 87, 90, 99}) {
    EXPECT_EQ(plc.read(static_cast<std::uint16_t>(100 + offset)), "00 00") << offset;
  }
  EXPECT_EQ(plc.read(50), "00 00");
  EXPECT_EQ(plc.read(50050), "00 00");
}

TEST_F(Reads, JogVelocityOfAnotherVersionReads0) { EXPECT_EQ(plc.read(158, 2), "00 00 00 00"); }

TEST_F(Reads, ARangeMayBeginAndEndInsideALongValue) {
  desk.axis(1)[Quantity::position_actual].value = 0x11223344;
  desk.axis(1)[Quantity::velocity_actual].value = 0x55667788;
  EXPECT_EQ(plc.read(103, 2), "33 44 55 66");
  EXPECT_EQ(plc.read(102), "11 22");
  EXPECT_EQ(plc.read(105), "77 88");
}

TEST_F(Reads, ACyclicScannersBlockIsReadWhole) {
  const std::string block = plc.read(100, 39);
  EXPECT_EQ(bytes(block).size(), 78U);
  EXPECT_EQ(plc.ask("03" + word(100) + word(100)).size(), 3U * 202 - 1) << "the whole block";
}

TEST_F(Reads, InputRegistersShowTheSame) {
  desk.axis(1)[Quantity::position_actual].value = -5;
  EXPECT_EQ(plc.ask("04 00 66 00 02"), "04 04 FF FF FF FB");
  EXPECT_EQ(plc.ask("03 00 66 00 02"), "03 04 FF FF FF FB");
}

TEST_F(Reads, WordOrderIsTheListeners) {
  desk.axis(1)[Quantity::position_actual].value = 0x11223344;
  desk.settings.low_word_first = true;
  EXPECT_EQ(plc.read(102, 2), "33 44 11 22");
  EXPECT_EQ(plc.read(103, 1), "11 22");
  EXPECT_EQ(plc.read(10, 2), "03 04 01 02");
  EXPECT_EQ(plc.read(119), "00 00") << "16 bits have no order";
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

TEST_F(Reads, AddressesOutsideEveryBlockAreRefused) {
  for (const int address : {300, 399, 400, 600, 49999, 50200, 59999, 65000, 65535}) {
    EXPECT_EQ(plc.ask("03" + word(address) + word(1)), "83 02") << address;
    EXPECT_EQ(plc.ask("04" + word(address) + word(1)), "84 02") << address;
  }
  EXPECT_EQ(plc.ask("03 FF FF 00 02"), "83 02") << "past the end of all addresses";
  EXPECT_EQ(plc.ask("03" + word(290) + word(20)), "83 02") << "into the block of an axis that is not there";
  EXPECT_EQ(bytes(plc.read(190, 20)).size(), 40U) << "from one axis into the next";
}

TEST_F(Reads, CoilsShowTheAxissStateAndEdgeCoils0) {
  desk.axis(1).level_coils = 0xFFFF;
  EXPECT_EQ(plc.ask("01 00 64 00 10"), "01 02 89 03");
  EXPECT_EQ(plc.ask("01 00 67 00 01"), "01 01 01");
  desk.axis(1).link_state = LinkState::offline;
  EXPECT_EQ(plc.ask("01 00 64 00 10"), "01 02 00 00");
}

TEST_F(Reads, DiscreteInputsShowTheAxis) {
  desk.axis(1).inputs = 0x1FFF;
  EXPECT_EQ(plc.ask("02 00 64 00 0D"), "02 02 FF 17") << "owned_by_me is 0 in this version";
  EXPECT_EQ(plc.ask("02 00 6C 00 05"), "02 01 17");
}

TEST_F(Reads, BitsOfSeveralAxesAreReadInOneRequest) {
  desk.axis(1).inputs = 1;
  desk.axis(2).inputs = 1;
  const std::string answer = plc.ask("02" + word(100) + word(200));
  ASSERT_EQ(bytes(answer).size(), 27U);
  EXPECT_EQ(bytes(answer)[2], 0x01);
  EXPECT_EQ(bytes(answer)[2 + 12], 0x10) << "bit 100";
}

TEST_F(Reads, BitsExistInTheBlocksOfAxesOnly) {
  for (const int address : {0, 50, 300, 50000, 60010, 65535}) {
    EXPECT_EQ(plc.ask("01" + word(address) + word(1)), "81 02") << address;
    EXPECT_EQ(plc.ask("02" + word(address) + word(1)), "82 02") << address;
  }
  EXPECT_EQ(plc.ask("02" + word(299) + word(2)), "82 02");
}

TEST_F(Reads, AnOfflineAxisStillAnswersWithItsStatusCleared) {
  AxisImage& axis = desk.axis(1);
  axis[Quantity::statusword].value = 0x1237;
  axis[Quantity::position_actual].value = 42;
  axis.inputs = 0x17FF;
  axis.link_state = LinkState::offline;
  EXPECT_EQ(plc.read(100), "00 00");
  EXPECT_EQ(plc.read(102, 2), words(42)) << "the last good number";
  EXPECT_EQ(plc.read(110), "81 30");
  EXPECT_EQ(plc.read(122, 2), "00 00 00 00") << "no valid bit";
  EXPECT_EQ(plc.ask("02 00 64 00 0D"), "02 02 00 10") << "the stop latch is the gateway's own";
  EXPECT_EQ(plc.read(60010), "00 00");
  EXPECT_EQ(plc.read(60017), "81 30");
}

TEST_F(Reads, WithOfflineReadsExceptionAnyAxisOfTheRangeThatIsOfflineAnswers0x0B) {
  desk.settings.offline_reads_fail = true;
  desk.axis(2).link_state = LinkState::link_down;
  EXPECT_EQ(plc.ask("03 00 C8 00 01"), "83 0B");
  EXPECT_EQ(plc.ask("03" + word(190) + word(20)), "83 0B") << "from axis 1 into axis 2";
  EXPECT_EQ(plc.ask("02 00 C8 00 01"), "82 0B");
  EXPECT_EQ(plc.ask("01 00 C8 00 01"), "81 0B");
  EXPECT_EQ(plc.ask("03" + word(60010) + word(20)), "83 0B");
  EXPECT_EQ(bytes(plc.read(100, 40)).size(), 80U);
  EXPECT_EQ(plc.read(0), "00 01") << "the gateway is there";
}

TEST_F(Reads, WhatBelongsToTheClientIsItsOwn) {
  Line panel(desk, Role::operator_, kPanel);
  EXPECT_EQ(plc.write(156, 0x1111), "06 00 9C 11 11");
  EXPECT_EQ(panel.write(156, 0x2222), "06 00 9C 22 22");
  EXPECT_EQ(plc.write(8, 5), "06 00 08 00 05");
  EXPECT_EQ(plc.write_block(154, "00 03 00 09"), "10 00 9A 00 02");
  EXPECT_EQ(plc.read(154, 3), "00 03 00 09 11 11");
  EXPECT_EQ(panel.read(154, 3), "00 00 00 00 22 22");
  EXPECT_EQ(plc.read(8), "00 05");
  EXPECT_EQ(panel.read(8), "00 00");
}

TEST_F(Reads, SetPositionValueIsTheAxissAndTheSameForEveryClient) {
  desk.port.set_positions[1] = -1000;
  EXPECT_EQ(plc.read(178, 2), words(-1000));
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
