#include "gateway/upstream/modbus_tcp/pdu.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/modbus_tcp/support/hex.hpp"

namespace axisgate::modbus_tcp {
namespace {

using test::bytes;
using enum ModbusException;

ModbusException wrong(const std::string& hex) {
  const auto decoded = decode_request(bytes(hex));
  const auto* exception = std::get_if<ModbusException>(&decoded);
  return exception == nullptr ? none : *exception;
}

Request right(const std::string& hex) {
  const auto decoded = decode_request(bytes(hex));
  EXPECT_TRUE(std::holds_alternative<Request>(decoded)) << hex;
  const auto* request = std::get_if<Request>(&decoded);
  return request == nullptr ? Request{} : *request;
}

std::string zeros(std::size_t count) { return std::string(2 * count, '0'); }

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
        ASSERT_TRUE(exception != nullptr && *exception == illegal_function) << function;
      }
    }
  }
}

struct Table {
  const char* pdu;
  ModbusException exception;
};

TEST(Pdu, ChecksLengthsAndCountsOfReads) {
  const Table rows[] = {
      {"01 00 64 00 01", none},
      {"01 00 64 07 D0", none},                // 2000
      {"01 00 64 07 D1", illegal_data_value},  // 2001
      {"01 00 64 00 00", illegal_data_value},
      {"02 00 64 07 D0", none},
      {"02 00 64 07 D1", illegal_data_value},
      {"03 00 64 00 7D", none},                // 125
      {"03 00 64 00 7E", illegal_data_value},  // 126
      {"03 00 64 00 00", illegal_data_value},
      {"04 00 64 00 7D", none},
      {"04 00 64 00 7E", illegal_data_value},
      {"03", illegal_data_value},
      {"03 00 64 00", illegal_data_value},
      {"03 00 64 00 01 00", illegal_data_value},
  };
  for (const Table& row : rows) EXPECT_EQ(wrong(row.pdu), row.exception) << row.pdu;
}

TEST(Pdu, ChecksLengthsAndValuesOfSingleWrites) {
  const Table rows[] = {
      {"05 00 64 FF 00", none},
      {"05 00 64 00 00", none},
      {"05 00 64 00 01", illegal_data_value},
      {"05 00 64 FF 01", illegal_data_value},
      {"05 00 64 01 00", illegal_data_value},
      {"05 00 64 FF", illegal_data_value},
      {"06 00 64 12 34", none},
      {"06 00 64 12", illegal_data_value},
      {"06 00 64 12 34 56", illegal_data_value},
      {"16 00 64 F2 00 25 00", none},
      {"16 00 64 F2 00 25", illegal_data_value},
      {"16 00 64 F2 00 25 00 00", illegal_data_value},
  };
  for (const Table& row : rows) EXPECT_EQ(wrong(row.pdu), row.exception) << row.pdu;
}

TEST(Pdu, ChecksCountsAndByteCountsOfSeveralWrites) {
  const auto check = [](const std::string& pdu, ModbusException exception) {
    EXPECT_EQ(wrong(pdu), exception) << pdu.substr(0, 20);
  };
  check("0F 00 64 00 08 01 FF", none);
  check("0F 00 64 00 09 02 FF 01", none);
  check("0F 00 64 00 09 01 FF", illegal_data_value);
  check("0F 00 64 00 08 01", illegal_data_value);
  check("0F 00 64 00 08 01 FF FF", illegal_data_value);
  check("0F 00 64 00 00 00", illegal_data_value);
  check("0F 00 64 07 B0 F6" + zeros(246), none);                // 1968
  check("0F 00 64 07 B1 F7" + zeros(247), illegal_data_value);  // 1969
  check("10 00 64 00 01 02 12 34", none);
  check("10 00 64 00 02 02 12 34", illegal_data_value);
  check("10 00 64 00 01 02 12", illegal_data_value);
  check("10 00 64 00 01 02 12 34 56", illegal_data_value);
  check("10 00 64 00 00 00", illegal_data_value);
  check("10 00 64 00", illegal_data_value);
  check("10 00 64 00 7B F6" + zeros(246), none);                // 123
  check("10 00 64 00 7C F8" + zeros(247), illegal_data_value);  // 124, as much as a PDU takes
}

TEST(Pdu, ChecksBothHalvesOfFunction23) {
  const auto check = [](const std::string& pdu, ModbusException exception) {
    EXPECT_EQ(wrong(pdu), exception) << pdu.substr(0, 32);
  };
  check("17 00 64 00 7D 00 8C 00 01 02 00 06", none);
  check("17 00 64 00 7E 00 8C 00 01 02 00 06", illegal_data_value);
  check("17 00 64 00 00 00 8C 00 01 02 00 06", illegal_data_value);
  check("17 00 64 00 01 00 8C 00 00 00", illegal_data_value);
  check("17 00 64 00 01 00 8C 00 01 04 00 06", illegal_data_value);
  check("17 00 64 00 01 00 8C 00 01 02 00", illegal_data_value);
  check("17 00 64 00 01", illegal_data_value);
  check("17 00 64 00 01 00 8C 00 79 F2" + zeros(242), none);                // 121
  check("17 00 64 00 01 00 8C 00 7A F3" + zeros(243), illegal_data_value);  // 122
}

TEST(Pdu, ChecksDiagnosticsAndIdentification) {
  const Table rows[] = {
      {"08 00 00 A5 37", none},
      {"08 00 00 A5 37 01 02", none},
      {"08 00 00", illegal_data_value},
      {"08 00 00 A5", illegal_data_value},
      {"2B 0E 01 00", none},
      {"2B 0E 04 80", none},
      {"2B 0E 00 00", illegal_data_value},
      {"2B 0E 05 00", illegal_data_value},
      {"2B 0E 01", illegal_data_value},
      {"2B 0E 01 00 00", illegal_data_value},
      {"2B 0D 00 00 01 10 08 00 00 00 00 00", none},
      {"2B 0D 00 00 01 10 08 00 00 00 00", illegal_data_value},
      {"2B 0D", illegal_data_value},
      {"2B 0F", illegal_function},
      {"2B", illegal_data_value},
  };
  for (const Table& row : rows) EXPECT_EQ(wrong(row.pdu), row.exception) << row.pdu;
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

TEST(Pdu, ExceptionsCarryTheFunctionWithItsHighBitSet) {
  const Pdu pdu = exception_pdu(0x03, illegal_data_address);
  EXPECT_EQ(hex_text({pdu.data(), pdu.size()}), "83 02");
}

}  // namespace
}  // namespace axisgate::modbus_tcp
