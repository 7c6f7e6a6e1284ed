#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

using enum Command;

class CoilWrites : public ::testing::Test {
 protected:
  /// FC 15 of coils 0.. of axis 1; `bits` with coil 0 lowest.
  std::string write_row(unsigned bits, int count = 8) {
    const std::string data = count > 8 ? word((bits & 0xFF) << 8 | bits >> 8) : word(bits).substr(3);
    return plc.ask("0F 00 64" + word(count) + (count > 8 ? "02" : "01") + data);
  }
  Desk desk;
  Line plc{desk};
};

TEST_F(CoilWrites, EachCoilAsksForItsCommand) {
  const std::pair<int, Command> on[] = {{0, enable},        {1, fault_reset},   {2, quick_stop}, {3, halt},
                                        {4, move_absolute}, {5, move_relative}, {6, home},       {7, run_velocity}};
  EXPECT_TRUE(is_done(plc.write_coil(107, false))) << "run_velocity acts after a 0 alone";
  EXPECT_EQ(commands(desk), std::vector{end_run});
  for (const auto& [coil, command] : on) {
    EXPECT_EQ(plc.write_coil(static_cast<std::uint16_t>(100 + coil), true),
              "05 00 " + word(100 + coil).substr(3) + " FF 00");
    EXPECT_EQ(commands(desk), std::vector{command}) << coil;
  }
  EXPECT_TRUE(is_done(plc.write_coil(100, false)));
  EXPECT_EQ(commands(desk), std::vector{disable});
  EXPECT_TRUE(is_done(plc.write_coil(103, false)));
  EXPECT_EQ(commands(desk), std::vector{end_halt});
  EXPECT_TRUE(is_done(plc.write_coil(107, false)));
  EXPECT_EQ(commands(desk), std::vector{end_run});
  for (const int edge : {1, 2, 4, 5, 6})
    EXPECT_TRUE(is_done(plc.write_coil(static_cast<std::uint16_t>(100 + edge), false)));
  EXPECT_TRUE(commands(desk).empty());
}

TEST_F(CoilWrites, ReservedCoilsTakeA0) {
  for (int coil = 10; coil < 16; ++coil) {
    EXPECT_TRUE(is_done(plc.write_coil(static_cast<std::uint16_t>(100 + coil), false)));
    EXPECT_EQ(plc.write_coil(static_cast<std::uint16_t>(100 + coil), true), "85 02");
  }
  EXPECT_TRUE(is_done(write_row(0, 16)));
  EXPECT_EQ(write_row(0x0400, 16), "8F 02");
}

TEST_F(CoilWrites, CoilsBeyond15AreNoAddress) {
  EXPECT_EQ(plc.write_coil(116, false), "85 02");
  EXPECT_EQ(plc.ask("0F 00 64 00 11 03 00 00 00"), "8F 02");
  EXPECT_EQ(plc.write_coil(0, true), "85 02");
  EXPECT_EQ(plc.write_coil(300, true), "85 02");
  EXPECT_EQ(plc.write_coil(60010, true), "85 02");
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST_F(CoilWrites, ACoilThatTheDriveCannotDoIsNoAddress) {
  desk.axis(1).supported_commands &= ~(1U << 10);
  EXPECT_EQ(plc.write_coil(106, true), "85 02");
  EXPECT_EQ(write_row(0x40), "8F 02");
  EXPECT_TRUE(is_done(write_row(0)));
}

TEST_F(CoilWrites, AFirstRowIsOnlyRememberedButForStops) {
  EXPECT_TRUE(is_done(write_row(0x71)));
  EXPECT_TRUE(commands(desk).empty());
  Line panel(desk, Role::operator_, kPanel);
  EXPECT_TRUE(is_done(panel.ask("0F 00 64 00 08 01 75")));
  EXPECT_EQ(commands(desk), std::vector{quick_stop});
}

TEST_F(CoilWrites, CoilsThatActTogetherRunOneAfterAnotherInASafeOrder) {
  EXPECT_TRUE(is_done(write_row(0)));
  desk.port.slow = true;
  EXPECT_EQ(write_row(0x43), "") << "enable, fault_reset and home";
  EXPECT_EQ(commands(desk), std::vector{fault_reset});
  desk.port.finish();
  EXPECT_EQ(commands(desk), std::vector{enable});
  EXPECT_EQ(plc.reply(), "");
  desk.port.finish();
  EXPECT_EQ(commands(desk), std::vector{home});
  desk.port.finish();
  EXPECT_EQ(plc.reply(), "0F 00 64 00 08");
}

TEST_F(CoilWrites, TheFirstFailureIsTheAnswerAndEndsTheRow) {
  EXPECT_TRUE(is_done(write_row(0)));
  desk.port.slow = true;
  EXPECT_EQ(write_row(0x03), "");
  desk.port.finish({Errc::refused_by_drive, 0x1234});
  EXPECT_EQ(plc.reply(), "8F 04");
  EXPECT_EQ(commands(desk), std::vector{fault_reset});
}

TEST_F(CoilWrites, AStopDropsTheStartsOfItsOwnRequest) {
  EXPECT_TRUE(is_done(write_row(0)));
  EXPECT_EQ(write_row(0x14), "8F 06") << "quick_stop and start_absolute";
  EXPECT_EQ(commands(desk), std::vector{quick_stop});
  EXPECT_EQ(plc.read(125), "00 06") << "never started";
  EXPECT_TRUE(is_done(write_row(0)));
  EXPECT_EQ(write_row(0x05), "8F 06") << "quick_stop and enable";
  EXPECT_EQ(commands(desk), std::vector{quick_stop});
}

TEST_F(CoilWrites, HaltAndEnableDoNotContradict) {
  EXPECT_TRUE(is_done(write_row(0)));
  EXPECT_TRUE(is_done(write_row(0x09)));
  EXPECT_EQ(commands(desk), (std::vector{halt, enable}));
}

TEST_F(CoilWrites, TwoStartsAtOnceAreNoPossibleValue) {
  EXPECT_TRUE(is_done(write_row(0)));
  EXPECT_EQ(write_row(0x30), "8F 03");
  EXPECT_TRUE(commands(desk).empty());
  EXPECT_TRUE(is_done(write_row(0x10))) << "nothing was remembered of the refused one";
  EXPECT_EQ(commands(desk), std::vector{move_absolute});
}

TEST_F(CoilWrites, Function15OfOneCoilIsASingleWrite) {
  EXPECT_TRUE(is_done(plc.ask("0F 00 64 00 01 01 01")));
  EXPECT_EQ(commands(desk), std::vector{enable});
}

TEST_F(CoilWrites, AWriteThatDoesNotActIsAnsweredWithoutException) {
  EXPECT_TRUE(is_done(plc.write_coil(101, true)));
  EXPECT_TRUE(is_done(plc.write_coil(101, true)));
  EXPECT_EQ(commands(desk), std::vector{fault_reset});
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
