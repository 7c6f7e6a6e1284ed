// A simulated node's CiA 301 side: NMT states and what works in them, heartbeats, guarding, lost masters, EMCY, texts.
#include <gmock/gmock.h>

#include "tests/unit/simulated/can_bench.hpp"

namespace axisgate::simulated {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const std::uint32_t heartbeat_id = cob::error_control + 1;
const BusFrame host_heartbeat = bus_frame(cob::error_control + 127, {5});

TEST(CanopenNode, AStoppedNodeAnswersGuardingAndNoSdo) {
  CanBench bench(a_leadshine());
  bench.nmt(0x02);
  EXPECT_EQ(bench.node().state(), NmtState::stopped);
  EXPECT_FALSE(bench.read(0x6041).has_value());
  EXPECT_THAT(bench.exchange(bus_remote_frame(heartbeat_id)), ElementsAre(Bytes{0x04}));
  bench.nmt(0x80);
  EXPECT_TRUE(bench.read(0x6041).has_value());
}

TEST(CanopenNode, ARestartedNodeIsSilentUntilItsBootUp) {
  CanBench bench(a_leadshine());
  bench.nmt(0x01);
  bench.received.clear();
  bench.nmt(0x81);
  EXPECT_EQ(bench.node().state(), NmtState::initialising);
  bench.pass(milliseconds(990));
  EXPECT_FALSE(bench.read(0x6041).has_value());
  EXPECT_THAT(bench.exchange(bus_remote_frame(heartbeat_id)), IsEmpty());
  bench.pass(milliseconds(20));
  EXPECT_THAT(bench.heard(heartbeat_id), ElementsAre(Bytes{0x00}));
  EXPECT_EQ(bench.node().state(), NmtState::pre_operational);
  EXPECT_EQ(bench.leadshine().restarts(), 1U);
}

TEST(CanopenNode, AnNmtCommandOfEightBytesOrForAnotherNodeHasNoEffect) {
  CanBench bench(a_leadshine());
  bench.send(bus_frame(cob::nmt, {1, 0, 0, 0, 0, 0, 0, 0}));
  bench.nmt(0x01, 2);
  bench.nmt(0x77);
  EXPECT_EQ(bench.node().state(), NmtState::pre_operational);
  bench.nmt(0x01, 0);
  EXPECT_EQ(bench.node().state(), NmtState::operational);
}

TEST(CanopenNode, ResetOfTheCommunicationBringsBackWhatWasSavedAndLeavesTheDrive) {
  CanBench bench(a_leadshine());
  EXPECT_EQ(bench.write(0x1017, 0, 200), 0U);
  EXPECT_EQ(bench.write(0x6083, 0, 77), 0U);
  bench.nmt(0x82);
  EXPECT_EQ(bench.number(0x1017), 0);
  EXPECT_EQ(bench.number(0x6083), 77);
  EXPECT_EQ(bench.write(0x1017, 0, 300), 0U);
  EXPECT_EQ(bench.write(0x3002, 0, 0x5A5A), 0U);
  EXPECT_EQ(bench.number(0x3003), 0);
  bench.pass(milliseconds(60));
  EXPECT_EQ(bench.number(0x3003), 0x5A5A);
  EXPECT_EQ(bench.number(0x3002), 0);
  bench.nmt(0x81);
  bench.pass(milliseconds(1100));
  EXPECT_EQ(bench.number(0x1017), 300);
  EXPECT_EQ(bench.number(0x6083), 77);
}

TEST(CanopenNode, HeartbeatsComeAtTheirPeriodAndTellTheState) {
  CanBench bench(a_can_kinco(KincoType::jd));
  bench.pass(milliseconds(5000));
  EXPECT_THAT(bench.heard(heartbeat_id), IsEmpty());  // off as delivered
  EXPECT_EQ(bench.write(0x1017, 0, 100), 0U);
  bench.nmt(0x01);
  bench.received.clear();
  bench.pass(milliseconds(1000));
  EXPECT_THAT(bench.heard(heartbeat_id), SizeIs(10));
  EXPECT_EQ(bench.heard(heartbeat_id).back(), Bytes{0x05});
}

TEST(CanopenNode, GuardingAnswersToggle) {
  CanBench bench(a_can_kinco(KincoType::md));
  EXPECT_THAT(bench.exchange(bus_remote_frame(heartbeat_id)), ElementsAre(Bytes{0x7F}));
  EXPECT_THAT(bench.exchange(bus_remote_frame(heartbeat_id)), ElementsAre(Bytes{0xFF}));
  EXPECT_THAT(bench.exchange(bus_remote_frame(heartbeat_id)), ElementsAre(Bytes{0x7F}));
  bench.nmt(0x82);
  EXPECT_THAT(bench.exchange(bus_remote_frame(heartbeat_id)), ElementsAre(Bytes{0x7F}));
}

TEST(CanopenNode, ALeadshineWithoutItsMasterRaises8130AndLeavesOperational) {
  CanBench bench(a_leadshine());
  EXPECT_EQ(bench.write(0x1016, 1, 127 << 16 | 300), 0U);
  bench.nmt(0x01);
  bench.enable();
  ASSERT_EQ(bench.leadshine().state(), Cia402State::operation_enabled);
  bench.pass(milliseconds(2000));  // watching begins with the first heartbeat
  EXPECT_EQ(bench.leadshine().state(), Cia402State::operation_enabled);
  for (int i = 0; i < 10; ++i) {
    bench.send(host_heartbeat);
    bench.pass(milliseconds(250));
  }
  EXPECT_EQ(bench.leadshine().state(), Cia402State::operation_enabled);
  bench.received.clear();
  bench.pass(milliseconds(60));
  EXPECT_EQ(bench.leadshine().state(), Cia402State::fault);
  EXPECT_EQ(bench.node().state(), NmtState::pre_operational);
  EXPECT_THAT(bench.heard(0x081), ElementsAre(from_hex("30 81 10 00 00 00 00 00")));
  EXPECT_EQ(bench.number(0x603F), 0x8130);
  EXPECT_EQ(bench.number(0x1001), 0x10);
  EXPECT_EQ(bench.number(0x3010), 0x903);
  EXPECT_EQ(bench.number(0x1003, 1), 0x8130);
  bench.control(0x80);
  EXPECT_THAT(bench.heard(0x081), ElementsAre(from_hex("00 00 00 00 00 00 00 00")));
  EXPECT_EQ(bench.number(0x603F), 0);
}

TEST(CanopenNode, AnMdStopsWithoutGuardingOnlyWhere6007IsSet) {
  for (const int reaction : {0, 1}) {
    CanBench bench(a_can_kinco(KincoType::md));
    EXPECT_EQ(bench.number(0x100C), 1000);
    EXPECT_EQ(bench.number(0x100D), 3);
    EXPECT_EQ(bench.write(0x100C, 0, 100), 0U);
    EXPECT_EQ(bench.write(0x6007, 0, reaction), 0U);
    bench.nmt(0x01);
    bench.control(0x0F);
    bench.pass(milliseconds(1000));  // the life time begins with the first request
    (void)bench.exchange(bus_remote_frame(heartbeat_id));
    bench.pass(milliseconds(290));
    EXPECT_EQ(bench.kinco().state(), Cia402State::operation_enabled);
    bench.pass(milliseconds(20));
    const auto expected = reaction == 1 ? Cia402State::fault : Cia402State::operation_enabled;
    EXPECT_EQ(bench.kinco().state(), expected);
  }
}

TEST(CanopenNode, AJdObeysNoControlwordBeforeASix) {
  CanBench bench(a_can_kinco(KincoType::jd));
  const auto enable = [&bench] { return bench.write(0x6040, 0, 0x0F); };
  EXPECT_EQ(enable(), 0U);
  EXPECT_EQ(bench.kinco().state(), Cia402State::switch_on_disabled);
  bench.control(0x06);
  EXPECT_EQ(enable(), 0U);
  EXPECT_EQ(bench.kinco().state(), Cia402State::operation_enabled);
  bench.control(0x06);
  bench.nmt(0x82);
  EXPECT_EQ(enable(), 0U);
  EXPECT_NE(bench.kinco().state(), Cia402State::operation_enabled);
  CanBench md(a_can_kinco(KincoType::md));
  md.control(0x0F);
  EXPECT_EQ(md.kinco().state(), Cia402State::operation_enabled);
}

TEST(CanopenNode, RefusalsCarryTheAbortCodesOfTheSheets) {
  CanBench bench(a_leadshine());
  EXPECT_EQ(bench.write_wide(0x9999, 0, 1, 2), 0x06020000U);
  EXPECT_EQ(bench.write_wide(0x6083, 7, 1, 4), 0x06090011U);
  EXPECT_EQ(bench.write_wide(0x1018, 9, 1, 4), 0x06090011U);
  EXPECT_EQ(bench.write_wide(0x1018, 1, 1, 4), 0x06010002U);
  EXPECT_EQ(bench.write_wide(0x6041, 0, 1, 2), 0x06010002U);
  EXPECT_EQ(bench.write_wide(0x6083, 0, 1, 2), 0x06070010U);
  EXPECT_EQ(bench.write(0x6083, 0, 0), 0x06090030U);
  EXPECT_EQ(bench.write(0x6060, 0, 12), 0x06090030U);
  EXPECT_EQ(bench.write_wide(0x100C, 0, 1, 2), 0x06020000U);  // not mentioned for this drive
  LeadshineOptions as_printed = a_leadshine();
  as_printed.mismatch_abort = 0x06060010;
  EXPECT_EQ(CanBench(as_printed).write_wide(0x6083, 0, 1, 2), 0x06060010U);
}

TEST(CanopenNode, IdentityAndTextsAreThoseOfTheOptions) {
  LeadshineOptions options = a_leadshine();
  options.identity = {1, 2, 3, 4};
  CanBench bench(options);
  EXPECT_EQ(bench.number(0x1018), 4);
  EXPECT_EQ(bench.number(0x1018, 2), 2);
  EXPECT_EQ(bench.number(0x1018, 4), 4);
  EXPECT_EQ(bench.number(0x1000), 0x00020192);
  EXPECT_EQ(bench.number(0x1014), 0x81);
  EXPECT_EQ(bench.sdo(from_hex("40 08 10 00 00 00 00 00")), from_hex("41 08 10 00 0B 00 00 00"));
}

}  // namespace
}  // namespace axisgate::simulated
