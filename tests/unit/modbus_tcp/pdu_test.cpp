// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/unit/modbus_tcp/support/hex.hpp"

namespace axisgate::modbus_tcp {
namespace {

using test::bytes;

ModbusException wrong(const std::string& told) {
  const auto zeros = told.find('+');
  std::vector<Byte> pdu = bytes(told.substr(0, zeros));
  if (zeros != std::string::npos) pdu.resize(pdu.size() + std::stoul(told.substr(zeros + 1)));
  const auto decoded = decode_request(pdu);
  const auto* exception = std::get_if<ModbusException>(&decoded);
  return exception == nullptr ? ModbusException::none : *exception;
}

Request right(const std::string& hex) {
  const auto decoded = decode_request(bytes(hex));
  EXPECT_TRUE(std::holds_alternative<Request>(decoded)) << hex;
  const auto* request = std::get_if<Request>(&decoded);
  return request == nullptr ? Request{} : *request;
}

TEST(Pdu, RefusesEveryFunctionItDoesNotHaveWhateverItsLength) {
  for (int function = 0; function < 256; ++function) {
    const Byte code = static_cast<Byte>(function);
    const bool known =
        (code >= 1 && code <= 6) || code == 8 || code == 15 || code == 16 || code == 22 || code == 23 || code == 43;
    for (const std::size_t more : {0U, 1U, 4U, 250U}) {
      std::vector<Byte> pdu(1 + more, 0);
      pdu[0] = code;
      const auto decoded = decode_request(pdu);
      const auto* exception = std::get_if<ModbusException>(&decoded);
      if (!known) {
        ASSERT_TRUE(exception != nullptr && *exception == ModbusException::illegal_function) << function;
      }
    }
  }
}

/// Requests between bars; "+246" at the end stands for so many zeros.
std::vector<std::string> each_of(const std::string& told) {
  std::vector<std::string> out;
  std::istringstream stream(told);
  for (std::string each; std::getline(stream, each, '|');) out.push_back(each);
  return out;
}

TEST(Pdu, takes_requests_whose_lengths_counts_and_values_hold) {
  // Reads of up to 2000 bits and 125 registers; writes of up to 1968 coils and 123 registers, 121 beside a read.
  for (const std::string& pdu : each_of(
           "01 0064 0001|01 0064 07D0|02 0064 07D0|03 0064 007D|04 0064 007D|05 0064 FF00|05 0064 0000|06 0064 1234|"
           "16 0064 F200 2500|0F 0064 0008 01 FF|0F 0064 0009 02 FF01|0F 0064 07B0 F6 +246|10 0064 0001 02 1234|"
           "10 0064 007B F6 +246|17 0064 007D 008C 0001 02 0006|17 0064 0001 008C 0079 F2 +242|08 0000 A537|"
           "08 0000 A537 0102|2B 0E 01 00|2B 0E 04 80|2B 0D 00 00 01 1008 00 0000 0000")) {
    EXPECT_EQ(wrong(pdu), ModbusException::none) << pdu;
  }
}

TEST(Pdu, refuses_every_other) {
  for (const std::string& pdu :
       each_of("01 0064 07D1|01 0064 0000|02 0064 07D1|03 0064 007E|03 0064 0000|04 0064 007E|03|03 0064 00|03 0064 "
               "0001 00|"
               "05 0064 0001|05 0064 FF01|05 0064 0100|05 0064 FF|06 0064 12|06 0064 1234 56|16 0064 F200 25|"
               "16 0064 F200 2500 00|0F 0064 0009 01 FF|0F 0064 0008 01|0F 0064 0008 01 FFFF|0F 0064 0000 00|"
               "0F 0064 07B1 F7 +247|10 0064 0002 02 1234|10 0064 0001 02 12|10 0064 0001 02 123456|10 0064 0000 00|"
               "10 0064 00|10 0064 007C F8 +247|17 0064 007E 008C 0001 02 0006|17 0064 0000 008C 0001 02 0006|"
               "17 0064 0001 008C 0000 00|17 0064 0001 008C 0001 04 0006|17 0064 0001 008C 0001 02 00|17 0064 0001|"
               "17 0064 0001 008C 007A F3 +243|08 0000|08 0000 A5|2B 0E 00 00|2B 0E 05 00|2B 0E 01|2B 0E 01 00 00|"
               "2B 0D 00 00 01 1008 00 0000 00|2B 0D|2B")) {
    EXPECT_EQ(wrong(pdu), ModbusException::illegal_data_value) << pdu;
  }
  EXPECT_EQ(wrong("2B 0F"), ModbusException::illegal_function);
}

TEST(Pdu, DecodesWhatIsAsked) {
  const Request read = right("03 00 64 00 02");
  EXPECT_TRUE(read.reads() && !read.writes());
  EXPECT_EQ(read.read_address, 100);
  EXPECT_EQ(read.read_count, 2);

  const Request coils = right("0F 00 64 00 0A 02 CD 01");
  EXPECT_TRUE(coils.writes() && coils.writes_coils());
  const bool expected[] = {true, false, true, true, false, false, true, true, true, false};
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(coils.written_coil(i), expected[i]) << i;

  const Request both = right("17 00 64 00 01 00 8C 00 02 04 00 06 12 34");
  EXPECT_TRUE(both.reads() && both.writes() && !both.writes_coils());
  EXPECT_EQ(both.write_address, 140);
  EXPECT_EQ(both.written_register(1), 0x1234);

  const Request mask = right("16 00 8C F2 00 25 00");
  EXPECT_EQ(mask.and_mask, 0xF200);
  EXPECT_EQ(mask.or_mask, 0x2500);
}

TEST(Pdu, RepliesToWritesRepeatTheirHead) {
  const auto reply = [](const std::string& pdu) {
    const Pdu made = write_reply(right(pdu));
    return hex_text({made.data(), made.size()});
  };
  EXPECT_EQ(reply("05 00 64 FF 00"), "05 00 64 FF 00");
  EXPECT_EQ(reply("05 00 64 00 00"), "05 00 64 00 00");
  EXPECT_EQ(reply("06 00 8C 00 0F"), "06 00 8C 00 0F");
  EXPECT_EQ(reply("0F 00 64 00 09 02 FF 01"), "0F 00 64 00 09");
  EXPECT_EQ(reply("10 00 8E 00 02 04 00 00 00 01"), "10 00 8E 00 02");
  EXPECT_EQ(reply("16 00 8C F2 00 25 00"), "16 00 8C F2 00 25 00");
}

}  // namespace
}  // namespace axisgate::modbus_tcp
