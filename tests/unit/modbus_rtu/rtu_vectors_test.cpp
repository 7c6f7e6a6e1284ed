// SPDX-License-Identifier: Apache-2.0
// Every Modbus RTU frame of the sheets: both Kincos' from tests/vectors, the iD286pro's from id286pro_frames.hpp.
#include "tests/unit/bus/sheet_vectors.hpp"
#include "tests/unit/modbus_rtu/id286pro_frames.hpp"

namespace axisgate::modbus_rtu {
namespace {

using namespace test;

template <typename Which>
std::vector<SheetVector> vectors_that(Which which) {
  return sheet_vectors({"kinco-jd", "kinco-md"},
                       [&](const SheetVector& v) { return v.protocol() == "modbus-rtu" && which(v); });
}
bool any(const SheetVector&) { return true; }
bool crc_is_good(const SheetVector& v) { return v.row.at("checksum_ok"); }
bool is_request(const SheetVector& v) { return v.request() && crc_is_good(v); }
bool is_error(const SheetVector& v) { return v.decoded().contains("exception_code"); }
bool is_reply(const SheetVector& v) { return !v.request() && !is_error(v); }

/// Low word first, as both sheets say.
std::uint32_t value_of_registers(const nlohmann::json& registers) {
  std::uint32_t value = 0;
  for (std::size_t i = registers.size(); i-- > 0;) value = (value << 16) | number(registers[i]);
  return value;
}

/// The exchange that the sheet describes, as far as one frame of it tells.
bus::Exchange exchange_of(const SheetVector& vector) {
  const auto unit = static_cast<std::uint8_t>(vector.value("station"));
  const auto at = static_cast<std::uint16_t>(vector.says("address").is_null() ? 0 : vector.value("address"));
  const nlohmann::json registers = vector.says("registers");
  switch (vector.value("function")) {
    case 0x06:
      return write_of(at, vector.value("value"), 2, unit);
    case 0x10:
      return write_of(at, value_of_registers(registers), 4, unit);
    default: {
      const bool two = vector.says("count").is_null() ? registers.size() == 2 : vector.value("count") == 2;
      return read_of(at, two ? 4 : 2, unit);
    }
  }
}

class KincoRtuFrame : public testing::TestWithParam<SheetVector> {};
class KincoRtuRequest : public testing::TestWithParam<SheetVector> {};
class KincoRtuReply : public testing::TestWithParam<SheetVector> {};
class KincoRtuError : public testing::TestWithParam<SheetVector> {};

TEST_P(KincoRtuFrame, has_the_crc_that_the_sheet_says_it_has) {
  EXPECT_EQ(crc16(GetParam().printed) == 0, crc_is_good(GetParam()));
  if (crc_is_good(GetParam())) {
    EXPECT_EQ(with_crc(without_crc(GetParam().printed)), GetParam().printed);
  }
}

TEST_P(KincoRtuRequest, is_built_byte_for_byte_from_its_exchange) {
  EXPECT_EQ(request_hex(exchange_of(GetParam())), hex_text(without_crc(GetParam().printed)));
}

TEST_P(KincoRtuReply, answers_its_exchange_with_the_value_of_the_sheet) {
  const bus::Exchange exchange = exchange_of(GetParam());
  bus::ExchangeResult expected;
  if (exchange.access == bus::Access::read) {
    expected = value_of(exchange.object.index, exchange.size, value_of_registers(GetParam().says("registers")));
  }
  EXPECT_EQ(judged(without_crc(GetParam().printed), exchange), shown(expected));
}

TEST_P(KincoRtuError, refuses_the_exchange_with_its_code) {
  const std::uint32_t function = GetParam().value("function");
  const bus::Exchange exchange = function == 0x86   ? write_of(0x3100, 1, 2)
                                 : function == 0x90 ? write_of(0x6F00, 1, 4)
                                                    : read_of(0x3200);
  EXPECT_EQ(judged(without_crc(GetParam().printed), exchange), shown(refusal_of(GetParam().value("exception_code"))));
}

INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuFrame, testing::ValuesIn(vectors_that(any)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuRequest, testing::ValuesIn(vectors_that(is_request)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuReply, testing::ValuesIn(vectors_that(is_reply)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuError, testing::ValuesIn(vectors_that(is_error)), vector_name);

TEST(KincoRtuVectors, are_all_there) { EXPECT_EQ(vectors_that(any).size(), 80u); }

class Id286proExchange : public testing::TestWithParam<SheetExchange> {};

TEST_P(Id286proExchange, is_asked_and_answered_byte_for_byte) {
  const SheetExchange& sheet = GetParam();
  EXPECT_EQ(hex_text(with_crc(request_hex(sheet.exchange, stepper_node()))), sheet.request);
  ASSERT_EQ(crc16(from_hex(sheet.reply)), 0);
  EXPECT_EQ(judged(without_crc(from_hex(sheet.reply)), sheet.exchange, stepper_node()), shown(sheet.result));
}

INSTANTIATE_TEST_SUITE_P(Sheet, Id286proExchange, testing::ValuesIn(kId286pro),
                         [](const testing::TestParamInfo<SheetExchange>& it) { return std::string(it.param.name); });

TEST(Id286proVectors, the_call_to_all_is_built_byte_for_byte) {
  EXPECT_EQ(hex_text(with_crc(request_hex(write_of(323, 6, 2, 255), stepper_node()))), kId286proStopAll);
}

}  // namespace
}  // namespace axisgate::modbus_rtu
