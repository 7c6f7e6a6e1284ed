// Every CANopen frame of the three drive sheets (tests/vectors), through codec and wire.
#include <fstream>
#include <nlohmann/json.hpp>

#include "adapters/canopen/cob_id.hpp"
#include "adapters/canopen/emergency.hpp"
#include "adapters/canopen/nmt.hpp"
#include "adapters/canopen/process_data.hpp"
#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

using nlohmann::json;

struct Vector {
  std::string id;
  std::string protocol;
  bool request = false;
  bool well_formed = true;
  std::uint32_t can_id = 0;
  ByteRow bytes;
  ByteRow corrected;  ///< as it must be sent: padded, or what a misprint was meant to be
  bool remote = false;
  json decoded;
};
void PrintTo(const Vector& vector, std::ostream* out) { *out << vector.id; }

std::uint32_t number(const json& value) {
  return value.is_string() ? static_cast<std::uint32_t>(std::stoul(value.get<std::string>(), nullptr, 16))
                           : static_cast<std::uint32_t>(value.get<std::int64_t>());
}

Vector vector_of(const std::string& sheet, const json& row) {
  Vector vector;
  vector.id = sheet + "/" + row.at("id").get<std::string>();
  vector.protocol = row.at("protocol");
  vector.request = row.at("direction") == "request";
  vector.well_formed = row.value("well_formed", true);
  vector.can_id = number(row.at("can_id"));
  const std::string hex = row.at("hex");
  vector.bytes = from_hex(hex);
  const std::string padded = row.value("hex_padded", hex);
  vector.corrected = from_hex(row.value("hex_corrected", padded));
  vector.remote = row.value("rtr", false);
  vector.decoded = row.at("decoded");
  return vector;
}

template <typename Which>
std::vector<Vector> vectors_that(Which which) {
  std::vector<Vector> all;
  for (const char* name : {"kinco-jd", "kinco-md", "leadshine-ld2-can"}) {
    std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/" + name + ".json");
    const json sheet = json::parse(file);
    for (const json& row : sheet.at("vectors")) {
      if (row.at("protocol").get<std::string>().rfind("canopen", 0) != 0) continue;
      const Vector vector = vector_of(name, row);
      if (which(vector)) all.push_back(vector);
    }
  }
  return all;
}

bool good_sdo(const Vector& v) { return v.protocol == "canopen-sdo" && v.well_formed; }

std::string test_name(const testing::TestParamInfo<Vector>& info) {
  std::string name = info.param.id;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

bus::Exchange exchange_of(const json& decoded) {
  const auto index = static_cast<std::uint16_t>(number(decoded.at("index")));
  const auto sub = static_cast<std::uint8_t>(number(decoded.at("sub")));
  const auto node = decoded.at("node").get<std::uint8_t>();
  bus::Exchange exchange = read_of(index, sub, 0, node);
  if (decoded.at("op") == "write" || decoded.at("op") == "write-ok") {
    exchange.access = bus::Access::write;
    exchange.size = static_cast<std::uint8_t>(decoded.value("size", 2));
    exchange.raw = decoded.contains("value") ? number(decoded.at("value")) : 0;
  }
  return exchange;
}

class Sheets : public CanopenWireStage, public testing::WithParamInterface<Vector> {
 protected:
  void SetUp() override {
    std::vector<canopen::CanopenNode> nodes;
    for (std::uint8_t node = 1; node <= 6; ++node) nodes.push_back({.node = node});
    begin({.name = "can0", .nodes = nodes});
  }
};

using SdoRequests = Sheets;
using SdoReplies = Sheets;
using NmtCommands = Sheets;
using ErrorControls = Sheets;
using Emergencies = Sheets;
using Misprints = Sheets;

TEST_P(SdoRequests, are_sent_byte_for_byte_padded_to_eight) {
  const Vector& v = GetParam();
  wire->send(exchange_of(v.decoded));
  EXPECT_THAT(link->sent, testing::ElementsAre(can::data_frame(v.can_id, v.corrected)));
}

TEST_P(SdoReplies, answer_the_request_they_belong_to_as_printed_and_padded) {
  const Vector& v = GetParam();
  for (const ByteRow& bytes : {v.bytes, v.corrected}) {
    wire->send(exchange_of(v.decoded));
    bring(can::data_frame(v.can_id, bytes));
    ASSERT_FALSE(replies.empty());
    const bus::ExchangeResult& result = replies.back();
    if (v.decoded.contains("error_code")) {
      EXPECT_EQ(result, refusal_of(number(v.decoded.at("error_code"))));
    } else if (v.decoded.at("op") == "read-ok") {
      ASSERT_EQ(result.fields.size(), 1u);
      EXPECT_EQ(result.fields[0].size, number(v.decoded.at("size")));
      const std::uint32_t mask = result.fields[0].size == 4 ? ~0U : (1U << (8 * result.fields[0].size)) - 1;
      EXPECT_EQ(result.fields[0].raw, number(v.decoded.at("value")) & mask);
    } else {
      EXPECT_EQ(result, bus::ExchangeResult{});
    }
  }
}

/// The examples of one manual print them with seven or eight bytes.
TEST_P(NmtCommands, are_sent_with_exactly_two_bytes) {
  const Vector& v = GetParam();
  wire->send(nmt_of(number(v.decoded.at("command")), static_cast<std::uint8_t>(v.corrected.at(1))));
  EXPECT_THAT(link->sent, testing::ElementsAre(can::data_frame(v.can_id, v.corrected)));
  runtime.run_due();
  EXPECT_THAT(replies, testing::ElementsAre(bus::ExchangeResult{}));
}

TEST_P(ErrorControls, tell_the_nodes_state) {
  const Vector& v = GetParam();
  bring(can::data_frame(v.can_id, v.bytes));
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].node, v.decoded.at("node"));
  const std::string state = v.decoded.at("state");
  const auto is = [&](std::string_view word) { return state.find(word) != std::string::npos; };
  EXPECT_EQ(notices[0].kind, is("boot-up") ? bus::Notice::Kind::started : bus::Notice::Kind::present);
  EXPECT_EQ(notices[0].state, is("stopped")                 ? bus::NodeState::stopped
                              : is("pre-") || is("boot-up") ? bus::NodeState::pre_operational
                                                            : bus::NodeState::operational);
  if (v.decoded.contains("toggle")) {
    EXPECT_EQ(canopen::decode_error_control(v.bytes)->toggle, v.decoded.at("toggle") == 1);
  }
}

TEST_P(Emergencies, are_told_with_code_register_and_the_makers_bytes) {
  const Vector& v = GetParam();
  bring(can::data_frame(v.can_id, v.bytes));
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].kind, bus::Notice::Kind::emergency);
  EXPECT_EQ(notices[0].code, number(v.decoded.at("error_code")));
  EXPECT_EQ(notices[0].error_register, number(v.decoded.at("error_register")));
  EXPECT_THAT(notices[0].vendor, testing::ElementsAreArray(Bytes(v.bytes).subspan(3)));
}

TEST_P(Misprints, end_no_exchange) {
  const Vector& v = GetParam();
  wire->send(read_of(0x6041));
  bring(can::data_frame(0x581, v.bytes));
  EXPECT_THAT(told, testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(All, SdoRequests,
                         testing::ValuesIn(vectors_that([](const Vector& v) { return good_sdo(v) && v.request; })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(All, SdoReplies,
                         testing::ValuesIn(vectors_that([](const Vector& v) { return good_sdo(v) && !v.request; })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(All, NmtCommands,
                         testing::ValuesIn(vectors_that([](const Vector& v) { return v.protocol == "canopen-nmt"; })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(All, ErrorControls, testing::ValuesIn(vectors_that([](const Vector& v) {
                           return (v.protocol == "canopen-heartbeat" || v.protocol == "canopen-guard") && !v.request;
                         })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(All, Emergencies,
                         testing::ValuesIn(vectors_that([](const Vector& v) { return v.protocol == "canopen-emcy"; })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(All, Misprints, testing::ValuesIn(vectors_that([](const Vector& v) {
                           return v.protocol == "canopen-sdo" && !v.well_formed;
                         })),
                         test_name);

// --- Process data: the maps are the sheets' examples ----------------------------------------------------------------

struct PdoRow {
  const char* id;
  std::uint8_t number;
  bool sent_by_drive;
  std::vector<bus::ReplyField> values;
};

const PdoRow kPdos[] = {
    {"kinco-jd/can-d-tpdo1", 1, true, {{{0x6041, 0}, 2, 0xD437}}},
    {"kinco-jd/can-d-rpdo1", 1, false, {{{0x607A, 0}, 4, 50000}, {{0x6060, 0}, 1, 1}}},
    {"kinco-md/d-can-tpdo1-example", 1, true, {{{0x6063, 0}, 4, 50000}, {{0x6041, 0}, 2, 0xD437}}},
    {"kinco-md/d-can-rpdo1-example",
     1,
     false,
     {{{0x607A, 0}, 4, 50000}, {{0x6060, 0}, 1, 1}, {{0x6040, 0}, 2, 0x003F}}},
    {"kinco-md/d-can-rpdo2-example", 2, false, {{{0x60FF, 0}, 4, 2684355}, {{0x6081, 0}, 4, 3579139}}},
    {"leadshine-ld2-can/pdo-ex-rpdo1", 1, false, {{{0x6040, 0}, 2, 0x2211}}},
    {"leadshine-ld2-can/pdo-ex-tpdo1", 1, true, {{{0x6041, 0}, 2, 0x00F3}}},
    {"leadshine-ld2-can/pdo-ex-cobid", 2, true, {}},
    {"leadshine-ld2-can/drv-rpdo1", 1, false, {{{0x6040, 0}, 2, 0x001F}, {{0x607A, 0}, 4, 20000}}},
    {"leadshine-ld2-can/drv-tpdo1", 1, true, {{{0x6041, 0}, 2, 0x0637}, {{0x6064, 0}, 4, 0xFFFFB1E0}}},
};

TEST(SheetProcessData, every_printed_frame_is_cut_and_built_by_its_map) {
  const auto printed = vectors_that([](const Vector& v) { return v.protocol == "canopen-pdo"; });
  EXPECT_EQ(printed.size(), std::size(kPdos)) << "a sheet has a frame that this test does not know";
  for (const Vector& v : printed) {
    SCOPED_TRACE(v.id);
    const auto* row = std::ranges::find_if(kPdos, [&](const PdoRow& r) { return v.id == r.id; });
    ASSERT_NE(row, std::end(kPdos));
    const auto id = canopen::cob_id(v.can_id);
    ASSERT_TRUE(id);
    EXPECT_EQ(id->service, row->sent_by_drive ? canopen::Service::tpdo : canopen::Service::rpdo);
    EXPECT_EQ(id->number, row->number);
    bus::ProcessMap map;
    bus::ReplyFields values;
    for (const bus::ReplyField& field : row->values) {
      map.push_back({field.object, field.size});
      values.push_back(field);
    }
    EXPECT_EQ(canopen::decode_process_data(map, v.bytes), values);
    EXPECT_EQ(canopen::encode_process_data(v.can_id, values), can::data_frame(v.can_id, v.bytes));
  }
}

TEST(SheetFrames, guarding_and_sync_are_what_the_sheets_print) {
  for (const Vector& v : vectors_that([](const Vector& v) { return v.protocol == "canopen-guard" && v.request; })) {
    EXPECT_EQ(canopen::guard_frame(1).id, v.can_id) << v.id;
    EXPECT_TRUE(v.remote && canopen::guard_frame(1).remote) << v.id;
  }
  for (const Vector& v : vectors_that([](const Vector& v) { return v.protocol == "canopen-sync"; })) {
    EXPECT_EQ(can::data_frame(canopen::kSyncId, {}), can::data_frame(v.can_id, v.bytes)) << v.id;
  }
}

}  // namespace
}  // namespace axisgate::test
