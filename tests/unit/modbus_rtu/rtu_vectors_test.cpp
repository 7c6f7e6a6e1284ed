// Every Modbus RTU frame of the sheets: both Kincos' from tests/vectors, the iD286pro's from id286pro_frames.hpp.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/unit/modbus_rtu/id286pro_frames.hpp"

namespace axisgate::modbus_rtu {
namespace {

using namespace test;

struct Vector {
  std::string id;
  ByteRow bytes;
  bool crc_is_good = false;
  bool is_request = false;
  nlohmann::json decoded;
};
void PrintTo(const Vector& vector, std::ostream* out) { *out << vector.id; }

std::uint32_t number(const nlohmann::json& value) {
  if (value.is_string()) return static_cast<std::uint32_t>(std::stoul(value.get<std::string>(), nullptr, 16));
  return static_cast<std::uint32_t>(value.get<std::int64_t>());
}

template <typename Which>
std::vector<Vector> vectors_that(Which which) {
  std::vector<Vector> all;
  for (const char* name : {"kinco-jd", "kinco-md"}) {
    std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/" + name + ".json");
    const auto sheet = nlohmann::json::parse(file);
    for (const auto& vector : sheet.at("vectors")) {
      if (vector.at("protocol") != "modbus-rtu") continue;
      Vector made{std::string(name) + "/" + vector.at("id").get<std::string>(),
                  from_hex(vector.at("hex").get<std::string>()), vector.at("checksum_ok").get<bool>(),
                  vector.at("direction") == "request", vector.at("decoded")};
      if (which(made)) all.push_back(std::move(made));
    }
  }
  return all;
}

/// Low word first, as both sheets say.
std::uint32_t value_of_registers(const nlohmann::json& registers) {
  std::uint32_t value = 0;
  for (std::size_t i = registers.size(); i-- > 0;) value = (value << 16) | number(registers[i]);
  return value;
}

/// The exchange that the sheet describes, as far as one frame of it tells.
bus::Exchange exchange_of(const nlohmann::json& decoded) {
  const auto unit = decoded.at("station").get<std::uint8_t>();
  const auto at = static_cast<std::uint16_t>(decoded.contains("address") ? number(decoded.at("address")) : 0);
  switch (number(decoded.at("function"))) {
    case 0x06:
      return write_of(at, number(decoded.at("value")), 2, unit);
    case 0x10:
      return write_of(at, decoded.contains("registers") ? value_of_registers(decoded.at("registers")) : 0, 4, unit);
    default: {
      const std::size_t count = decoded.contains("count")       ? number(decoded.at("count"))
                                : decoded.contains("registers") ? decoded.at("registers").size()
                                                                : 1;
      return read_of(at, count == 2 ? 4 : 2, unit);
    }
  }
}

class KincoRtuFrame : public testing::TestWithParam<Vector> {};
class KincoRtuRequest : public testing::TestWithParam<Vector> {};
class KincoRtuReply : public testing::TestWithParam<Vector> {};
class KincoRtuError : public testing::TestWithParam<Vector> {};

TEST_P(KincoRtuFrame, has_the_crc_that_the_sheet_says_it_has) {
  EXPECT_EQ(crc16(GetParam().bytes) == 0, GetParam().crc_is_good);
  if (GetParam().crc_is_good) {
    EXPECT_EQ(with_crc(without_crc(GetParam().bytes)), GetParam().bytes);
  }
}

TEST_P(KincoRtuRequest, is_built_byte_for_byte_from_its_exchange) {
  EXPECT_EQ(request_hex(exchange_of(GetParam().decoded)), hex_text(without_crc(GetParam().bytes)));
}

TEST_P(KincoRtuReply, answers_its_exchange_with_the_value_of_the_sheet) {
  const bus::Exchange exchange = exchange_of(GetParam().decoded);
  bus::ExchangeResult expected;
  if (exchange.access == bus::Access::read) {
    expected = value_of(exchange.object.index, exchange.size, value_of_registers(GetParam().decoded.at("registers")));
  }
  EXPECT_EQ(verdict(judge(without_crc(GetParam().bytes), exchange, kinco_node())), testing::PrintToString(expected));
}

TEST_P(KincoRtuError, refuses_the_exchange_with_its_code) {
  const std::uint32_t function = number(GetParam().decoded.at("function"));
  const bus::Exchange exchange = function == 0x86   ? write_of(0x3100, 1, 2)
                                 : function == 0x90 ? write_of(0x6F00, 1, 4)
                                                    : read_of(0x3200);
  EXPECT_EQ(verdict(judge(without_crc(GetParam().bytes), exchange, kinco_node())),
            testing::PrintToString(refused(number(GetParam().decoded.at("exception_code")), false)));
}

std::string test_name(const testing::TestParamInfo<Vector>& info) {
  std::string name = info.param.id;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}
bool is_error(const Vector& vector) { return vector.decoded.contains("exception_code"); }

INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuFrame, testing::ValuesIn(vectors_that([](const Vector&) { return true; })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuRequest, testing::ValuesIn(vectors_that([](const Vector& vector) {
                           return vector.is_request && vector.crc_is_good;
                         })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuReply, testing::ValuesIn(vectors_that([](const Vector& vector) {
                           return !vector.is_request && !is_error(vector);
                         })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRtuError, testing::ValuesIn(vectors_that(is_error)), test_name);

TEST(KincoRtuVectors, are_all_there) {
  EXPECT_EQ(vectors_that([](const Vector&) { return true; }).size(), 80u);
}

class Id286proExchange : public testing::TestWithParam<SheetExchange> {};

TEST_P(Id286proExchange, is_asked_and_answered_byte_for_byte) {
  const SheetExchange& sheet = GetParam();
  EXPECT_EQ(hex_text(with_crc(request_hex(sheet.exchange, stepper_node()))), sheet.request);
  ASSERT_EQ(crc16(from_hex(sheet.reply)), 0);
  EXPECT_EQ(verdict(judge(without_crc(from_hex(sheet.reply)), sheet.exchange, stepper_node())),
            testing::PrintToString(sheet.result));
}

INSTANTIATE_TEST_SUITE_P(Sheet, Id286proExchange, testing::ValuesIn(kId286pro),
                         [](const testing::TestParamInfo<SheetExchange>& it) { return std::string(it.param.name); });

TEST(Id286proVectors, the_call_to_all_is_built_byte_for_byte) {
  EXPECT_EQ(hex_text(with_crc(request_hex(write_of(323, 6, 2, 255), stepper_node()))), kId286proStopAll);
}

}  // namespace
}  // namespace axisgate::modbus_rtu
