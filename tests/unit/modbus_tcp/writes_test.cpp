#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

class Writes : public ::testing::Test {
 protected:
  const Group& last() { return desk.port.submitted.back().group; }
  Desk desk;
  Line plc{desk};
};

TEST_F(Writes, EveryWritableQuantityArrivesAsItself) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable || row.source != Source::quantity || row.quantity == Quantity::controlword ||
        row.quantity == Quantity::mode) {
      continue;
    }
    SCOPED_TRACE(row.name);
    const bool is_signed = row.type == RegisterType::i16 || row.type == RegisterType::i32;
    const std::int64_t value = is_signed ? -1234 : 1234;
    const auto address = static_cast<std::uint16_t>(100 + row.offset);
    EXPECT_TRUE(is_done(plc.write_block(address, row.registers() == 2 ? words(value) : word(value))));
    ASSERT_EQ(last().setpoints.size(), 1U);
    EXPECT_EQ(last().setpoints[0].quantity, row.quantity);
    EXPECT_EQ(last().setpoints[0].value, value);
  }
}

TEST_F(Writes, ASingleRegisterIsWrittenByFunction6) {
  EXPECT_EQ(plc.write(146, -250), "06 00 92 FF 06");
  ASSERT_EQ(last().setpoints.size(), 1U);
  EXPECT_EQ(last().setpoints[0].quantity, Quantity::target_torque);
  EXPECT_EQ(last().setpoints[0].value, -250);
}

TEST_F(Writes, ModeIsSigned) {
  EXPECT_EQ(plc.write(141, -3), "06 00 8D FF FD");
  EXPECT_EQ(last().mode, -3);
  EXPECT_TRUE(last().setpoints.empty());
}

TEST_F(Writes, LowWordFirstIsTheListenersOrder) {
  desk.settings.low_word_first = true;
  EXPECT_TRUE(is_done(plc.write_block(142, "33 44 11 22")));
  EXPECT_EQ(last().setpoints[0].value, 0x11223344);
}

TEST_F(Writes, AllQuantitiesOfOneRequestFormOneGroup) {
  static_cast<void>(plc.write_block(140, "00 0F"));  // memory of the controlword
  desk.port.submitted.clear();
  // controlword 1F, mode 1, target position 7, velocity 8, torque 9, max torque 10
  EXPECT_TRUE(is_done(plc.write_block(140, "00 1F 00 01 00 00 00 07 00 00 00 08 00 09 00 0A")));
  ASSERT_EQ(desk.port.submitted.size(), 1U);
  EXPECT_EQ(last().controlword, 0x1F);
  EXPECT_FALSE(last().single_controlword);
  EXPECT_EQ(last().mode, 1);
  ASSERT_EQ(last().setpoints.size(), 4U);
  EXPECT_EQ(last().setpoints[0].quantity, Quantity::target_position);
  EXPECT_EQ(last().setpoints[3].quantity, Quantity::max_torque);
  EXPECT_EQ(last().setpoints[3].value, 10);
}

TEST_F(Writes, AGroupCarriesWhoAsksAndUntilWhen) {
  Line panel(desk, Role::operator_, kPanel);
  EXPECT_TRUE(is_done(panel.write(146, 1)));
  EXPECT_EQ(last().role, Role::operator_);
  EXPECT_EQ(last().start_by, desk.runtime.now() + 500ms);
  EXPECT_EQ(last().answer_by, desk.runtime.now() + 900ms);
  const ClientId panels = last().client;
  EXPECT_TRUE(is_done(plc.write(146, 2)));
  EXPECT_NE(last().client, panels);
}

TEST_F(Writes, AControlwordAloneIsASingleOne) {
  EXPECT_EQ(plc.write(140, 6), "06 00 8C 00 06");
  EXPECT_EQ(last().controlword, 6);
  EXPECT_TRUE(last().single_controlword);
  EXPECT_TRUE(is_done(plc.write_block(140, "00 07")));
  EXPECT_EQ(last().controlword, 7);
  EXPECT_TRUE(last().single_controlword) << "FC 16 of one register";
  EXPECT_TRUE(is_done(plc.write_block(140, "00 0F 00 01")));
  EXPECT_EQ(last().controlword, 0x0F);
  EXPECT_FALSE(last().single_controlword);
}

TEST_F(Writes, HalfOfALongValueIsNoAddress) {
  EXPECT_EQ(plc.write(142, 1), "86 02");
  EXPECT_EQ(plc.write(143, 1), "86 02");
  EXPECT_EQ(plc.write_block(143, "00 00 00 01"), "90 02") << "begins inside";
  EXPECT_EQ(plc.write_block(141, "00 01 00 00"), "90 02") << "ends inside";
  EXPECT_EQ(plc.ask("16 00 8E 00 00 00 00"), "96 02") << "FC 22";
  EXPECT_EQ(plc.write(178, 1), "86 02") << "set_position_value";
  EXPECT_EQ(plc.write(185, 1), "86 02") << "object_data";
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST_F(Writes, ReadOnlyRowsAreAlways0x02) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (row.writable) continue;
    const std::string zeros = row.registers() == 2 ? "00 00 00 00" : "00 00";
    EXPECT_EQ(plc.write_block(static_cast<std::uint16_t>(100 + row.offset), zeros), "90 02") << row.name;
  }
  EXPECT_EQ(plc.write_block(185, "00 00 00 00 00 00"), "90 02") << "in a longer write too";
  for (const int address : {0, 7, 9, 10, 50000, 60010, 300, 65535}) {
    EXPECT_EQ(plc.write(static_cast<std::uint16_t>(address), 0), "86 02") << address;
  }
}

TEST_F(Writes, UnlistedOffsetsAreIgnoredInALongerWriteAndRefusedAlone) {
  EXPECT_EQ(plc.write(157, 5), "86 02");
  EXPECT_EQ(plc.write(161, 5), "86 02");
  EXPECT_EQ(plc.write(187, 5), "86 02");
  EXPECT_TRUE(is_done(plc.write_block(156, "00 07 12 34"))) << "heartbeat and 57";
  EXPECT_EQ(plc.read(156), "00 07");
  EXPECT_TRUE(is_done(plc.write_block(160, "00 11 12 34 00 00 00 63")));
  ASSERT_EQ(last().setpoints.size(), 2U);
  EXPECT_EQ(last().setpoints[0].value, 17);
  EXPECT_EQ(last().setpoints[1].value, 99);
  EXPECT_EQ(plc.write(139, 5), "86 02") << "39 is below the writable rows";
  EXPECT_EQ(plc.write_block(139, "00 00 00 0F"), "90 02");
  EXPECT_EQ(plc.write_block(190, "00 00 00 00"), "90 02") << "90 and 91 are above";
}

TEST_F(Writes, WhatTheDriveDoesNotHaveIsNoAddress) {
  desk.axis(1).supported &= ~bit(Quantity::max_torque);
  desk.axis(1).writable &= ~bit(Quantity::homing_offset);
  desk.axis(1).supported_commands &= ~((1U << 8) | (1U << 9) | (1U << 11) | (1U << 13) | (1U << 14));
  EXPECT_EQ(plc.write(147, 1), "86 02");
  EXPECT_EQ(plc.write_block(168, "00 00 00 01"), "90 02") << "supported, but this drive cannot write it";
  EXPECT_EQ(plc.write(154, 9), "86 02") << "run_torque";
  EXPECT_EQ(plc.write_block(178, "00 00 00 01"), "90 02") << "set_position_value without the command";
  EXPECT_EQ(plc.write(154, 13), "86 02") << "release, where leases are off";
  EXPECT_EQ(plc.write(154, 14), "86 02");
  EXPECT_EQ(plc.write_block(158, "00 00 00 01"), "90 02") << "jog_velocity without run_velocity";
  EXPECT_EQ(plc.write_block(158, "00 00 00 00"), "90 02");
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST_F(Writes, ABlockMayCarryBackWhatAMissingRowReads) {
  desk.axis(1).supported &= ~bit(Quantity::max_torque);
  EXPECT_TRUE(is_done(plc.write_block(146, "00 05 FF FF")));
  ASSERT_EQ(last().setpoints.size(), 1U);
  EXPECT_EQ(last().setpoints[0].quantity, Quantity::target_torque);
  EXPECT_EQ(plc.write_block(146, "00 06 00 01"), "90 02") << "any other value is asked of the drive in earnest";
  EXPECT_TRUE(is_done(plc.write_block(146, "00 07 00 00"))) << "0 asks nothing: one function block serves all axes";
  EXPECT_TRUE(is_done(plc.write_block(156, "00 07 00 00 00 00 00 00"))) << "jog_velocity 0, as it is";
}

TEST_F(Writes, Mode0InABlockLeavesTheModeToTheCommands) {
  EXPECT_TRUE(is_done(plc.write_block(141, "00 00 00 00 00 07")));
  EXPECT_FALSE(last().mode.has_value()) << "CiA 402: no mode change";
  ASSERT_EQ(last().setpoints.size(), 1U);
}

TEST_F(Writes, UnknownCommandsAndTheNumberThatMeansNoneAre0x03) {
  EXPECT_EQ(plc.write(154, 15), "86 03");
  EXPECT_EQ(plc.write(154, 30), "86 03") << "end_halt is no register value";
  EXPECT_EQ(plc.write(154, 65535), "86 03");
  EXPECT_EQ(plc.write(146, -32768), "86 03");
  EXPECT_EQ(plc.write_block(142, "80 00 00 00"), "90 03");
  EXPECT_EQ(plc.write_block(148, "FF FF FF FF"), "90 03");
  EXPECT_EQ(plc.write_block(178, "80 00 00 00"), "90 03");
  EXPECT_TRUE(is_done(plc.write(140, 65535))) << "a word of bits has no such number";
  EXPECT_EQ(desk.port.taken().size(), 1U);
}

TEST_F(Writes, AddressesAreCheckedBeforeValues) {
  EXPECT_EQ(plc.write_block(142, "80 00 00 00 00 00"), "90 02") << "a half behind an impossible value";
}

TEST_F(Writes, ARefusedRequestChangesNothing) {
  EXPECT_EQ(plc.write_block(154, "00 0F 00 09 00 07"), "90 03");
  EXPECT_EQ(plc.read(154, 3), "00 00 00 00 00 00");
  EXPECT_TRUE(is_done(plc.write(154, 1)));
  EXPECT_EQ(commands(desk), std::vector{Command::enable}) << "the memory is still empty";
}

TEST_F(Writes, ABlockAsksForWhatItsClientHasChangedWhateverTheDriveHolds) {
  desk.port.held = {{1, Quantity::target_position, 7}, {1, Quantity::mode, 1}};
  EXPECT_TRUE(is_done(plc.write_block(141, "00 01 00 00 00 07 00 00 00 08")));
  EXPECT_EQ(last().setpoints.size(), 2U) << "another target may have been accepted that the drive does not hold yet";
  EXPECT_EQ(last().mode, 1);
  EXPECT_TRUE(is_done(plc.write_block(141, "00 01 00 00 00 07 00 00 00 09")));
  ASSERT_EQ(last().setpoints.size(), 1U);
  EXPECT_EQ(last().setpoints[0].quantity, Quantity::target_velocity);
  EXPECT_FALSE(last().mode.has_value());
}

TEST_F(Writes, ABlockInWhichNothingIsNewAsksNothing) {
  EXPECT_EQ(plc.write_block(141, "00 01 00 00 00 07"), "10 00 8D 00 03");
  EXPECT_EQ(plc.write_block(141, "00 01 00 00 00 07"), "10 00 8D 00 03");
  ASSERT_EQ(desk.port.submitted.size(), 2U) << "for its client's ownership alone";
  EXPECT_TRUE(asks_nothing(last()));
}

TEST_F(Writes, AnOwnersBlockAsksForWhatIsNoLongerTheValueAcceptedLast) {
  EXPECT_TRUE(is_done(plc.write_block(141, "00 01 00 00 00 07")));
  desk.port.owner = last().client;
  desk.port.accepted[{1, Quantity::target_position}] = 9;
  EXPECT_TRUE(is_done(plc.write_block(141, "00 01 00 00 00 07")));
  ASSERT_EQ(last().setpoints.size(), 1U);
  EXPECT_EQ(last().setpoints[0].value, 7);
  Line panel(desk, Role::operator_, kPanel);
  static_cast<void>(panel.write_block(141, "00 01 00 00 00 07"));
  EXPECT_TRUE(is_done(panel.write_block(141, "00 01 00 00 00 07")));
  EXPECT_TRUE(asks_nothing(last())) << "nobody else's does";
}

TEST_F(Writes, ASingleRowIsAlwaysAskedOfThePort) {
  desk.port.held = {{1, Quantity::target_torque, 7}};
  EXPECT_TRUE(is_done(plc.write(146, 7)));
  EXPECT_EQ(desk.port.submitted.size(), 1U);
}

TEST_F(Writes, AScannersWholeBlockIsOneGroup) {
  // 40..56 as a PLC scans them, twice; then with a command in it.
  const std::string idle = "00 00 00 01 00 00 00 07 00 00 00 08 00 09 00 0A 00 00 00 0B 00 00 00 0C 00 00 00 0D";
  EXPECT_TRUE(is_done(plc.write_block(140, idle + "00 00 00 00 00 01")));
  ASSERT_EQ(desk.port.submitted.size(), 1U);
  EXPECT_EQ(last().command, Command::none);
  EXPECT_FALSE(last().controlword.has_value()) << "an empty memory is only filled";
  EXPECT_TRUE(last().setpoints.empty()) << "so are the set-points";
  EXPECT_TRUE(is_done(plc.write_block(140, idle + "00 06 00 00 00 02")));
  EXPECT_EQ(last().command, Command::move_absolute);
  ASSERT_EQ(last().setpoints.size(), 7U) << "beside a command that acts they ask";
  EXPECT_TRUE(last().setpoints[0].with_command);
  EXPECT_FALSE(last().mode.has_value()) << "the command selects the mode that it needs";
  EXPECT_TRUE(is_done(plc.write_block(140, idle + "00 06 00 00 00 03")));
  EXPECT_EQ(last().command, Command::none);
}

TEST_F(Writes, SetPositionValueGoesWithItsCommand) {
  static_cast<void>(plc.write(154, 0));
  EXPECT_TRUE(is_done(plc.write_block(178, words(-5000))));
  EXPECT_EQ(last().set_position_value, -5000);
  EXPECT_TRUE(is_done(plc.write(154, 11)));
  EXPECT_EQ(last().command, Command::set_position);
}

TEST_F(Writes, MasksApplyToWhatTheRegisterShows) {
  desk.axis(1)[Quantity::controlword].value = 0x0F;
  EXPECT_EQ(plc.ask("16 00 8C FF EF 00 10"), "16 00 8C FF EF 00 10");
  EXPECT_EQ(last().controlword, 0x1F);
  EXPECT_TRUE(last().single_controlword);
  EXPECT_EQ(plc.write(156, 0x12), "06 00 9C 00 12");
  EXPECT_TRUE(is_done(plc.ask("16 00 9C 00 F2 00 25")));
  EXPECT_EQ(plc.read(156), "00 17") << "the example of V1.1b3 6.16";
}

TEST_F(Writes, MasksOfACommandApplyToTheClientsOwnLastValue) {
  EXPECT_TRUE(is_done(plc.write(154, 2)));
  EXPECT_TRUE(is_done(plc.ask("16 00 9A FF FE 00 01")));
  EXPECT_EQ(commands(desk), (std::vector{Command::disable, Command::quick_stop}));
}

TEST_F(Writes, AMaskOnAValueNeverReceivedIsNoValue) {
  desk.axis(1)[Quantity::target_torque].received = false;
  EXPECT_EQ(plc.ask("16 00 92 FF F0 00 05"), "96 03");
  EXPECT_TRUE(is_done(plc.ask("16 00 92 00 00 00 05"))) << "all bits are given";
  EXPECT_EQ(last().setpoints[0].value, 5);
}

TEST_F(Writes, Function23WritesFirstAndReadsAfterItsResult) {
  desk.port.slow = true;
  EXPECT_EQ(plc.ask("17 00 66 00 02 00 8E 00 02 04 00 00 00 07"), "");
  desk.axis(1)[Quantity::position_actual].value = 99;
  desk.port.finish();
  EXPECT_EQ(plc.reply(), "17 04 00 00 00 63");
  EXPECT_GT(plc.told, 0);
}

TEST_F(Writes, AFunction23WhoseWriteFailsReadsNothing) {
  EXPECT_EQ(plc.ask("17 00 66 00 02 00 8F 00 01 02 00 07"), "97 02");
  desk.port.at_once = {{{Errc::offline, 0}, 0, 0}};
  EXPECT_EQ(plc.ask("17 00 66 00 02 00 92 00 01 02 00 07"), "97 0A");
}

TEST_F(Writes, AFunction23WhoseReadIsOutsideHasWrittenAllTheSame) {
  EXPECT_EQ(plc.ask("17 FF FF 00 01 00 92 00 01 02 00 07"), "97 02");
  EXPECT_EQ(desk.port.submitted.size(), 1U);
}

TEST_F(Writes, TheGatewaysHeartbeatIsTheClientsOwn) {
  EXPECT_EQ(plc.write(8, 77), "06 00 08 00 4D");
  EXPECT_EQ(plc.read(8), "00 4D");
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST_F(Writes, HeartbeatAndIdAskNothingOfTheAxis) {
  desk.axis(1).link_state = LinkState::offline;
  EXPECT_TRUE(is_done(plc.write(156, 1)));
  EXPECT_TRUE(is_done(plc.write(155, 1)));
  EXPECT_TRUE(is_done(plc.write(154, 0))) << "0 arms";
  EXPECT_EQ(desk.port.submitted.size(), 3U) << "each is a write of its client to the axis";
  for (const auto& each : desk.port.submitted) EXPECT_TRUE(asks_nothing(each.group));
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
