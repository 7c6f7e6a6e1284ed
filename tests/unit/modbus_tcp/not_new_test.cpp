// What does not act says so, zeros that ask for nothing, and what a refused block leaves behind: as a client meets them
// on its connection (design 3.3, "Edges").
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

using enum Command;
using Commands = std::vector<Command>;

class NotNew : public ::testing::Test {
 protected:
  const Group& last() { return desk.port.submitted.back().group; }
  std::string result() { return plc.read(125); }
  /// Registers 40 to 56: controlword, mode, targets, ramps, command, id, heartbeat.
  static std::string image(int controlword, int position, int command, int id, int heartbeat = 0) {
    return word(controlword) + "00 00" + words(position) + words(0) + "00 00 00 00" + words(0) + words(0) + words(0) +
           word(command) + word(id) + word(heartbeat);
  }
  std::string scan(int controlword, int position, int command, int id, int heartbeat = 0) {
    return plc.write_block(140, image(controlword, position, command, id, heartbeat));
  }
  Desk desk;
  Line plc{desk};
};

TEST_F(NotNew, ThreeTargetsWithinASecondAreNotAllDone) {
  const auto move_to = [&](int position) {
    EXPECT_TRUE(is_done(plc.write_block(142, words(position))));
    return plc.write(154, 6);
  };
  EXPECT_TRUE(is_done(move_to(1000)));
  desk.runtime.advance_by(300ms);
  EXPECT_EQ(move_to(2000), "86 06");
  EXPECT_EQ(result(), "00 0A");
  EXPECT_TRUE(is_done(plc.write(154, 0))) << "write 0 first";
  EXPECT_TRUE(is_done(plc.write(154, 6)));
  EXPECT_EQ(result(), "00 02");
  EXPECT_EQ(commands(desk), (Commands{move_absolute, move_absolute}));
}

TEST_F(NotNew, TheSameTargetPressedTwiceIsAnsweredNormally) {
  EXPECT_TRUE(is_done(plc.write_block(142, words(1000))));
  EXPECT_TRUE(is_done(plc.write(154, 6)));
  EXPECT_TRUE(is_done(plc.write_block(142, words(1000)))) << "no change";
  EXPECT_TRUE(is_done(plc.write(154, 6)));
  EXPECT_EQ(result(), "00 02");
  EXPECT_EQ(commands(desk), Commands{move_absolute});
}

TEST_F(NotNew, AfterAFaultACommandIsArmedBy0First) {
  EXPECT_TRUE(is_done(plc.write(154, 8)));
  desk.runtime.advance_by(5s);
  desk.axis(1).endings.faulted();
  EXPECT_EQ(plc.write(154, 8), "86 06") << "however long ago it was written";
  EXPECT_EQ(plc.write(154, 8), "86 06") << "each time";
  EXPECT_TRUE(is_done(plc.write(154, 0)));
  EXPECT_TRUE(is_done(plc.write(154, 8)));
  EXPECT_EQ(commands(desk), (Commands{run_velocity, run_velocity}));
}

TEST_F(NotNew, AStopIsAlwaysAnsweredNormally) {
  for (const int stop : {2, 3, 4}) {
    EXPECT_TRUE(is_done(plc.write(154, stop)));
    EXPECT_TRUE(is_done(plc.write(154, stop)));
  }
  EXPECT_EQ(commands(desk).size(), 6U);
}

TEST_F(NotNew, AQuickStopWithTheIdOfTheCommandBeforeActs) {
  EXPECT_TRUE(is_done(scan(0, 7, 0, 1)));
  EXPECT_TRUE(is_done(scan(0, 7, 6, 2)));
  EXPECT_TRUE(is_done(scan(0, 7, 3, 2)));
  EXPECT_TRUE(is_done(scan(0, 7, 3, 2)));
  EXPECT_EQ(commands(desk), (Commands{move_absolute, quick_stop}));
}

TEST_F(NotNew, AFirstBlockIsOnlyRememberedAndToldOnce) {
  EXPECT_TRUE(is_done(scan(0x0F, 700, 6, 0)));
  EXPECT_TRUE(asks_nothing(last()));
  EXPECT_EQ(result(), "00 0A");
  desk.axis(1).latest = {};
  desk.port.at_once = {{{Errc::state_unsuitable, kDetailDeviceState}, 0, 0}};
  EXPECT_EQ(plc.write_coil(106, true), "85 04");
  EXPECT_TRUE(is_done(scan(0x0F, 700, 6, 0)));
  EXPECT_EQ(result(), "00 09") << "repeating what was told leaves the result alone";
}

TEST_F(NotNew, ATargetChangedBesideAHeldCommandIsToldOnceAndStored) {
  EXPECT_TRUE(is_done(scan(0, 1, 0, 0)));
  EXPECT_TRUE(is_done(scan(0, 100, 6, 0)));
  EXPECT_EQ(result(), "00 02");
  EXPECT_TRUE(is_done(scan(0, 200, 6, 0)));
  EXPECT_EQ(result(), "00 0A");
  ASSERT_EQ(last().setpoints.size(), 1U);
  EXPECT_EQ(last().setpoints[0].value, 200);
  EXPECT_EQ(commands(desk), Commands{move_absolute});
}

TEST_F(NotNew, WithAnIdATargetAloneIsNoStartAndNothingToTell) {
  EXPECT_TRUE(is_done(scan(0, 1, 0, 1)));
  EXPECT_TRUE(is_done(scan(0, 100, 6, 2)));
  EXPECT_TRUE(is_done(scan(0, 200, 6, 2)));
  EXPECT_EQ(result(), "00 02");
  EXPECT_EQ(commands(desk), Commands{move_absolute});
}

TEST_F(NotNew, TheLogSaysOnceWhatToDo) {
  std::vector<std::string> lines;
  desk.log = Log([&](LogLevel, std::string_view, std::string_view text) { lines.emplace_back(text); }, LogLevel::info);
  Line tool(desk, Role::operator_, kPanel);
  EXPECT_TRUE(is_done(tool.write(154, 7)));
  EXPECT_EQ(tool.write(154, 7), "86 06");
  EXPECT_EQ(tool.write(154, 7), "86 06");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("write 0 first"), std::string::npos) << lines[0];
}

class Zeros : public NotNew {};

TEST_F(Zeros, AnImageBeforeTheProgramRunsAsksNothing) {
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
  EXPECT_TRUE(asks_nothing(last()));
  EXPECT_TRUE(last().all_zero);
  EXPECT_FALSE(last().claims);
  EXPECT_TRUE(is_done(scan(0, 500, 6, 0))) << "and the program's first block acts";
  EXPECT_EQ(commands(desk), Commands{move_absolute});
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
  EXPECT_TRUE(asks_nothing(last())) << "not even for target 0";
}

TEST_F(Zeros, StopWhereTheControlwordWasAnother) {
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
  EXPECT_TRUE(is_done(scan(0x0F, 0, 0, 0)));
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
  EXPECT_EQ(last().controlword, 0);
  EXPECT_FALSE(last().claims) << "a stop";
}

TEST_F(Zeros, OfTheOwnerEndARun) {
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
  desk.axis(1).axis_state = AxisState::continuous_motion;
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
  EXPECT_TRUE(last().setpoints.empty()) << "nobody owns the axis";
  desk.axis(1).lease = {.owner = last().life, .running = true, .renewed = desk.runtime.now()};
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
  ASSERT_EQ(last().setpoints.size(), 2U);
  EXPECT_EQ(last().setpoints[0].quantity, Quantity::target_velocity);
  EXPECT_EQ(last().setpoints[1].quantity, Quantity::target_torque);
}

TEST_F(Zeros, AreAnsweredOnADriveThatHasFewRows) {
  desk.axis(1).supported = desk.axis(1).writable = bit(Quantity::target_velocity);
  desk.axis(1).supported_commands = (1U << 8) | 0x3E;
  EXPECT_TRUE(is_done(scan(0, 0, 0, 0)));
}

TEST_F(Zeros, InARowThatHasNone0LeaveItAsItIs) {
  for (const int offset : {41, 47, 48, 50, 52, 58, 62, 64, 66, 70, 76}) {
    const RegisterRow* const row = register_table(Block::axis).covering(static_cast<std::uint16_t>(offset));
    ASSERT_NE(row, nullptr);
    const auto address = static_cast<std::uint16_t>(100 + offset);
    EXPECT_EQ(plc.write_block(address, row->registers() == 2 ? "00 00 00 00" : "00 00"), "90 03") << row->name;
  }
  EXPECT_TRUE(desk.port.submitted.empty());
  // 46 to 53: a torque, and zeros.
  EXPECT_TRUE(is_done(plc.write_block(146, "00 07 00 00" + words(0) + words(0) + words(0))));
  ASSERT_EQ(last().setpoints.size(), 1U);
}

TEST_F(NotNew, ABlockThatTheAxisRefusesForItsValuesIsRefusedAgain) {
  for (int i = 0; i < 3; ++i) {
    desk.port.at_once = {{{Errc::bad_value, 0}, 0, 0}};
    EXPECT_EQ(plc.write_block(142, words(7) + words(8)), "90 03") << "it is not even remembered";
    EXPECT_EQ(last().setpoints.size(), 2U);
  }
}

TEST_F(NotNew, ReadsOfAClientThatIsAnAddressAreNoSignOfLife) {
  desk.settings.client_is_address = true;
  Line monitor(desk, Role::operator_, kPanel);
  EXPECT_TRUE(is_done(monitor.write(156, 1)));
  const auto life = last().life;
  desk.runtime.advance_by(1s);
  static_cast<void>(monitor.read(100, 40));
  EXPECT_NE(life->last_request, desk.runtime.now());
  EXPECT_TRUE(is_done(monitor.write(156, 2)));
  EXPECT_EQ(life->last_request, desk.runtime.now());
}

TEST_F(NotNew, AChangedGatewayHeartbeatTakesOverTheOrphansOfItsOwnHand) {
  EXPECT_TRUE(is_done(plc.write(156, 1)));
  desk.axis(1).lease = {.owner = last().life, .running = true, .renewed = desk.runtime.now()};
  plc.session().on_closed(desk.runtime.now());
  desk.port.submitted.clear();
  Line panel(desk, Role::engineer, kPanel);
  EXPECT_TRUE(is_done(panel.write(8, 1)));
  EXPECT_TRUE(desk.port.submitted.empty()) << "another address";
  Line again(desk);
  EXPECT_TRUE(is_done(again.write(8, 1)));
  ASSERT_EQ(desk.port.submitted.size(), 1U);
  EXPECT_EQ(desk.port.submitted[0].axis, 1);
  EXPECT_TRUE(last().is_write);
  EXPECT_TRUE(last().beats);
  EXPECT_TRUE(is_done(again.write(8, 1)));
  EXPECT_EQ(desk.port.submitted.size(), 1U) << "unchanged";
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
