// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

/// Asks as each role on a fresh desk; gives the roles that were not answered 0x01, as "voe".
std::string who_may(const std::string& pdu) {
  std::string out;
  for (const Role role : {Role::none, Role::viewer, Role::operator_, Role::engineer}) {
    Desk desk;
    Line line(desk, role);
    if (!is_exception(line.ask(pdu), 1)) out += "-voe"[static_cast<int>(role)];
  }
  return out;
}

TEST(Roles, each_function_is_open_to_those_of_the_contract) {
  const std::pair<const char*, const char*> cases[] = {
      {"01 00 64 00 08", "voe"},
      {"02 00 64 00 08", "voe"},
      {"03 00 64 00 08", "voe"},
      {"04 00 64 00 08", "voe"},
      {"2B 0E 01 00", "voe"},
      {"06 00 08 00 01", "voe"},                             // the gateway's heartbeat
      {"06 00 9A 00 0C", "e"},                               // save_parameters
      {"06 00 9A 00 0B", "oe"},                              // set_position
      {"06 00 9A 00 00", "oe"},                              //
      {"0F 00 64 00 08 01 00", "oe"},                        // coils
      {"10 00 B4 00 04 08 00 01 60 64 00 00 00 04", "voe"},  // a mailbox's read
      {"10 00 B4 00 04 08 00 02 60 64 00 00 00 04", "e"},    // and its write
      {"06 00 B5 60 64", "voe"},                             // a row of it
      {"2B 0D 00 00 01 60 64 00 00 00 00 00", "voe"},        // an object's read
      {"2B 0D 01 00 01 60 64 00 00 00 00 02 01 02", "e"},    // its write
      {"2B 0D 81 00 01 60 64 00 00 00 00 02 01 02", "e"},    // a part of it
      {"2B 0D 01 00 63 60 64 00 00 00 00 02 01 02", "e"},    // whatever the axis
      {"16 00 8C 00 00 00 0F", "oe"},                        // functions 22 and 23 count as writes
      {"17 00 64 00 01 00 92 00 01 02 00 07", "oe"},         //
      {"17 00 64 00 01 00 08 00 01 02 00 07", "voe"},        // the heartbeat
      {"05 FF FF FF 00", "oe"},                              // whatever the address
      {"08 00 00 12 34", "voe"},
      {"08 00 0A 00 00", "e"},  // clears the counters
  };
  for (const auto& [pdu, may] : cases) EXPECT_EQ(who_may(pdu), may) << pdu;
  for (int sub = 11; sub <= 15; ++sub) EXPECT_EQ(who_may("08" + word(sub) + "00 00"), "voe") << sub;
  for (int coil = 0; coil < 10; ++coil) EXPECT_EQ(who_may("05" + word(100 + coil) + "FF 00"), "oe") << coil;
  for (const int address : {100, 143, 157, 186, 300, 0, 60010, 65535})
    EXPECT_EQ(who_may("06" + word(address) + "00 01"), "oe") << address;
}

TEST(Roles, each_row_is_written_by_those_of_the_contract) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable) continue;
    const std::string may = row.offset >= 80 ? "voe" : row.offset >= 70 && row.offset <= 77 ? "e" : "oe";
    const std::string one = row.registers() == 2 ? "00 00 00 01" : "00 01";
    const auto address = static_cast<std::uint16_t>(100 + row.offset);
    EXPECT_EQ(who_may(Line::block_write(address, one, bytes(one).size() / 2)), may) << row.name;
  }
}

TEST(Roles, a_block_skips_a_row_that_the_drive_has_without_asking_the_role) {
  Desk desk;
  Line panel(desk, Role::operator_, kPanel);
  const std::string rows = words(7) + words(100);  // 68 homing_offset, 70 quick_stop_deceleration
  EXPECT_EQ(panel.write_block(168, rows), "90 01");
  desk.port.cached = {{1, Quantity::quick_stop_deceleration, 100}};
  EXPECT_TRUE(is_done(panel.write_block(168, rows)));
  EXPECT_EQ(desk.asked(), "homing_offset=7");
  EXPECT_EQ(panel.write_block(170, words(100)), "90 01") << "a row alone is no block";
}

TEST(Roles, a_block_leaves_a_row_that_its_client_has_not_changed_to_whoever_may_write_it) {
  Desk desk;
  Line panel(desk, Role::operator_, kPanel);
  desk.port.cached = {{1, Quantity::quick_stop_deceleration, 100}};
  EXPECT_TRUE(is_done(panel.write_block(168, words(7) + words(100))));
  desk.port.cached.clear();  // an engineer has written another one
  desk.port.owner = desk.port.submitted.back().batch.client;
  desk.port.accepted[{1, Quantity::quick_stop_deceleration}] = 200;
  static_cast<void>(desk.asked());
  EXPECT_TRUE(is_done(panel.write_block(168, words(8) + words(100))));
  EXPECT_EQ(desk.asked(), "homing_offset=8");
  EXPECT_EQ(panel.write_block(168, words(8) + words(101)), "90 01") << "now it asks";
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
