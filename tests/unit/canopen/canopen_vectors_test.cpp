// SPDX-License-Identifier: Apache-2.0
// Every CANopen frame of the three drive sheets (tests/vectors), through codec and wire.
#include "adapters/canopen/cob_id.hpp"
#include "adapters/canopen/emergency.hpp"
#include "adapters/canopen/nmt.hpp"
#include "adapters/canopen/process_data.hpp"
#include "tests/unit/bus/sheet_vectors.hpp"
#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;

template <typename Which>
std::vector<SheetVector> vectors_that(Which which) {
  return sheet_vectors({"kinco-jd", "kinco-md", "leadshine-ld2-can"},
                       [&](const SheetVector& v) { return v.protocol().starts_with("canopen") && which(v); });
}
std::vector<SheetVector> vectors_of(std::string_view protocol) {
  return vectors_that([&](const SheetVector& v) { return v.protocol() == protocol; });
}
std::uint32_t can_id(const SheetVector& v) { return number(v.row.at("can_id")); }
CanFrame printed(const SheetVector& v) { return can::data_frame(can_id(v), v.printed); }
CanFrame meant(const SheetVector& v) { return can::data_frame(can_id(v), v.bytes); }
bool well_formed(const SheetVector& v) { return v.row.value("well_formed", true); }
bool is_sdo(const SheetVector& v) { return v.protocol() == "canopen-sdo"; }
bool is_sdo_request(const SheetVector& v) { return is_sdo(v) && well_formed(v) && v.request(); }
bool is_sdo_reply(const SheetVector& v) { return is_sdo(v) && well_formed(v) && !v.request(); }
bool is_misprint(const SheetVector& v) { return is_sdo(v) && !well_formed(v); }
bool is_error_control(const SheetVector& v) {
  return (v.protocol() == "canopen-heartbeat" || v.protocol() == "canopen-guard") && !v.request();
}

bus::Exchange exchange_of(const SheetVector& v) {
  bus::Exchange exchange = read_of(static_cast<std::uint16_t>(v.value("index")),
                                   static_cast<std::uint8_t>(v.value("sub")), 0, v.says("node"));
  if (v.says("op") == "write" || v.says("op") == "write-ok") {
    exchange.access = bus::Access::write;
    exchange.size = static_cast<std::uint8_t>(v.decoded().value("size", 2));
    exchange.raw = v.decoded().contains("value") ? v.value("value") : 0;
  }
  return exchange;
}

class Sheets : public CanopenWireStage, public testing::WithParamInterface<SheetVector> {
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
  wire->send(exchange_of(GetParam()));
  EXPECT_THAT(link->sent, ElementsAre(meant(GetParam())));
}

TEST_P(SdoReplies, answer_the_request_they_belong_to_as_printed_and_padded) {
  const SheetVector& v = GetParam();
  for (const CanFrame& frame : {printed(v), meant(v)}) {
    replies.clear();
    wire->send(exchange_of(v));
    bring(frame);
    ASSERT_EQ(replies.size(), 1u);
    const bus::ExchangeResult& result = replies[0];
    if (v.decoded().contains("error_code")) {
      EXPECT_EQ(result, refusal_of(v.value("error_code"), bus::abort_may_pass(v.value("error_code"))));
    } else if (v.says("op") == "read-ok") {
      ASSERT_EQ(result.fields.size(), 1u);
      EXPECT_EQ(result.fields[0].size, v.value("size"));
      const std::uint32_t mask = result.fields[0].size == 4 ? ~0U : (1U << (8 * result.fields[0].size)) - 1;
      EXPECT_EQ(result.fields[0].raw, v.value("value") & mask);
    } else {
      EXPECT_EQ(result, bus::ExchangeResult{});
    }
  }
}

/// The examples of one manual print them with seven or eight bytes.
TEST_P(NmtCommands, are_sent_with_exactly_two_bytes) {
  wire->send(nmt_of(GetParam().value("command"), GetParam().bytes.at(1)));
  EXPECT_THAT(link->sent, ElementsAre(meant(GetParam())));
  runtime.run_due();
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_P(ErrorControls, tell_the_nodes_state) {
  const SheetVector& v = GetParam();
  bring(printed(v));
  ASSERT_EQ(unsolicited_events.size(), 1u);
  EXPECT_EQ(unsolicited_events[0].node, v.value("node"));
  const std::string state = v.says("state");
  const auto is = [&](std::string_view word) { return state.find(word) != std::string::npos; };
  EXPECT_EQ(unsolicited_events[0].kind,
            is("boot-up") ? bus::UnsolicitedEvent::Kind::started : bus::UnsolicitedEvent::Kind::present);
  EXPECT_EQ(unsolicited_events[0].state, is("stopped")                 ? bus::NodeState::stopped
                                         : is("pre-") || is("boot-up") ? bus::NodeState::pre_operational
                                                                       : bus::NodeState::operational);
  if (v.decoded().contains("toggle")) {
    EXPECT_EQ(canopen::decode_error_control(v.printed)->toggle, v.says("toggle") == 1);
  }
}

TEST_P(Emergencies, are_told_with_code_register_and_the_makers_bytes) {
  const SheetVector& v = GetParam();
  bring(printed(v));
  ASSERT_EQ(unsolicited_events.size(), 1u);
  EXPECT_EQ(unsolicited_events[0].kind, bus::UnsolicitedEvent::Kind::emergency);
  EXPECT_EQ(unsolicited_events[0].code, v.value("error_code"));
  EXPECT_EQ(unsolicited_events[0].error_register, v.value("error_register"));
  EXPECT_THAT(unsolicited_events[0].vendor, testing::ElementsAreArray(Bytes(v.printed).subspan(3)));
}

TEST_P(Misprints, end_no_exchange) {
  wire->send(read_of(0x6041));
  bring(can::data_frame(0x581, GetParam().printed));
  EXPECT_THAT(replies, testing::IsEmpty());
  // One that acknowledges a write is not ours, but some write it may be.
  for (const bus::UnsolicitedEvent& event : unsolicited_events)
    EXPECT_EQ(event.kind, bus::UnsolicitedEvent::Kind::foreign_write);
}

INSTANTIATE_TEST_SUITE_P(All, SdoRequests, testing::ValuesIn(vectors_that(is_sdo_request)), vector_name);
INSTANTIATE_TEST_SUITE_P(All, SdoReplies, testing::ValuesIn(vectors_that(is_sdo_reply)), vector_name);
INSTANTIATE_TEST_SUITE_P(All, NmtCommands, testing::ValuesIn(vectors_of("canopen-nmt")), vector_name);
INSTANTIATE_TEST_SUITE_P(All, ErrorControls, testing::ValuesIn(vectors_that(is_error_control)), vector_name);
INSTANTIATE_TEST_SUITE_P(All, Emergencies, testing::ValuesIn(vectors_of("canopen-emcy")), vector_name);
INSTANTIATE_TEST_SUITE_P(All, Misprints, testing::ValuesIn(vectors_that(is_misprint)), vector_name);

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
    {"kinco-md/d-can-rpdo1-example", 1, false, {{{0x607A, 0}, 4, 50000}, {{0x6060, 0}, 1, 1}, {{0x6040, 0}, 2, 0x3F}}},
    {"kinco-md/d-can-rpdo2-example", 2, false, {{{0x60FF, 0}, 4, 2684355}, {{0x6081, 0}, 4, 3579139}}},
    {"leadshine-ld2-can/pdo-ex-rpdo1", 1, false, {{{0x6040, 0}, 2, 0x2211}}},
    {"leadshine-ld2-can/pdo-ex-tpdo1", 1, true, {{{0x6041, 0}, 2, 0x00F3}}},
    {"leadshine-ld2-can/pdo-ex-cobid", 2, true, {}},
    {"leadshine-ld2-can/drv-rpdo1", 1, false, {{{0x6040, 0}, 2, 0x001F}, {{0x607A, 0}, 4, 20000}}},
    {"leadshine-ld2-can/drv-tpdo1", 1, true, {{{0x6041, 0}, 2, 0x0637}, {{0x6064, 0}, 4, 0xFFFFB1E0}}},
};

TEST(SheetProcessData, every_printed_frame_is_cut_and_built_by_its_map) {
  const auto frames = vectors_of("canopen-pdo");
  EXPECT_EQ(frames.size(), std::size(kPdos)) << "a sheet has a frame that this test does not know";
  for (const SheetVector& v : frames) {
    SCOPED_TRACE(v.name);
    const auto* known = std::ranges::find_if(kPdos, [&](const PdoRow& r) { return v.name == r.id; });
    ASSERT_NE(known, std::end(kPdos));
    const auto id = canopen::cob_id(can_id(v));
    ASSERT_TRUE(id);
    EXPECT_EQ(id->service, known->sent_by_drive ? canopen::Service::tpdo : canopen::Service::rpdo);
    EXPECT_EQ(id->number, known->number);
    bus::ProcessMap map;
    for (const bus::ReplyField& field : known->values) map.push_back({field.object, field.size});
    const bus::ReplyFields values(known->values.begin(), known->values.end());
    EXPECT_EQ(canopen::decode_process_data(map, v.printed), values);
    EXPECT_EQ(canopen::encode_process_data(can_id(v), values), printed(v));
  }
}

TEST(SheetFrames, guarding_and_sync_are_what_the_sheets_print) {
  for (const SheetVector& v : vectors_of("canopen-guard")) {
    if (!v.request()) continue;
    EXPECT_EQ(canopen::guard_frame(1).id, can_id(v)) << v.name;
    EXPECT_TRUE(v.row.value("rtr", false) && canopen::guard_frame(1).remote) << v.name;
  }
  for (const SheetVector& v : vectors_of("canopen-sync")) {
    EXPECT_EQ(can::data_frame(canopen::kSyncId, {}), printed(v)) << v.name;
  }
}

}  // namespace
}  // namespace axisgate::test
