// SPDX-License-Identifier: Apache-2.0
// Requests built from exchanges, the values found in replies, frames in words, times on the line.
#include "adapters/modbus_rtu/rtu_codec.hpp"

#include "adapters/modbus_rtu/rtu_text.hpp"
#include "adapters/modbus_rtu/rtu_timing.hpp"
#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::modbus_rtu {
namespace {

using namespace test;

const RtuNode kHighFirst{.node = 1, .low_word_first = false};

TEST(RtuRequest, of_a_read_reaches_from_the_first_register_of_the_first_object_to_the_last_of_the_last) {
  EXPECT_EQ(request_hex(read_of(0x3500, 1)), "01 03 35 00 00 01");
  EXPECT_EQ(request_hex(read_of(0x3200, 2)), "01 03 32 00 00 01");
  EXPECT_EQ(request_hex(read_of(0x3700, 4)), "01 03 37 00 00 02");
  EXPECT_EQ(request_hex(read_of(0x3200, 0)), "01 03 32 00 00 01") << "of unknown size: one register";
  EXPECT_EQ(request_hex(block_of(108, 2, {{109, 2}})), "01 03 00 6C 00 02");
  EXPECT_EQ(request_hex(block_of(108, 2, {{109, 2}, {117, 4}})), "01 03 00 6C 00 0B");
  EXPECT_EQ(request_hex(block_of(100, 4, {{102, 1}})), "01 03 00 64 00 03");
  EXPECT_EQ(request_hex(read_of(0xFFFF, 2)), "01 03 FF FF 00 01");
  EXPECT_EQ(request_hex(block_of(1000, 2, {{1124, 2}})), "01 03 03 E8 00 7D") << "125 registers, the most there may be";
}

TEST(RtuRequest, of_a_write_carries_the_bytes_of_its_width_in_the_order_of_the_node) {
  EXPECT_EQ(request_hex(write_of(0x3100, 0x0F, 2)), "01 06 31 00 00 0F");
  EXPECT_EQ(request_hex(write_of(0x3500, 6, 1)), "01 06 35 00 00 06");
  EXPECT_EQ(request_hex(write_of(307, 0xFFFFFE0C, 2)), "01 06 01 33 FE 0C") << "the low two bytes of -500";
  EXPECT_EQ(request_hex(write_of(0x3500, 0xFFFFFFFD, 1)), "01 06 35 00 00 FD") << "the low byte alone";
  EXPECT_EQ(request_hex(write_of(0x6F00, 0x00085555, 4)), "01 10 6F 00 00 02 04 55 55 00 08");
  EXPECT_EQ(request_hex(write_of(0x6F00, 0x00085555, 4), kHighFirst), "01 10 6F 00 00 02 04 00 08 55 55");
}

/// Of another table than the holding registers.
bus::Exchange in_table(ModbusTable table, bus::Exchange exchange) {
  exchange.object.sub = static_cast<std::uint8_t>(table);
  return exchange;
}

TEST(RtuRequest, has_the_function_of_the_table) {
  using enum ModbusTable;
  EXPECT_EQ(request_hex(in_table(input, read_of(12, 4))), "01 04 00 0C 00 02");
  EXPECT_EQ(request_hex(in_table(coil, read_of(3, 1))), "01 01 00 03 00 01");
  EXPECT_EQ(request_hex(in_table(discrete, read_of(4, 1))), "01 02 00 04 00 01");
  EXPECT_EQ(request_hex(in_table(coil, write_of(3, 1, 1))), "01 05 00 03 FF 00");
  EXPECT_EQ(request_hex(in_table(coil, write_of(3, 0, 1))), "01 05 00 03 00 00");
}

TEST(RtuReply, of_another_table_is_taken_by_its_function_and_length) {
  using enum ModbusTable;
  const bus::Exchange bit = in_table(coil, read_of(3, 1)), pin = in_table(discrete, read_of(4, 1));
  const bus::Exchange on = in_table(coil, write_of(3, 1, 1)), word = in_table(input, read_of(12, 2));
  EXPECT_EQ(judged(from_hex("01 01 01 FF"), bit), shown(values({{bit.object, 1, 1}}))) << "the bits above are padding";
  EXPECT_EQ(judged(from_hex("01 02 01 00"), pin), shown(values({{pin.object, 1, 0}})));
  EXPECT_EQ(judged(from_hex("01 01 02 01 00"), bit), "another length");
  EXPECT_EQ(judged(from_hex("01 02 01 01"), bit), "another function");
  EXPECT_EQ(judged(from_hex("01 04 02 01 02"), word), shown(values({{word.object, 2, 0x0102}})));
  EXPECT_EQ(judged(from_hex("01 03 02 01 02"), word), "another function");
  EXPECT_EQ(judged(from_hex("01 05 00 03 FF 00"), on), shown({}));
  EXPECT_EQ(judged(from_hex("01 05 00 03 00 00"), on), "another echo");
  EXPECT_EQ(reply_bytes(bit), 6U);
  EXPECT_EQ(reply_bytes(on), 8U);
}

TEST(RtuRequest, goes_to_the_unit_of_the_exchange) {
  EXPECT_EQ(request_hex(write_of(323, 6, 2, 255), stepper_node()), "FF 06 01 43 00 06");
  EXPECT_EQ(request_hex(read_of(302, 2, 247)), "F7 03 01 2E 00 01");
}

TEST(RtuRequest, is_as_long_as_it_says_it_will_be_and_so_is_its_reply) {
  EXPECT_EQ(request_bytes(read_of(302)), 8u);
  EXPECT_EQ(reply_bytes(read_of(302)), 7u);
  EXPECT_EQ(reply_bytes(read_of(304, 4)), 9u);
  EXPECT_EQ(reply_bytes(block_of(108, 2, {{117, 4}})), 5u + 2u * 11u);
  EXPECT_EQ(request_bytes(write_of(300, 1, 2)), 8u);
  EXPECT_EQ(reply_bytes(write_of(300, 1, 2)), 8u);
  EXPECT_EQ(request_bytes(write_of(312, 10000, 4)), 13u);
  EXPECT_EQ(reply_bytes(write_of(312, 10000, 4)), 8u);
}

TEST(RtuReply, gives_a_value_as_wide_as_was_asked_in_the_order_of_the_node) {
  EXPECT_EQ(judged(from_hex("01 03 02 C0 37"), read_of(0x3200, 2)), shown(value_of(0x3200, 2, 0xC037)));
  EXPECT_EQ(judged(from_hex("01 03 02 C0 37"), read_of(0x3200, 0)), shown(value_of(0x3200, 2, 0xC037)));
  EXPECT_EQ(judged(from_hex("01 03 02 FF FD"), read_of(0x3500, 1)), shown(value_of(0x3500, 1, 0xFD)))
      << "a byte stands in the low half, whatever a sign makes of the high one";
  const ByteRow two_words = from_hex("01 03 04 27 10 00 01");
  EXPECT_EQ(judged(two_words, read_of(304, 4)), shown(value_of(304, 4, 0x00012710)));
  EXPECT_EQ(judged(two_words, read_of(304, 4), kHighFirst), shown(value_of(304, 4, 0x27100001)));
}

TEST(RtuReply, gives_one_field_for_each_object_of_a_block_and_drops_what_lies_between) {
  EXPECT_EQ(judged(from_hex("01 03 10 00 01 AA 02 DE AD BE EF 12 34 56 78 CA FE 00 09"),
                   block_of(108, 2, {{109, 1}, {112, 4}, {115, 2}})),
            shown(values({{{108, 0}, 2, 1}, {{109, 0}, 1, 2}, {{112, 0}, 4, 0x56781234}, {{115, 0}, 2, 9}})));
}

TEST(RtuReply, gives_the_longest_list_that_an_answer_carries) {
  std::vector<std::pair<std::uint16_t, std::uint8_t>> more;
  ByteRow reply = from_hex("01 03 34 00 64");
  std::vector<bus::ReplyField> fields{{{100, 0}, 2, 100}};
  for (std::uint16_t at = 101; at < 126; ++at) {
    more.push_back({at, 2});
    reply = reply + ByteRow{0, static_cast<Byte>(at)};
    fields.push_back({{at, 0}, 2, at});
  }
  EXPECT_EQ(judged(reply, block_of(100, 2, more)), shown(values(fields)));
}

TEST(RtuText, says_what_is_asked_and_answered) {
  const auto asked = [](const char* hex) { return describe_request(from_hex(hex)); };
  const auto answered = [](const char* hex) { return describe_reply(from_hex(hex)); };
  EXPECT_EQ(asked("01 03 01 30 00 02"), "unit 1: read 2 registers at 304 (0x0130)");
  EXPECT_EQ(asked("01 03 01 2E 00 01"), "unit 1: read 1 register at 302 (0x012E)");
  EXPECT_EQ(asked("01 06 01 2C 00 01"), "unit 1: write 300 (0x012C) = 0x0001");
  EXPECT_EQ(asked("01 10 01 38 00 02 04 27 10 00 00"), "unit 1: write 312 (0x0138) = 0x2710 0x0000");
  EXPECT_EQ(asked("01 2B 0E 01 00 00 00"), "unit 1: function 0x2B, 7 bytes");
  EXPECT_EQ(answered("01 03 04 27 10 00 00"), "unit 1: 2 registers = 0x2710 0x0000");
  EXPECT_EQ(answered("01 06 01 2C 00 01"), "unit 1: written 300 (0x012C) = 0x0001");
  EXPECT_EQ(answered("01 10 01 38 00 02"), "unit 1: written 2 registers at 312 (0x0138)");
  EXPECT_EQ(answered("01 83 02"), "unit 1: error 0x83: illegal data address (0x02)");
  EXPECT_EQ(answered("01 81 FF"), "unit 1: error 0x81: unknown code (0xFF)");
}

TEST(RtuText, has_a_line_for_any_bytes) {
  for (std::size_t size = 0; size <= kMaxFrame; ++size) {
    for (const int function : {0x03, 0x06, 0x10, 0x83, 0x00, 0xFF}) {
      ByteRow frame(size, 0x11);
      if (size > 1) frame[1] = static_cast<Byte>(function);
      for (const std::string& line : {describe_request(frame), describe_reply(frame)}) {
        EXPECT_FALSE(line.empty());
        EXPECT_EQ(line.find('\n'), std::string::npos);
      }
    }
  }
}

static_assert(wire_time(19200, 0, 8, 9) == 8'854'166ns, "iD286pro: a read of two registers takes 8.9 ms at 19200 baud");
static_assert(wire_time(9600, 1, 1, 0) == 1'145'833ns, "a byte with parity has eleven bits");
static_assert(wire_time(115200, 0, 0, 0) == 0ns);
static_assert(wire_time(50, 1, 256, 256) == 112'640ms, "the longest frames on the slowest line do not wrap");
static_assert(gap_time(19200) == 2'005'208ns && gap_time(9600) == 4'010'416ns);
static_assert(gap_time(19201) == 1750us && gap_time(3'000'000) == 1750us, "fixed above 19200 baud");

}  // namespace
}  // namespace axisgate::modbus_rtu
