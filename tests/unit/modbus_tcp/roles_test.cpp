#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

constexpr Role kRoles[] = {Role::none, Role::viewer, Role::operator_, Role::engineer};

/// Asks as each role on a fresh desk; gives the roles that were not answered 0x01, as "voe".
std::string who_may(const std::string& pdu) {
  std::string out;
  for (const Role role : kRoles) {
    Desk desk;
    Line line(desk, role);
    if (!is_exception(line.ask(pdu), 1)) out += "-voe"[static_cast<int>(role)];
  }
  return out;
}

std::string who_may_write(int address, const std::string& registers) {
  return who_may(Line::block_write(static_cast<std::uint16_t>(address), registers, bytes(registers).size() / 2));
}

TEST(Roles, EveryRoleReads) {
  EXPECT_EQ(who_may("01 00 64 00 08"), "voe");
  EXPECT_EQ(who_may("02 00 64 00 08"), "voe");
  EXPECT_EQ(who_may("03 00 64 00 08"), "voe");
  EXPECT_EQ(who_may("04 00 64 00 08"), "voe");
  EXPECT_EQ(who_may("2B 0E 01 00"), "voe");
}

TEST(Roles, EachRowIsWrittenByThoseOfTheContract) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable) continue;
    SCOPED_TRACE(row.name);
    const std::string may = row.offset >= 80 ? "voe" : row.offset >= 70 && row.offset <= 77 ? "e" : "oe";
    EXPECT_EQ(who_may_write(100 + row.offset, row.registers() == 2 ? "00 00 00 01" : "00 01"), may);
  }
  EXPECT_EQ(who_may_write(8, "00 01"), "voe");
}

TEST(Roles, Command12IsTheEngineers) {
  EXPECT_EQ(who_may_write(154, "00 0C"), "e");
  EXPECT_EQ(who_may_write(154, "00 0B"), "oe");
  EXPECT_EQ(who_may_write(154, "00 00"), "oe");
}

TEST(Roles, CoilsAreTheOperators) {
  for (int coil = 0; coil < 10; ++coil) EXPECT_EQ(who_may("05" + word(100 + coil) + "FF 00"), "oe") << coil;
  EXPECT_EQ(who_may("0F 00 64 00 08 01 00"), "oe");
}

TEST(Roles, TheMailboxReadsForEveryoneAndWritesForTheEngineer) {
  EXPECT_EQ(who_may_write(180, "00 01 60 64 00 00 00 04"), "voe");
  EXPECT_EQ(who_may_write(180, "00 02 60 64 00 00 00 04"), "e");
  EXPECT_EQ(who_may_write(181, "60 64"), "voe");
}

TEST(Roles, Function4313ReadsForEveryoneAndWritesForTheEngineer) {
  EXPECT_EQ(who_may("2B 0D 00 00 01 60 64 00 00 00 00 00"), "voe");
  EXPECT_EQ(who_may("2B 0D 01 00 01 60 64 00 00 00 00 02 01 02"), "e");
  EXPECT_EQ(who_may("2B 0D 81 00 01 60 64 00 00 00 00 02 01 02"), "e") << "a part of a write";
  EXPECT_EQ(who_may("2B 0D 01 00 63 60 64 00 00 00 00 02 01 02"), "e") << "whatever the axis";
}

TEST(Roles, WhoeverMayNotIsToldSoWhateverTheAddress) {
  for (const int address : {100, 143, 157, 186, 300, 0, 60010, 65535}) {
    EXPECT_EQ(who_may("06" + word(address) + "00 01"), "oe") << address;
  }
  EXPECT_EQ(who_may("05" + word(65535) + "FF 00"), "oe");
}

TEST(Roles, Functions22And23CountAsWrites) {
  EXPECT_EQ(who_may("16 00 8C 00 00 00 0F"), "oe");
  EXPECT_EQ(who_may("17 00 64 00 01 00 92 00 01 02 00 07"), "oe");
  EXPECT_EQ(who_may("17 00 64 00 01 00 08 00 01 02 00 07"), "voe") << "the heartbeat";
}

TEST(Roles, RoleIsCheckedBeforeAddressAndValue) {
  Desk desk;
  Line panel(desk, Role::viewer, kPanel);
  EXPECT_EQ(panel.write(143, 1), "86 01");
  EXPECT_EQ(panel.write(154, 99), "86 01");
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST(Roles, ABlockSkipsARowThatTheDriveHoldsWithoutAskingTheRole) {
  Desk desk;
  Line panel(desk, Role::operator_, kPanel);
  const std::string rows = words(7) + words(100);  // 68 homing_offset, 70 quick_stop_deceleration
  EXPECT_EQ(panel.write_block(168, rows), "90 01");
  desk.port.held = {{1, Quantity::quick_stop_deceleration, 100}};
  EXPECT_TRUE(is_done(panel.write_block(168, rows)));
  EXPECT_EQ(desk.port.submitted.back().group.setpoints.size(), 1U);
  EXPECT_EQ(panel.write_block(170, words(100)), "90 01") << "a row alone is no block";
}

TEST(Roles, DiagnosticsClearForTheEngineer) {
  EXPECT_EQ(who_may("08 00 00 12 34"), "voe");
  EXPECT_EQ(who_may("08 00 0A 00 00"), "e");
  for (int sub = 11; sub <= 15; ++sub) EXPECT_EQ(who_may("08" + word(sub) + "00 00"), "voe") << sub;
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
