// SPDX-License-Identifier: Apache-2.0
// What makes a client the owner of an axis, row by row, coil by coil and function by function (design 3.5).
#include "gateway/upstream/modbus_tcp/write/claims.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

/// One request on a desk of its own, after those that make its memory; which of the write batches that it led to claim,
/// in words between commas: "claims, no".
std::string asked_by(const std::string& pdu, const std::vector<std::string>& before = {}) {
  Desk desk;
  Line plc(desk);
  for (const std::string& each : before) EXPECT_TRUE(is_done(plc.ask(each))) << each;
  static_cast<void>(desk.port.taken());
  EXPECT_TRUE(is_done(plc.ask(pdu))) << pdu;
  std::string out;
  for (const auto& [axis, batch] : desk.port.taken())
    out += (out.empty() ? "" : ", ") + std::string(batch.claims ? "claims" : "no");
  return out;
}
std::string word_of(bool claims) { return claims ? "claims" : "no"; }
std::string block(int address, const std::string& registers) {
  return Line::block_write(static_cast<std::uint16_t>(address), registers, bytes(registers).size() / 2);
}
std::string coil(int offset, bool on) { return "05" + word(100 + offset) + (on ? "FF00" : "0000"); }

TEST(Claims, each_row_of_40_to_79_that_asks_and_no_other) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable) continue;
    const std::string one = row.source == Source::object_request ? "00 00"
                            : row.registers() == 2               ? "00 00 00 01"
                                                                 : "00 01";
    const bool stop = row.source == Source::quantity && row.quantity == Quantity::controlword;  // 1 is a stop
    const bool asks = row.source != Source::command_id && row.source != Source::heartbeat;
    EXPECT_EQ(asked_by(block(100 + row.offset, one)), word_of(row.offset <= 79 && !stop && asks)) << row.name;
  }
}

TEST(Claims, each_command_but_stops_release_and_take_over) {
  for (int command = 0; command <= kLastCommand; ++command) {
    const bool free = command == 0 || (command >= 2 && command <= 4) || command >= 13;
    EXPECT_EQ(asked_by("06 00 9A" + word(command)), word_of(!free)) << command;
    EXPECT_EQ(asked_by(block(154, word(command) + "00 05"), {block(154, "00 00 00 04")}), word_of(!free)) << command;
  }
}

TEST(Claims, each_coil_that_enables_or_moves) {
  for (int offset = 0; offset < 16; ++offset) {
    for (const bool on : {false, true}) {
      if (on && offset >= kCoils) continue;
      const bool expected = on && (offset == 0 || (offset >= 4 && offset <= 9));
      EXPECT_EQ(asked_by(coil(offset, on), {coil(offset, false)}), word_of(expected)) << offset << " = " << on;
    }
  }
  EXPECT_EQ(asked_by(coil(7, false), {coil(7, false), coil(7, true)}), "no") << "run_velocity going 1 to 0 is a stop";
}

TEST(Claims, a_single_controlword_unless_it_is_a_stop) {
  for (const int stop : {0x00, 0x02, 0x06, 0x07, 0x0B}) EXPECT_EQ(asked_by("06 00 8C" + word(stop)), "no") << stop;
  EXPECT_EQ(asked_by("06 00 8C 00 0F"), "claims");
}

TEST(Claims, what_acts_in_a_request_and_nothing_where_nothing_does) {
  const std::string zeros = "0F 00 64 00 08 01 00";
  const std::string idle = block(140,
                                 "00 00 00 01 00 00 00 07 00 00 00 08 00 09 00 0A 00 00 00 0B 00 00 00 0C 00 00 00 0D "
                                 "00 00 00 00 00 01");
  struct Case {
    const char* what;
    std::vector<std::string> before;
    std::string pdu;
    const char* batches;
  };
  const Case cases[] = {
      {"reset, quick stop and halt", {zeros}, "0F 00 64 00 04 01 0E", "no, no, no"},
      {"enable", {zeros}, "0F 00 64 00 04 01 01", "claims"},
      {"halt and enable", {zeros}, "0F 00 64 00 08 01 09", "no, claims"},
      {"zeros ask for nothing", {zeros}, zeros, "no"},
      {"reserved ones", {}, "0F 00 6E 00 06 01 00", "no"},
      {"a row that is only remembered", {}, "0F 00 64 00 08 01 71", "no"},
      {"a scanner's first block", {}, idle, "no"},
      {"that it repeats", {idle}, idle, "no"},
      {"for ever", {idle, idle}, idle, "no"},
      {"a new deceleration beside a stop", {block(154, "00 00")}, block(152, "00 00 00 07 00 03"), "claims"},
      {"a controlword in a block", {block(140, "00 0F 00 01")}, block(140, "00 07 00 01"), "claims"},
      {"and one that stops wherever it is", {block(140, "00 0F 00 01")}, block(140, "00 0B 00 01"), "no"},
      {"a heartbeat beside quick_stop asks for nothing", {}, block(154, "00 03 00 00 00 01"), "no"},
      {"a mailbox's read", {}, block(180, "00 01 60 64 00 00 00 04"), "no"},
      {"a mailbox's write", {}, block(180, "00 02 60 64 00 00 00 04"), "claims"},
      {"a mailbox's read beside a row that does", {}, block(178, "00 00 00 07 00 01 60 64 00 00 00 04"), "claims, no"},
      {"an object's read", {}, "2B 0D 00 00 01 60 64 00 00 00 00 00", "no"},
      {"an object's write", {}, "2B 0D 01 00 01 60 64 00 00 00 00 02 01 02", "claims"},
      {"function 22", {}, "16 00 8C 00 00 00 0F", "claims"},
      {"function 22 with a stop", {}, "16 00 8C 00 00 00 06", "no"},
      {"function 23: no last write counts as one that differed", {}, "17 00 64 00 01 00 92 00 01 02 00 07", "claims"},
      {"function 23 with a stop", {}, "17 00 64 00 01 00 9A 00 01 02 00 03", "no"},
  };
  for (const Case& each : cases) EXPECT_EQ(asked_by(each.pdu, each.before), each.batches) << each.what;
}

TEST(Claims, nothing_by_a_scanner_whose_block_has_its_release_but_with_what_is_new) {
  Desk desk;
  Line plc(desk);
  bool claims = false;
  const auto scan = [&](const std::string& registers) {
    EXPECT_TRUE(is_done(plc.write_block(152, registers)));
    claims = desk.port.submitted.back().batch.claims;
    return desk.asked();
  };
  EXPECT_EQ(scan("00 00 00 07 00 00 00 00 00 01"), "nothing") << "a first block is only remembered";
  EXPECT_FALSE(claims);
  EXPECT_EQ(scan("00 00 00 07 00 0D 00 00 00 02"), "profile_deceleration=7+ release");
  EXPECT_EQ(scan("00 00 00 07 00 0D 00 00 00 03"), "nothing");
  EXPECT_EQ(scan("00 00 00 07 00 0D 00 00 00 04"), "nothing");
  EXPECT_FALSE(claims) << "what was released is not taken back at once";
  EXPECT_EQ(scan("00 00 00 08 00 0D 00 00 00 03"), "profile_deceleration=8");
  EXPECT_TRUE(claims) << "another deceleration";
  EXPECT_TRUE(is_done(plc.ask("06 00 9A 00 0E")));
  EXPECT_EQ(desk.asked(), "take_over");
}

TEST(Claims, every_batch_names_the_life_of_its_client_and_until_when) {
  for (const char* pdu : {"06 00 92 00 01", "06 00 9C 00 01", "06 00 9A 00 00", "05 00 64 FF 00", "05 00 66 FF 00",
                          "10 00 B4 00 04 08 00 01 60 64 00 00 00 04", "2B 0D 00 00 01 60 64 00 00 00 00 00"}) {
    SCOPED_TRACE(pdu);
    Desk desk;
    Line plc(desk, Peer{kPlc, 50000, Role::engineer, 4});
    EXPECT_TRUE(is_done(plc.ask(pdu)));
    const WriteBatch& batch = desk.port.submitted.back().batch;
    ASSERT_NE(batch.life, nullptr);
    EXPECT_EQ(batch.life->id, batch.client);
    EXPECT_EQ(batch.life->role, Role::engineer);
    EXPECT_EQ(batch.life->rank, 4);
    EXPECT_EQ(batch.life->origin, kPlc);
    EXPECT_EQ(batch.life->name, "192.168.1.7:50000");
    EXPECT_TRUE(batch.life->connected);
    EXPECT_EQ(batch.role, Role::engineer);
    EXPECT_EQ(batch.start_by, desk.runtime.now() + 500ms);
    EXPECT_EQ(batch.answer_by, desk.runtime.now() + 900ms);
    EXPECT_TRUE(batch.reclaims || batch.object) << "a sign of life, and what an orphan lease waits for";
  }
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
