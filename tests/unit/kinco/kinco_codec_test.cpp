// SPDX-License-Identifier: Apache-2.0
// Frames forth and back, exchanges as frames, frames in words. The sheets' frames: kinco_vectors_test.cpp.
#include "gateway/core/random.hpp"
#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using namespace std::chrono_literals;
using test::from_hex;
using test::read_of;
using test::value_of;
using test::write_of;
using test::operator+;

constexpr std::array kRequests{Command::read, Command::write_1, Command::write_2, Command::write_4};
constexpr std::array kValues{Command::value_1, Command::value_2, Command::value_4};

Frame reply(Command command, std::uint32_t data = 0) {
  return {.node = 1, .command = command, .object = {0x6041, 0}, .data = data};
}

TEST(KincoCodec, skips_one_byte_where_any_bit_makes_the_sum_wrong) {
  for (int bit = 0; bit < 80; ++bit) {
    auto bytes = from_hex(test::kStatusReply);
    bytes[static_cast<std::size_t>(bit / 8)] ^= static_cast<Byte>(1 << bit % 8);
    EXPECT_EQ(decode(bytes), Decoded(Bad{Bad::Reason::sum, 1})) << bit;
  }
}

TEST(KincoCodec, decodes_what_it_encodes_of_its_nine_commands_and_of_no_other) {
  Random random(1);
  int known = 0;
  for (int i = 0; i < 256 * 100; ++i) {
    const Frame frame{
        .node = static_cast<std::uint8_t>(random.below(256)),
        .command = static_cast<Command>(i % 256),
        .object = {static_cast<std::uint16_t>(random.below(0x10000)), static_cast<std::uint8_t>(random.below(256))},
        .data = static_cast<std::uint32_t>(random.next())};
    const Decoded decoded = decode(encode(frame));
    ASSERT_TRUE(decoded == Decoded(frame) || decoded == Decoded(Bad{Bad::Reason::command, 1}));
    known += decoded == Decoded(frame) ? 1 : 0;
  }
  EXPECT_EQ(known, 9 * 100);
  EXPECT_EQ(decode(FrameBytes{}), Decoded(Bad{Bad::Reason::command, 1})) << "ten zeros sum to zero";
}

TEST(KincoExchange, sends_only_the_bytes_that_the_width_has) {
  EXPECT_EQ(request_of(write_of(0x6060, 0xFFFFFFFD, 1)).data, 0xFDu);
  EXPECT_EQ(request_of(write_of(0x6040, 0xFFFF000F, 2)).data, 0x000Fu);
  EXPECT_EQ(request_of(write_of(0x607A, 0xFFFFFFFE, 4)).data, 0xFFFFFFFEu);
}

TEST(KincoExchange, a_read_is_answered_by_a_value_a_write_by_its_acknowledgement_both_by_an_error_none_by_a_request) {
  const auto read = read_of(0x6041, 0, 2);
  const auto write = write_of(0x6041, 1, 2);
  for (const Command command : kValues) {
    EXPECT_TRUE(answers(reply(command), read)) << "of any width: " << int(command);
    EXPECT_FALSE(answers(reply(command), write)) << int(command);
  }
  for (const Command command : kRequests) {
    EXPECT_FALSE(answers(reply(command), read) || answers(reply(command), write)) << int(command);
  }
  EXPECT_TRUE(answers(reply(Command::error), read) && answers(reply(Command::error), write));
  EXPECT_TRUE(answers(reply(Command::written), write) && answers(reply(Command::written, 1), write)) << "with echo too";
  EXPECT_FALSE(answers(reply(Command::written), read));
}

TEST(KincoExchange, another_station_index_or_sub_index_is_no_answer) {
  for (const bus::Exchange& other : {read_of(0x6041, 0, 2, 2), read_of(0x6040), read_of(0x6041, 1)}) {
    EXPECT_FALSE(answers(reply(Command::value_2), other));
    EXPECT_FALSE(answers(reply(Command::error), other));
  }
}

TEST(KincoExchange, a_value_has_the_width_that_the_drive_sent_and_no_more_bytes) {
  EXPECT_EQ(result_of(reply(Command::value_2, 0xFFFFC437)), value_of(0x6041, 2, 0xC437)) << "FD5P fills with FF";
  EXPECT_EQ(result_of(reply(Command::value_1, 0xFFFFFFFD)), value_of(0x6041, 1, 0xFD));
  EXPECT_EQ(result_of(reply(Command::value_4, 0xFFFFFFFD)), value_of(0x6041, 4, 0xFFFFFFFD));
  EXPECT_EQ(result_of(reply(Command::written, 0x0F)), bus::ExchangeResult{}) << "an acknowledgement carries no value";
}

TEST(KincoExchange, knows_the_time_on_the_wire) {
  EXPECT_EQ(wire_time(10'000, false), 20ms);
  EXPECT_EQ(wire_time(10'000, true), 30ms);
  EXPECT_EQ(wire_time(11'000, false, 11), 20ms);
  EXPECT_EQ(std::chrono::floor<std::chrono::microseconds>(wire_time(38'400, false)), 5208us) << "5.2 ms, JD 2.1";
  EXPECT_EQ(std::chrono::floor<std::chrono::microseconds>(wire_time(38'400, true)), 7812us) << "7.8 ms in a chain";
}

TEST(KincoText, reads_like_the_makers_tools) {
  EXPECT_EQ(describe(request_of(write_of(0x6040, 0x0F, 2))), "write 6040.00 = 0x000F");
  EXPECT_EQ(describe(request_of(write_of(0x6060, 0xFD, 1))), "write 6060.00 = 0xFD");
  EXPECT_EQ(describe(request_of(write_of(0x607A, 7650, 4))), "write 607A.00 = 0x00001DE2");
  EXPECT_EQ(describe(request_of(read_of(0x2FF0, 0x0C))), "read 2FF0.0C");
  EXPECT_EQ(describe(reply(Command::value_2, 0xFFFFC437)), "value 6041.00 = 0xC437");
  EXPECT_EQ(describe(reply(Command::value_1, 6)), "value 6041.00 = 0x06");
  EXPECT_EQ(describe(reply(Command::value_4, 6)), "value 6041.00 = 0x00000006");
  EXPECT_EQ(describe(reply(Command::written)), "written 6041.00");
  EXPECT_EQ(describe(reply(Command::error, 0x06020000)), "error 6041.00: 0x06020000");
}

}  // namespace
}  // namespace axisgate::kinco
