// Requests built from exchanges, and the values found in replies.
#include "adapters/modbus_rtu/rtu_codec.hpp"

#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::modbus_rtu {
namespace {

using namespace test;

const RtuNode kHighFirst{.node = 1, .low_word_first = false};

std::string judged(std::string_view reply, const bus::Exchange& exchange, const RtuNode& node) {
  return verdict(judge(from_hex(reply), exchange, node));
}
std::string shown(const bus::ExchangeResult& result) { return testing::PrintToString(result); }

TEST(RtuRequest, reads_one_register_for_one_and_two_bytes_and_two_for_four) {
  EXPECT_EQ(request_hex(read_of(0x3500, 1)), "01 03 35 00 00 01");
  EXPECT_EQ(request_hex(read_of(0x3200, 2)), "01 03 32 00 00 01");
  EXPECT_EQ(request_hex(read_of(0x3700, 4)), "01 03 37 00 00 02");
  EXPECT_EQ(request_hex(read_of(0x3200, 0)), "01 03 32 00 00 01") << "of unknown size: one register";
}

TEST(RtuRequest, reads_from_the_first_register_of_the_first_to_the_last_of_the_last) {
  EXPECT_EQ(request_hex(block_of(108, 2, {{109, 2}})), "01 03 00 6C 00 02");
  EXPECT_EQ(request_hex(block_of(108, 2, {{109, 2}, {117, 4}})), "01 03 00 6C 00 0B");
  EXPECT_EQ(request_hex(block_of(100, 4, {{102, 1}})), "01 03 00 64 00 03");
}

TEST(RtuRequest, reads_up_to_the_last_register_there_is) {
  EXPECT_EQ(request_hex(read_of(0xFFFF, 2)), "01 03 FF FF 00 01");
  EXPECT_EQ(request_hex(block_of(1000, 2, {{1124, 2}})), "01 03 03 E8 00 7D") << "125 registers, the most there may be";
}

TEST(RtuRequest, writes_one_register_by_function_6) {
  EXPECT_EQ(request_hex(write_of(0x3100, 0x0F, 2)), "01 06 31 00 00 0F");
  EXPECT_EQ(request_hex(write_of(0x3500, 6, 1)), "01 06 35 00 00 06");
  EXPECT_EQ(request_hex(write_of(307, 0xFFFFFE0C, 2)), "01 06 01 33 FE 0C") << "the low two bytes of -500";
  EXPECT_EQ(request_hex(write_of(0x3500, 0xFFFFFFFD, 1)), "01 06 35 00 00 FD") << "the low byte alone";
}

TEST(RtuRequest, writes_four_bytes_whole_in_the_order_of_the_node) {
  EXPECT_EQ(request_hex(write_of(0x6F00, 0x00085555, 4)), "01 10 6F 00 00 02 04 55 55 00 08");
  EXPECT_EQ(request_hex(write_of(0x6F00, 0x00085555, 4), kHighFirst), "01 10 6F 00 00 02 04 00 08 55 55");
}

TEST(RtuRequest, goes_to_the_unit_of_the_exchange) {
  EXPECT_EQ(request_hex(write_of(323, 6, 2, 255), stepper_node()), "FF 06 01 43 00 06");
  EXPECT_EQ(request_hex(read_of(302, 2, 247)), "F7 03 01 2E 00 01");
}

TEST(RtuRequest, is_as_long_as_it_says_it_will_be) {
  EXPECT_EQ(request_bytes(read_of(302)), 8u);
  EXPECT_EQ(reply_bytes(read_of(302)), 7u);
  EXPECT_EQ(reply_bytes(read_of(304, 4)), 9u);
  EXPECT_EQ(reply_bytes(block_of(108, 2, {{117, 4}})), 5u + 2u * 11u);
  EXPECT_EQ(request_bytes(write_of(300, 1, 2)), 8u);
  EXPECT_EQ(reply_bytes(write_of(300, 1, 2)), 8u);
  EXPECT_EQ(request_bytes(write_of(312, 10000, 4)), 13u);
  EXPECT_EQ(reply_bytes(write_of(312, 10000, 4)), 8u);
}

TEST(RtuReply, gives_a_value_as_wide_as_was_asked) {
  EXPECT_EQ(judged("01 03 02 C0 37", read_of(0x3200, 2), kinco_node()), shown(value_of(0x3200, 2, 0xC037)));
  EXPECT_EQ(judged("01 03 02 C0 37", read_of(0x3200, 0), kinco_node()), shown(value_of(0x3200, 2, 0xC037)));
  EXPECT_EQ(judged("01 03 02 FF FD", read_of(0x3500, 1), kinco_node()), shown(value_of(0x3500, 1, 0xFD)))
      << "a byte stands in the low half, whatever a sign makes of the high one";
}

TEST(RtuReply, puts_the_words_together_in_the_order_of_the_node) {
  EXPECT_EQ(judged("01 03 04 27 10 00 01", read_of(304, 4), kinco_node()), shown(value_of(304, 4, 0x00012710)));
  EXPECT_EQ(judged("01 03 04 27 10 00 01", read_of(304, 4), kHighFirst), shown(value_of(304, 4, 0x27100001)));
}

TEST(RtuReply, gives_one_field_for_each_object_of_a_block_and_drops_what_lies_between) {
  const auto block = block_of(108, 2, {{109, 1}, {112, 4}, {115, 2}});
  EXPECT_EQ(judged("01 03 10 00 01 AA 02 DE AD BE EF 12 34 56 78 CA FE 00 09", block, kinco_node()),
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
  EXPECT_EQ(verdict(judge(reply, block_of(100, 2, more), kinco_node())), shown(values(fields)));
}

TEST(RtuReply, acknowledges_a_write_by_its_echo) {
  EXPECT_EQ(judged("01 06 31 00 00 0F", write_of(0x3100, 0x0F, 2), kinco_node()), shown({}));
  EXPECT_EQ(judged("01 06 35 00 00 FD", write_of(0x3500, 0xFFFFFFFD, 1), kinco_node()), shown({}));
  EXPECT_EQ(judged("01 10 6F 00 00 02", write_of(0x6F00, 0x85555, 4), kinco_node()), shown({}));
}

}  // namespace
}  // namespace axisgate::modbus_rtu
