#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using namespace std::chrono_literals;
using test::read_of;
using test::value_of;
using test::write_of;

Frame reply(Command command, std::uint32_t data = 0) {
  return {.node = 1, .command = command, .object = {0x6041, 0}, .data = data};
}

TEST(KincoExchange, asks_as_the_manual_prints_it) {
  EXPECT_EQ(test::row(encode(request_of(read_of(0x6041)))), test::from_hex(test::kReadStatus));
  EXPECT_EQ(test::row(encode(request_of(write_of(0x6040, 0x0F, 2)))), test::from_hex(test::kWriteControl));
}

TEST(KincoExchange, sends_only_the_bytes_that_the_width_has) {
  EXPECT_EQ(request_of(write_of(0x6060, 0xFFFFFFFD, 1)).data, 0xFDu);
  EXPECT_EQ(request_of(write_of(0x6040, 0xFFFF000F, 2)).data, 0x000Fu);
  EXPECT_EQ(request_of(write_of(0x607A, 0xFFFFFFFE, 4)).data, 0xFFFFFFFEu);
}

TEST(KincoExchange, a_read_is_answered_by_a_value_of_any_width_or_an_error) {
  const auto read = read_of(0x6041, 0, 2);
  for (const Command command : {Command::value_1, Command::value_2, Command::value_4, Command::error}) {
    EXPECT_TRUE(answers(reply(command), read)) << int(command);
  }
  for (const Command command :
       {Command::written, Command::read, Command::write_1, Command::write_2, Command::write_4}) {
    EXPECT_FALSE(answers(reply(command), read)) << int(command);
  }
}

TEST(KincoExchange, a_write_is_answered_by_its_acknowledgement_or_an_error) {
  const auto write = write_of(0x6041, 1, 2);
  EXPECT_TRUE(answers(reply(Command::written), write)) << "no echo of the data";
  EXPECT_TRUE(answers(reply(Command::written, 1), write)) << "with echo";
  EXPECT_TRUE(answers(reply(Command::error), write));
  for (const Command command :
       {Command::value_1, Command::value_2, Command::value_4, Command::read, Command::write_2}) {
    EXPECT_FALSE(answers(reply(command), write)) << int(command);
  }
}

TEST(KincoExchange, another_station_index_or_sub_index_is_no_answer) {
  const auto read = read_of(0x6041);
  Frame frame = reply(Command::value_2);
  frame.node = 2;
  EXPECT_FALSE(answers(frame, read));
  frame = reply(Command::value_2);
  frame.object.index = 0x6040;
  EXPECT_FALSE(answers(frame, read));
  frame = reply(Command::error);
  frame.object.sub = 1;
  EXPECT_FALSE(answers(frame, read));
}

TEST(KincoExchange, a_value_has_the_width_that_the_drive_sent_and_no_more_bytes) {
  EXPECT_EQ(result_of(reply(Command::value_2, 0xFFFFC437)), value_of(0x6041, 2, 0xC437)) << "FD5P fills with FF";
  EXPECT_EQ(result_of(reply(Command::value_1, 0xFFFFFFFD)), value_of(0x6041, 1, 0xFD));
  EXPECT_EQ(result_of(reply(Command::value_4, 0xFFFFFFFD)), value_of(0x6041, 4, 0xFFFFFFFD));
}

TEST(KincoExchange, an_acknowledgement_carries_no_value) {
  EXPECT_EQ(result_of(reply(Command::written, 0x0F)), bus::ExchangeResult{});
}

TEST(KincoExchange, an_error_carries_the_drives_code) {
  const auto result = result_of(reply(Command::error, 0x06020000));
  EXPECT_EQ(result.code, Errc::refused_by_drive);
  EXPECT_EQ(result.detail, 0x06020000u);
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
