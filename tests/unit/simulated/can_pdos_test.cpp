// PDOs of the simulated nodes: the rules of mapping them, and when they are sent and obeyed.
#include <gmock/gmock.h>

#include "tests/unit/simulated/can_bench.hpp"

namespace axisgate::simulated {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const std::uint32_t tpdo1 = 0x181;
const BusFrame sync = bus_frame(cob::sync, {});

// Statusword and position in TPDO1.
void map_status(CanBench& bench, std::uint8_t type, std::uint16_t inhibit = 0, std::uint32_t position = 0x60640020) {
  ASSERT_EQ(bench.write(0x1800, 1, 0x80000181), 0U);
  ASSERT_EQ(bench.write(0x1A00, 0, 0), 0U);
  ASSERT_EQ(bench.write(0x1A00, 1, 0x60410010), 0U);
  ASSERT_EQ(bench.write(0x1A00, 2, position), 0U);
  ASSERT_EQ(bench.write(0x1A00, 0, 2), 0U);
  ASSERT_EQ(bench.write(0x1800, 2, type), 0U);
  ASSERT_EQ(bench.write(0x1800, 3, inhibit), 0U);
  ASSERT_EQ(bench.write(0x1800, 1, 0x181), 0U);
}

TEST(CanPdos, AMappingChangesOnlyWhileItsPdoIsOffAndEmptyAndTheNodePreOperational) {
  CanBench bench(a_leadshine());
  EXPECT_EQ(bench.write(0x1A00, 1, 0x60410010), 0x08000022U);  // on
  EXPECT_EQ(bench.write(0x1800, 1, 0x80000181), 0U);
  EXPECT_EQ(bench.write(0x1A00, 1, 0x60410010), 0U);
  EXPECT_EQ(bench.write(0x1A00, 0, 2), 0x06020000U);  // the second is empty
  EXPECT_EQ(bench.write(0x1A00, 0, 1), 0U);
  EXPECT_EQ(bench.write(0x1A00, 1, 0x60640020), 0x08000022U);  // has an entry
  EXPECT_EQ(bench.write(0x1A00, 0, 0), 0U);
  bench.nmt(0x01);
  EXPECT_EQ(bench.write(0x1A00, 1, 0x60640020), 0x08000022U);  // operational
}

TEST(CanPdos, WhatCannotBeMappedIsRefused) {
  LeadshineOptions options = a_leadshine();
  options.unmappable = {{0x606C, 0}};
  CanBench bench(options);
  EXPECT_EQ(bench.write(0x1800, 1, 0x80000181), 0U);
  EXPECT_EQ(bench.write(0x1A00, 1, 0x605A0010), 0x06040041U);  // printed so
  EXPECT_EQ(bench.write(0x1A00, 1, 0x606C0020), 0x06040041U);
  EXPECT_EQ(bench.write(0x1A00, 1, 0x60640010), 0x06040041U);  // not its width
  EXPECT_EQ(bench.write(0x1A00, 1, 0x99990010), 0x06020000U);
  EXPECT_EQ(bench.write(0x1400, 1, 0x80000201), 0U);
  EXPECT_EQ(bench.write(0x1600, 1, 0x60410010), 0x06040041U);  // read-only in an RPDO
  for (const std::uint8_t sub : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) {
    EXPECT_EQ(bench.write(0x1A00, sub, 0x60640020), 0U);
  }
  EXPECT_EQ(bench.write(0x1A00, 0, 3), 0x06040042U);
  EXPECT_EQ(bench.write(0x1A00, 9, 0), 0x06090011U);
}

TEST(CanPdos, TypesTimersAndIdentifiersAreThoseOfTheDrive) {
  CanBench leadshine(a_leadshine());
  EXPECT_EQ(leadshine.write(0x1800, 2, 254), 0x06090030U);
  EXPECT_EQ(leadshine.write(0x1800, 2, 241), 0x06090030U);
  EXPECT_EQ(leadshine.write(0x1800, 2, 255), 0U);
  EXPECT_EQ(leadshine.write_wide(0x1800, 5, 100, 2), 0x06090011U);
  EXPECT_EQ(leadshine.write(0x1800, 1, 0x43F), 0x08000022U);  // only while off
  EXPECT_EQ(leadshine.write(0x1800, 1, 0x80000181), 0U);
  EXPECT_EQ(leadshine.write(0x1800, 1, 0x701), 0x06090030U);  // reserved
  EXPECT_EQ(leadshine.write(0x1800, 1, 0x43F), 0U);
  EXPECT_EQ(leadshine.write_wide(0x1804, 1, 0, 4), 0x06020000U);  // four
  CanBench jd(a_can_kinco(KincoType::jd));
  EXPECT_EQ(jd.write(0x1800, 2, 254), 0U);
  EXPECT_EQ(jd.write_wide(0x1800, 5, 100, 2), 0x06090011U);
  EXPECT_TRUE(jd.read(0x1807, 1).has_value());  // eight
  CanBench md(a_can_kinco(KincoType::md));
  EXPECT_EQ(md.write(0x1800, 5, 100), 0U);
}

TEST(CanPdos, AnEventDrivenPdoIsSentAtTheStartAndOnEachChangeButNotWithinItsInhibitTime) {
  CanBench bench(a_leadshine());
  map_status(bench, 255, 50);  // 5 ms
  bench.received.clear();
  bench.pass(milliseconds(50));
  EXPECT_THAT(bench.heard(tpdo1), IsEmpty());  // not operational
  bench.nmt(0x01);
  EXPECT_THAT(bench.heard(tpdo1), ElementsAre(from_hex("50 02 00 00 00 00")));
  bench.received.clear();
  bench.pass(milliseconds(50));
  EXPECT_THAT(bench.heard(tpdo1), IsEmpty());
  bench.enable();  // three changes in no time: the first at once, the last when the inhibit time is over
  bench.received.clear();
  bench.pass(milliseconds(4));
  EXPECT_THAT(bench.heard(tpdo1), IsEmpty());
  bench.pass(milliseconds(2));
  ASSERT_THAT(bench.heard(tpdo1), SizeIs(1));
  EXPECT_EQ(bench.heard(tpdo1)[0][0] & 0x6F, 0x27);
  bench.nmt(0x80);
  bench.received.clear();
  bench.control(0x06);
  bench.pass(milliseconds(50));
  EXPECT_THAT(bench.heard(tpdo1), IsEmpty());
}

TEST(CanPdos, AnMdSendsByItsEventTimerAndCountsInhibitTimeInMilliseconds) {
  CanBench bench(a_can_kinco(KincoType::md));
  map_status(bench, 255, 20, 0x60630020);
  ASSERT_EQ(bench.write(0x1800, 5, 100), 0U);
  bench.nmt(0x01);
  bench.received.clear();
  bench.pass(milliseconds(1000));
  EXPECT_THAT(bench.heard(tpdo1), SizeIs(10));
  bench.received.clear();
  bench.control(0x0F);
  bench.received.clear();
  bench.control(0x06);
  bench.pass(milliseconds(18));
  EXPECT_THAT(bench.heard(tpdo1), IsEmpty());
  bench.pass(milliseconds(3));
  EXPECT_THAT(bench.heard(tpdo1), SizeIs(1));
}

TEST(CanPdos, SynchronousPdosFollowSync) {
  CanBench bench(a_leadshine());
  map_status(bench, 3);
  bench.nmt(0x01);
  bench.received.clear();
  for (int i = 0; i < 9; ++i) bench.send(sync);
  EXPECT_THAT(bench.heard(tpdo1), SizeIs(3));
  bench.nmt(0x80);
  ASSERT_EQ(bench.write(0x1800, 2, 0), 0U);
  bench.nmt(0x01);
  bench.received.clear();
  for (int i = 0; i < 3; ++i) bench.send(sync);
  EXPECT_THAT(bench.heard(tpdo1), SizeIs(1));  // changed once: since the start
  bench.control(0x06);
  bench.received.clear();
  for (int i = 0; i < 3; ++i) bench.send(sync);
  EXPECT_THAT(bench.heard(tpdo1), SizeIs(1));
}

TEST(CanPdos, ARemoteFrameAsksForAPdo) {
  CanBench bench(a_leadshine());
  map_status(bench, 3);
  bench.nmt(0x01);
  bench.received.clear();
  bench.send(bus_remote_frame(tpdo1, 6));
  EXPECT_THAT(bench.heard(tpdo1), SizeIs(1));
}

TEST(CanPdos, AReceivedPdoWritesItsObjectsAtOnceOrWithTheNextSync) {
  CanBench bench(a_leadshine());
  const auto map = [&bench](std::uint8_t type) {
    bench.nmt(0x80);
    ASSERT_EQ(bench.write(0x1400, 1, 0x80000201), 0U);
    ASSERT_EQ(bench.write(0x1400, 2, type), 0U);
    ASSERT_EQ(bench.write(0x1600, 0, 0), 0U);
    ASSERT_EQ(bench.write(0x1600, 1, 0x60400010), 0U);
    ASSERT_EQ(bench.write(0x1600, 2, 0x607A0020), 0U);
    ASSERT_EQ(bench.write(0x1600, 0, 2), 0U);
    ASSERT_EQ(bench.write(0x1400, 1, 0x201), 0U);
    bench.nmt(0x01);
  };
  map(255);
  bench.send(bus_frame(0x201, from_hex("06 00 20 4E 00 00")));
  EXPECT_EQ(bench.number(0x607A), 20000);
  EXPECT_EQ(bench.leadshine().state(), Cia402State::ready_to_switch_on);
  bench.send(bus_frame(0x201, from_hex("07 00 21 4E 00")));  // too short
  EXPECT_EQ(bench.number(0x607A), 20000);
  map(1);
  bench.send(bus_frame(0x201, from_hex("07 00 22 4E 00 00")));
  EXPECT_EQ(bench.number(0x607A), 20000);
  bench.send(sync);
  EXPECT_EQ(bench.number(0x607A), 20002);
}

}  // namespace
}  // namespace axisgate::simulated
