// What makes a client the owner of an axis, row by row, coil by coil and function by function (design 3.5).
#include "gateway/upstream/modbus_tcp/claims.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

/// One request on a desk of its own, after those that make its memory; the groups that it led to.
struct Asked {
  std::vector<FakeCommandPort::Submitted> groups;
  /// All of them agree: a request claims or does not.
  [[nodiscard]] bool claims() const {
    EXPECT_FALSE(groups.empty()) << "every write to an axis is told to it";
    for (const auto& each : groups) EXPECT_EQ(each.group.claims, groups.front().group.claims);
    return !groups.empty() && groups.front().group.claims;
  }
};
Asked ask(const std::string& pdu, const std::vector<std::string>& before = {}) {
  Desk desk;
  Line plc(desk);
  for (const std::string& each : before) EXPECT_TRUE(is_done(plc.ask(each))) << each;
  static_cast<void>(desk.port.taken());
  EXPECT_TRUE(is_done(plc.ask(pdu))) << pdu;
  return {desk.port.taken()};
}
std::string block(int address, const std::string& registers) {
  return Line::block_write(static_cast<std::uint16_t>(address), registers, bytes(registers).size() / 2);
}
std::string coil(int offset, bool on) { return "05" + word(100 + offset) + (on ? "FF00" : "0000"); }

TEST(Claims, EachRowOf40To79ThatAsksAndNoOther) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable) continue;
    const std::string one = row.source == Source::object_request ? "00 00"
                            : row.registers() == 2               ? "00 00 00 01"
                                                                 : "00 01";
    const bool stop = row.source == Source::quantity && row.quantity == Quantity::controlword;  // 1 is a stop
    const bool asks = row.source != Source::command_id && row.source != Source::heartbeat;
    EXPECT_EQ(ask(block(100 + row.offset, one)).claims(), row.offset <= 79 && !stop && asks) << row.name;
  }
}

TEST(Claims, EachCommandButStopsReleaseAndTakeOver) {
  for (int command = 0; command <= kLastCommand; ++command) {
    const bool free = command == 0 || (command >= 2 && command <= 4) || command >= 13;
    EXPECT_EQ(ask("06 00 9A" + word(command)).claims(), !free) << command;
    const std::string with_id = block(154, word(command) + "00 05");
    EXPECT_EQ(ask(with_id, {block(154, "00 00 00 04")}).claims(), !free) << command << " with a command_id";
  }
}

TEST(Claims, EachCoilThatEnablesOrMoves) {
  for (int offset = 0; offset < 16; ++offset) {
    for (const bool on : {false, true}) {
      if (on && offset >= kCoils) continue;
      const bool expected = on && (offset == 0 || (offset >= 4 && offset <= 9));
      EXPECT_EQ(ask(coil(offset, on), {coil(offset, false)}).claims(), expected) << offset << (on ? " = 1" : " = 0");
    }
  }
}

TEST(Claims, NotRunVelocityGoing1To0SinceItIsAStop) {
  const Asked asked = ask(coil(7, false), {coil(7, false), coil(7, true)});
  EXPECT_FALSE(asked.claims());
  EXPECT_EQ(asked.groups.front().group.command, Command::end_run);
}

TEST(Claims, ARowOfCoilsByWhatActsInIt) {
  const std::vector<std::string> zeros{"0F 00 64 00 08 01 00"};
  EXPECT_FALSE(ask("0F 00 64 00 04 01 0E", zeros).claims()) << "reset, quick stop and halt";
  EXPECT_TRUE(ask("0F 00 64 00 04 01 01", zeros).claims()) << "enable";
  EXPECT_FALSE(ask("0F 00 64 00 08 01 00", zeros).claims()) << "zeros ask for nothing";
  EXPECT_FALSE(ask("0F 00 6E 00 06 01 00").claims()) << "reserved ones";
}

TEST(Claims, NothingWhereNothingOfTheRequestActs) {
  const Asked rest = ask("06 00 9A 00 00");
  EXPECT_FALSE(rest.claims());
  ASSERT_EQ(rest.groups.size(), 1U) << "a sign of life, and what an orphan lease waits for";
  EXPECT_TRUE(asks_nothing(rest.groups[0].group));
  EXPECT_TRUE(rest.groups[0].group.is_write);
  const Asked remembered = ask("0F 00 64 00 08 01 71");
  EXPECT_FALSE(remembered.claims());
  ASSERT_EQ(remembered.groups.size(), 1U);
  EXPECT_TRUE(asks_nothing(remembered.groups[0].group));
}

TEST(Claims, NothingByAScannerThatRepeatsItself) {
  const std::string idle = block(140,
                                 "00 00 00 01 00 00 00 07 00 00 00 08 00 09 00 0A 00 00 00 0B 00 00 00 0C 00 00 00 0D "
                                 "00 00 00 00 00 01");
  EXPECT_FALSE(ask(idle).claims()) << "a first block is only remembered";
  EXPECT_FALSE(ask(idle, {idle}).claims());
  EXPECT_FALSE(ask(idle, {idle, idle}).claims());
}

TEST(Claims, ASingleControlwordUnlessItIsAStop) {
  for (const int stop : {0x00, 0x02, 0x06, 0x07, 0x0B}) {
    EXPECT_FALSE(ask("06 00 8C" + word(stop)).claims()) << stop;
    EXPECT_FALSE(ask("06 00 8C" + word(stop), {"06 00 8C" + word(stop)}).claims()) << stop << ", pressed twice";
    EXPECT_TRUE(ask(block(140, word(stop) + "00 01"), {"06 00 8C 00 0F"}).claims()) << stop << " beside the mode";
  }
  EXPECT_TRUE(ask("06 00 8C 00 0F").claims());
}

TEST(Claims, AStopInABlockByWhatElseAsksInIt) {
  EXPECT_TRUE(ask(block(152, "00 00 00 07 00 03"), {block(154, "00 00")}).claims()) << "a new deceleration";
  EXPECT_FALSE(ask(block(154, "00 03 00 00 00 01")).claims()) << "a heartbeat beside quick_stop asks for nothing";
  const Asked coils = ask("0F 00 64 00 08 01 09", {"0F 00 64 00 08 01 00"});
  ASSERT_EQ(coils.groups.size(), 2U) << "halt and enable";
  EXPECT_FALSE(coils.groups[0].group.claims);
  EXPECT_TRUE(coils.groups[1].group.claims);
}

TEST(Claims, AMailboxOr4313WriteAndNoRead) {
  EXPECT_FALSE(ask(block(180, "00 01 60 64 00 00 00 04")).claims());
  EXPECT_TRUE(ask(block(180, "00 02 60 64 00 00 00 04")).claims());
  EXPECT_FALSE(ask("2B 0D 00 00 01 60 64 00 00 00 00 00").claims());
  EXPECT_TRUE(ask("2B 0D 01 00 01 60 64 00 00 00 00 02 01 02").claims());
}

TEST(Claims, AMailboxReadBesideRowsThatDo) {
  const Asked asked = ask(block(178, "00 00 00 07 00 01 60 64 00 00 00 04"));
  ASSERT_EQ(asked.groups.size(), 2U);
  EXPECT_TRUE(asked.groups[0].group.claims);
  EXPECT_TRUE(asked.groups[1].group.object.has_value());
  EXPECT_FALSE(asked.groups[1].group.claims) << "the read itself needs no owner";
}

TEST(Claims, ByFunctions22And23AsByAnyWrite) {
  EXPECT_TRUE(ask("16 00 8C 00 00 00 0F").claims());
  EXPECT_FALSE(ask("16 00 8C 00 00 00 06").claims());
  EXPECT_TRUE(ask("17 00 64 00 01 00 92 00 01 02 00 07").claims()) << "no last write counts as one that differed";
  EXPECT_FALSE(ask("17 00 64 00 01 00 9A 00 01 02 00 03").claims());
}

TEST(Claims, AScannersBlockThatKeepsItsReleaseOnlyWithWhatIsNew) {
  Desk desk;
  Line plc(desk);
  EXPECT_TRUE(is_done(plc.write_block(152, "00 00 00 07 00 00 00 00 00 01")));
  EXPECT_FALSE(desk.port.taken().back().group.claims) << "a first block is only remembered";
  for (const char* beat : {"00 02", "00 03"}) {
    EXPECT_TRUE(is_done(plc.write_block(152, "00 00 00 07 00 0D 00 00" + std::string(beat))));
    EXPECT_FALSE(desk.port.submitted.back().group.setpoints.size() > 1);
  }
  EXPECT_EQ(commands(desk), std::vector{Command::release});
  EXPECT_TRUE(is_done(plc.write_block(152, "00 00 00 07 00 0D 00 00 00 04")));
  EXPECT_FALSE(desk.port.taken().back().group.claims) << "what was released is not taken back at once";
  EXPECT_TRUE(is_done(plc.write_block(152, "00 00 00 08 00 0D 00 00 00 03")));
  EXPECT_TRUE(desk.port.taken().back().group.claims) << "another deceleration";
}

TEST(Claims, ReleaseAndTakeOverReachThePortAsCommands) {
  EXPECT_EQ(ask("06 00 9A 00 0D").groups.back().group.command, Command::release);
  EXPECT_EQ(ask("06 00 9A 00 0E").groups.back().group.command, Command::take_over);
}

TEST(Claims, NothingByARequestThatIsRefusedBefore) {
  Desk desk;
  Line viewer(desk, Role::viewer, kPanel);
  EXPECT_EQ(viewer.write(146, 1), "86 01");
  EXPECT_EQ(viewer.write_coil(100, true), "85 01");
  Line plc(desk);
  EXPECT_EQ(plc.write(143, 1), "86 02");
  EXPECT_EQ(plc.write(154, 99), "86 03");
  EXPECT_EQ(plc.write_coil(110, true), "85 02");
  EXPECT_EQ(plc.write(180, 3), "86 03");
  EXPECT_EQ(plc.ask("2B 0D 01 00 63 60 64 00 00 00 00 02 01 02"), "AB 0A");
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST(Claims, NothingByAViewerWhoseBlockTheDriveHolds) {
  Desk desk;
  Line viewer(desk, Role::viewer, kPanel);
  desk.port.held = {{1, Quantity::target_torque, 7}, {1, Quantity::max_torque, 8}};
  EXPECT_TRUE(is_done(viewer.write_block(146, "00 07 00 08")));
  EXPECT_FALSE(desk.port.submitted.back().group.claims);
}

TEST(Claims, EveryGroupNamesTheLifeOfItsClient) {
  for (const char* pdu : {"06 00 92 00 01", "06 00 9C 00 01", "05 00 64 FF 00", "05 00 66 FF 00",
                          "10 00 B4 00 04 08 00 01 60 64 00 00 00 04", "2B 0D 00 00 01 60 64 00 00 00 00 00"}) {
    SCOPED_TRACE(pdu);
    Desk desk;
    Line plc(desk, Peer{kPlc, 50000, Role::engineer, 4});
    EXPECT_TRUE(is_done(plc.ask(pdu)));
    const Group& group = desk.port.submitted.back().group;
    ASSERT_NE(group.life, nullptr);
    EXPECT_EQ(group.life->id, group.client);
    EXPECT_EQ(group.life->role, Role::engineer);
    EXPECT_EQ(group.life->rank, 4);
    EXPECT_EQ(group.life->origin, kPlc);
    EXPECT_EQ(group.life->name, "192.168.1.7:50000");
    EXPECT_TRUE(group.life->connected);
  }
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
