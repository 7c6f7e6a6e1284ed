// SPDX-License-Identifier: Apache-2.0
// What of writes is no dialogue: each row of the map, each outcome, and what a write batch carries beside what it asks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

using Writes = AtTheDesk;

TEST_F(Writes, every_writable_quantity_arrives_as_itself) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (!row.writable || row.source != Source::quantity || row.quantity == Quantity::controlword ||
        row.quantity == Quantity::mode) {
      continue;
    }
    const bool is_signed = row.type == RegisterType::i16 || row.type == RegisterType::i32;
    const std::int64_t value = is_signed ? -1234 : 1234;
    const auto address = static_cast<std::uint16_t>(100 + row.offset);
    EXPECT_TRUE(is_done(plc.write_block(address, row.registers() == 2 ? words(value) : word(value)))) << row.name;
    EXPECT_EQ(desk.asked(), std::string(row.name) + "=" + std::to_string(value));
  }
}

TEST_F(Writes, read_only_rows_are_no_address) {
  for (const RegisterRow& row : register_table(Block::axis).rows()) {
    if (row.writable) continue;
    const std::string zeros = row.registers() == 2 ? "00 00 00 00" : "00 00";
    EXPECT_EQ(plc.write_block(static_cast<std::uint16_t>(100 + row.offset), zeros), "90 02") << row.name;
  }
  EXPECT_EQ(plc.write_block(185, "00 00 00 00 00 00"), "90 02") << "in a longer write too";
  for (const int address : {0, 7, 9, 10, 50000, 60010, 300, 65535})
    EXPECT_EQ(plc.write(static_cast<std::uint16_t>(address), 0), "86 02") << address;
}

TEST_F(Writes, that_reach_beyond_an_axis_stop_each_axis_that_they_ask_to_stop) {
  const auto zeros = [](std::size_t registers) { return std::string(registers * 4, '0'); };
  EXPECT_EQ(plc.write_block(50, zeros(104) + "00 03"), "90 02") << "from the gateway's block into axis 1";
  EXPECT_EQ(desk.asked(), "quick_stop");
  EXPECT_EQ(plc.write_block(154, "00 04" + zeros(99) + "00 02"), "90 02") << "from axis 1 into axis 2";
  EXPECT_EQ(last().answer_by, desk.runtime.now() + 900ms);
  EXPECT_EQ(desk.asked(), "halt, axis 2: disable");
}

TEST_F(Writes, what_waits_behind_a_mask_has_its_deadlines_from_its_arrival_and_ends_with_anybodys_stop) {
  desk.port.slow = true;
  plc.send("06 00 8C 00 0F");
  plc.send("16 00 8C FF EF 00 10");
  plc.send("06 00 9A 00 06");
  const Instant arrived = desk.runtime.now();
  desk.runtime.advance_by(400ms);
  desk.port.finish();
  EXPECT_EQ(last().start_by, arrived + 500ms);
  EXPECT_EQ(last().answer_by, arrived + 900ms);
  const ClientId plcs = last().client;
  EXPECT_EQ(desk.asked(), "controlword=F alone, controlword=10 alone, move_absolute");
  plc.send("16 00 8C FF EF 00 00");
  desk.axis(1).record.stopped(plcs);
  desk.port.finish();
  desk.port.finish();
  EXPECT_EQ(desk.asked(), "-");
}

TEST_F(Writes, an_owners_block_asks_for_what_is_no_longer_the_value_accepted_last) {
  EXPECT_TRUE(is_done(plc.write_block(141, "00 01 00 00 00 07")));
  desk.port.owner = last().client;
  desk.port.accepted[{1, Quantity::target_position}] = 9;
  static_cast<void>(desk.asked());
  EXPECT_TRUE(is_done(plc.write_block(141, "00 01 00 00 00 07")));
  EXPECT_EQ(desk.asked(), "target_position=7");
  Line panel(desk, Role::operator_, kPanel);
  static_cast<void>(panel.write_block(141, "00 01 00 00 00 07"));
  static_cast<void>(desk.asked());
  EXPECT_TRUE(is_done(panel.write_block(141, "00 01 00 00 00 07")));
  EXPECT_EQ(desk.asked(), "nothing") << "nobody else's does";
}

// The gateway stood still, or its client wrote far ahead of a slow drive and is gone.
TEST_F(Writes, what_has_waited_long_in_its_socket_is_no_sign_of_life_and_not_begun_but_a_stop_is) {
  desk.waited = 2s;
  for (const char* pdu : {"06 00 9A 00 08", "05 00 69 FF 00", "10 00 94 00 02 04 00 00 00 07", "06 00 08 00 01",
                          "2B 0D 01 00 01 60 40 00 00 00 00 02 0F 00"})
    EXPECT_EQ(plc.ask(pdu).substr(3), "06") << pdu;
  EXPECT_EQ(desk.asked(), "-");
  EXPECT_EQ(plc.read(125), "00 06") << "never started";
  for (const char* pdu : {"06 00 9A 00 03", "05 00 64 00 00", "05 00 6C 00 00", "06 00 8C 00 00"})
    EXPECT_TRUE(is_done(plc.ask(pdu))) << pdu;
  const auto life = last().life;
  EXPECT_EQ(desk.asked(), "quick_stop, disable, jog_end, controlword=0 alone");
  desk.runtime.advance_by(3s);
  EXPECT_TRUE(is_done(plc.write(154, 3)));
  EXPECT_EQ(life->last_request, desk.runtime.now() - 2s);
  desk.waited = 1999ms;
  EXPECT_TRUE(is_done(plc.write(154, 8)));
  EXPECT_EQ(desk.asked(), "quick_stop, run_velocity");
  EXPECT_EQ(life->last_request, desk.runtime.now());
}

// A PLC prepares its next relative move in one scan and asks for it in a later one.
TEST_F(Writes, a_distance_beyond_the_limits_waits_beside_an_old_command_7_for_the_next_one) {
  desk.axis(1).limits[static_cast<std::size_t>(Quantity::target_position)] = {0, 9};
  const auto scan = [&](const std::string& distance, int command, int id) {  // registers 42 to 55
    EXPECT_TRUE(is_done(plc.write_block(142, distance + std::string(20 * 2, '0') + word(command) + word(id))));
    return desk.asked();
  };
  EXPECT_EQ(scan("00 00 00 00", 0, 1), "nothing") << "a first block";
  EXPECT_THAT(scan("FF FF FF FB", 7, 2), testing::HasSubstr("target_position=-5 "));
  EXPECT_EQ(scan("FF FF FF FA", 7, 2), "nothing");
  EXPECT_THAT(scan("FF FF FF FA", 7, 3), testing::HasSubstr("target_position=-6+ "));
  EXPECT_EQ(scan("00 00 00 03", 7, 3), "target_position=3") << "it may be a position";
  EXPECT_EQ(scan("FF FF FF FA", 6, 3), "target_position=-6") << "of an absolute move it is refused";
}

TEST_F(Writes, zeros_ask_for_nothing_but_to_end_a_run_of_the_owner) {
  const std::string zeros(34 * 2, '0');  // registers 40 to 56
  EXPECT_TRUE(is_done(plc.write_block(140, zeros)));
  EXPECT_TRUE(last().all_zero && last().zero_speed && !last().claims);
  EXPECT_TRUE(is_done(plc.write_block(140, "00 0F" + zeros.substr(4))));
  EXPECT_FALSE(last().all_zero || last().zero_speed);
  EXPECT_TRUE(is_done(plc.write_block(140, zeros)));
  EXPECT_TRUE(last().all_zero && !last().claims) << "a stop by the controlword";
}

TEST_F(Writes, the_log_says_once_that_what_is_not_new_needs_a_0_first) {
  std::vector<std::string> lines;
  desk.log = Log([&](LogLevel, std::string_view, std::string_view text) { lines.emplace_back(text); }, LogLevel::info);
  Line tool(desk, Role::operator_, kPanel);
  EXPECT_TRUE(is_done(tool.write(154, 7)));
  EXPECT_EQ(tool.write(154, 7), "86 06");
  EXPECT_EQ(tool.write(154, 7), "86 06");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("write 0 first"), std::string::npos) << lines[0];
}

/// A row of the table of design 3.3 Outcomes: how a write ended, what the client is answered and what register 25 says.
/// What an object's request (43/13) is answered is the same exception, but for a refusal by the drive.
struct Row {
  Errc code;
  int exception;
  int result;
};
constexpr Row kRows[] = {
    {Errc::ok, 0, 2},
    {Errc::not_supported, 0x02, 0},
    {Errc::bad_value, 0x03, 0},
    {Errc::refused_by_drive, 0x04, 3},
    {Errc::state_unsuitable, 0x04, 9},
    {Errc::queue_full, 0x06, 0},
    {Errc::superseded, 0x06, 5},
    {Errc::dropped_by_stop, 0x06, 6},
    {Errc::never_started, 0x06, 6},
    {Errc::still_in_setup, 0x06, 6},
    {Errc::identity_mismatch, 0x06, 6},
    {Errc::not_owner, 0x06, 7},
    {Errc::offline, 0x0A, 6},
    {Errc::timed_out, 0x0B, 4},
    {Errc::link_lost, 0x0B, 4},
    {Errc::role_forbidden, 0x01, 0},
};

TEST(Outcomes, are_answered_as_the_table_says_at_once_and_later) {
  for (const Row& row : kRows) {
    for (const bool slow : {false, true}) {
      SCOPED_TRACE(std::string(text(row.code)) + (slow ? ", later" : ", at once"));
      Desk desk;
      Line plc(desk);
      const BatchResult result{{row.code, 0x08000022}, 0, 0};
      desk.port.slow = slow;
      if (!slow) desk.port.at_once = {result};
      std::string reply = plc.write(146, 1);
      if (slow) {
        EXPECT_EQ(reply, "");
        desk.port.finish_with(result);
        reply = plc.reply();
      }
      EXPECT_TRUE(row.exception == 0 ? reply == "06 00 92 00 01" : is_exception(reply, row.exception)) << reply;
      EXPECT_EQ(plc.read(125, 3), word(row.result) + " 08 00 00 22");
      if (row.code == Errc::ok || row.code == Errc::refused_by_drive) continue;
      if (!slow) desk.port.at_once = {result};
      plc.send("2B 0D 00 00 01 10 08 00 00 00 00 00");
      if (slow) desk.port.finish_with(result);
      EXPECT_TRUE(is_exception(plc.reply(), row.exception)) << "of its object";
    }
  }
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
