#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

class Results : public ::testing::Test {
 protected:
  Desk desk;
  Line plc{desk};
};

TEST_F(Results, OfAClientThatHasUsedNoneAreTheAxisslatest) {
  desk.axis(1).latest = {CommandResult::refused_by_drive, 0x06090030, 12};
  EXPECT_EQ(plc.read(125, 3), "00 03 06 09 00 30");
  EXPECT_EQ(plc.read(130), "00 0C");
  EXPECT_TRUE(is_done(plc.write(146, 1)));
  EXPECT_EQ(plc.read(125, 3), "00 02 00 00 00 00");
  EXPECT_EQ(plc.read(225), "00 00") << "per axis";
  Line panel(desk, Role::viewer, kPanel);
  EXPECT_EQ(panel.read(125), "00 03") << "per client";
}

TEST_F(Results, ArePendingWhileTheGroupRuns) {
  desk.settings.client_is_address = true;
  Line first(desk, Role::operator_, kPanel);
  Line second(desk, Role::operator_, kPanel);
  desk.port.slow = true;
  EXPECT_EQ(first.write(146, 1), "");
  EXPECT_EQ(second.read(125), "00 01");
  desk.port.finish();
  EXPECT_EQ(second.read(125), "00 02");
}

TEST_F(Results, OfAnOlderGroupDoNotReplaceANewerOnes) {
  desk.settings.posted_writes = true;
  desk.port.slow = true;
  EXPECT_TRUE(is_done(plc.write(146, 1)));
  EXPECT_TRUE(is_done(plc.write(146, 2)));
  desk.port.finish({Errc::superseded, 0});
  EXPECT_EQ(plc.read(125), "00 01") << "the newer one is still pending";
  desk.port.finish();
  EXPECT_EQ(plc.read(125), "00 02");
}

TEST_F(Results, StayWhenABlockAsksNothing) {
  desk.port.at_once = {{{Errc::refused_by_drive, 9}, 0, 0}};
  EXPECT_EQ(plc.write(146, 1), "86 04");
  EXPECT_TRUE(is_done(plc.write(156, 1)));
  EXPECT_EQ(plc.read(125, 3), "00 03 00 00 00 09");
}

TEST_F(Results, BelongToTheHostWithClientAddress) {
  desk.settings.client_is_address = true;
  {
    Line tool(desk, Role::operator_, kPanel);
    desk.port.at_once = {{{Errc::state_unsuitable, kDetailDeviceState}, 0, 0}};
    EXPECT_EQ(tool.write(154, 6), "86 04");
    EXPECT_TRUE(is_done(tool.write(156, 9)));
  }
  EXPECT_TRUE(desk.port.gone.empty());
  Line next(desk, Role::operator_, kPanel);
  EXPECT_EQ(next.read(125, 3), "00 09 08 00 00 22");
  EXPECT_EQ(next.read(156), "00 09");
}

TEST_F(Results, AreGoneWithTheConnectionByDefault) {
  {
    Line panel(desk, Role::operator_, kPanel);
    EXPECT_TRUE(is_done(panel.write(156, 9)));
  }
  ASSERT_EQ(desk.port.gone.size(), 1U);
  Line again(desk, Role::operator_, kPanel);
  EXPECT_EQ(again.read(156), "00 00");
}

/// The rule of command_id, as a program on a PLC meets it.
class CommandIdRule : public Results {
 protected:
  std::string command(int value, int id) { return plc.write_block(154, word(value) + word(id)); }
};

TEST_F(CommandIdRule, AProgramStartsWithCommand0AndAnIdThatItWillNotUseNext) {
  EXPECT_TRUE(is_done(command(0, 99)));
  EXPECT_EQ(plc.read(130), "00 63");
  EXPECT_TRUE(is_done(command(7, 1)));
  EXPECT_TRUE(is_done(command(7, 2)));
  EXPECT_TRUE(is_done(command(7, 2)));
  EXPECT_EQ(commands(desk), (std::vector{Command::move_relative, Command::move_relative}));
  EXPECT_EQ(plc.read(130), "00 02");
}

TEST_F(CommandIdRule, TheFirstIdIsOnlyRemembered) {
  EXPECT_TRUE(is_done(command(7, 5)));
  EXPECT_TRUE(commands(desk).empty());
  EXPECT_EQ(plc.read(125), "00 0A") << "not new: nothing was done";
  EXPECT_EQ(plc.read(130), "00 00") << "and nothing seen";
  EXPECT_TRUE(is_done(command(7, 6)));
  EXPECT_EQ(commands(desk), std::vector{Command::move_relative});
}

TEST_F(CommandIdRule, OutlivesTheConnectionFor60s) {
  EXPECT_TRUE(is_done(command(0, 99)));
  EXPECT_TRUE(is_done(command(7, 1)));
  EXPECT_TRUE(is_done(command(0, 0))) << "zeros never erase it";
  EXPECT_TRUE(is_done(plc.write(155, 55))) << "nor does an id alone";
  plc.session().on_closed(desk.runtime.now());
  static_cast<void>(desk.port.taken());
  desk.runtime.advance_by(59s);
  Line again(desk);
  EXPECT_EQ(again.read(130), "00 01");
  EXPECT_TRUE(is_done(again.write_block(154, word(7) + word(1))));
  EXPECT_TRUE(commands(desk).empty()) << "a repeated request after a reconnect";
  EXPECT_TRUE(is_done(again.write_block(154, word(7) + word(2))));
  EXPECT_EQ(commands(desk), std::vector{Command::move_relative});
  again.session().on_closed(desk.runtime.now());
  desk.runtime.advance_by(60s);
  Line later(desk);
  EXPECT_TRUE(is_done(later.write_block(154, word(7) + word(3))));
  EXPECT_TRUE(commands(desk).empty()) << "forgotten: the first is only remembered";
}

TEST_F(CommandIdRule, TheIdTravelsWithTheGroup) {
  EXPECT_TRUE(is_done(command(0, 99)));
  EXPECT_TRUE(is_done(command(6, 33)));
  EXPECT_EQ(desk.port.submitted.back().group.command_id, 33);
  EXPECT_TRUE(is_done(plc.write(154, 7)));
  EXPECT_EQ(desk.port.submitted.back().group.command_id, 0) << "of a request that carries none";
}

TEST_F(CommandIdRule, AnotherAddressCountsForItself) {
  EXPECT_TRUE(is_done(command(0, 99)));
  EXPECT_TRUE(is_done(command(6, 1)));
  static_cast<void>(desk.port.taken());
  Line panel(desk, Role::operator_, kPanel);
  EXPECT_TRUE(is_done(panel.write_block(154, word(6) + word(2))));
  EXPECT_TRUE(commands(desk).empty());
}

TEST_F(Results, ARefusedPressIsNotThePressThatCounts) {
  desk.port.at_once = {{{Errc::offline, 0}, 0, 0}};
  EXPECT_EQ(plc.write(154, 6), "86 0A");
  desk.runtime.advance_by(100ms);
  EXPECT_TRUE(is_done(plc.write(154, 6)));
  EXPECT_EQ(commands(desk).size(), 2U);
}

TEST_F(Results, APressOfUnknownOutcomeIsNotRepeatedWithinRearm) {
  desk.port.at_once = {{{Errc::timed_out, 0}, 0, 0}};
  EXPECT_EQ(plc.write(154, 7), "86 0B");
  desk.runtime.advance_by(100ms);
  EXPECT_EQ(plc.write(154, 7), "86 06") << "no tool prints success for nothing";
  EXPECT_EQ(plc.read(125), "00 0A");
  EXPECT_EQ(commands(desk).size(), 1U);
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
