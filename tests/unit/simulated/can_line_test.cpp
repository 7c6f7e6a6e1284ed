// The simulated CAN bus: arbitration and time, the faults of its drives, what the journal ties together.
#include "tests/simulated/can_line.hpp"

#include <gmock/gmock.h>

#include "tests/unit/simulated/can_bench.hpp"

namespace axisgate::simulated {
namespace {

using std::chrono::microseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const BusFrame read_status = bus_frame(cob::sdo_request + 1, from_hex("40 41 60 00 00 00 00 00"));

CanLineOptions one_megabit() {
  CanLineOptions options;
  options.bit_rate = 1000000;
  return options;
}

std::vector<std::uint32_t> ids(const CanBench& bench) {
  std::vector<std::uint32_t> found;
  for (const CanToHost& frame : bench.received) found.push_back(frame.frame.id);
  return found;
}

TEST(CanLine, AFrameTakesItsBitsAndADriveItsTime) {
  CanBench bench(a_leadshine(), one_megabit());
  bench.send(read_status);
  bench.pass(milliseconds(10));
  ASSERT_THAT(bench.received, SizeIs(1));
  EXPECT_EQ(frame_time(read_status, 1000000), microseconds(135));  // 111 bits and 24 of stuffing at most
  EXPECT_EQ(bench.received[0].at, microseconds(135) + milliseconds(1) + microseconds(135));
  EXPECT_EQ(bench.received[0].tag, 1U);
}

TEST(CanLine, TheLowestIdentifierOfThoseThatWaitGoesFirst) {
  CanLineOptions options = one_megabit();
  options.reply_delay = Time{};
  CanBench bench(std::vector<CanDriveOptions>{a_leadshine(3), a_leadshine(2)}, options);
  // Both nodes answer the same broadcast at the same instant; the host's own frames stay in order.
  bench.send(bus_frame(cob::nmt, {0x82, 0}));
  bench.pass(milliseconds(5));
  EXPECT_THAT(ids(bench), ElementsAre(0x702, 0x703));
  EXPECT_EQ(bench.received[0].tag, 0U);
}

TEST(CanLine, TheJournalTiesEachReplyToItsRequest) {
  CanBench bench(a_leadshine());
  (void)bench.read(0x6041);
  (void)bench.read(0x6064);
  bench.nmt(0x01);
  ASSERT_THAT(bench.line().journal().entries(), SizeIs(2));  // NMT is no request
  const CanExchange& second = bench.line().journal().entries().back();
  EXPECT_EQ(second.station, 1);
  EXPECT_EQ(second.request, from_hex("01 06 40 64 60 00 00 00 00 00"));
  EXPECT_EQ(second.sent, from_hex("81 05 43 64 60 00 00 00 00 00"));
  EXPECT_EQ(bench.line().requests_heard(), 2U);
}

TEST(CanLine, ARequestWhileAReplyIsOwedIsCounted) {
  CanBench bench(std::vector<CanDriveOptions>{a_leadshine(1), a_leadshine(2)}, one_megabit());
  bench.send(read_status);
  bench.pass(milliseconds(5));
  bench.send(read_status);
  EXPECT_EQ(bench.line().overlapping_requests(), 0U);
  bench.pass(microseconds(500));
  bench.send(bus_frame(cob::sdo_request + 2, from_hex("40 41 60 00 00 00 00 00")));
  bench.pass(milliseconds(5));
  EXPECT_EQ(bench.line().overlapping_requests(), 1U);
  bench.send(bus_remote_frame(cob::error_control + 2));  // guarding is no SDO
  bench.pass(microseconds(200));
  bench.send(read_status);
  bench.pass(milliseconds(5));
  EXPECT_EQ(bench.line().overlapping_requests(), 1U);
}

class CanFaults : public testing::Test {
 protected:
  CanBench bench{a_leadshine()};
  std::vector<Bytes> ask() { return bench.exchange(read_status); }
};

TEST_F(CanFaults, MuteAndLoseAndRestartGiveNoAnswer) {
  bench.faults().next(DriveFault::mute);
  EXPECT_THAT(ask(), IsEmpty());
  bench.faults().next(DriveFault::lose);
  EXPECT_EQ(bench.write(0x607A, 0, 5), std::nullopt);
  EXPECT_EQ(bench.number(0x607A), 5);  // it has acted
  for (const bool acts : {false, true}) {
    bench.faults().restart_acts = acts;
    bench.faults().next(DriveFault::restart);
    EXPECT_EQ(bench.write(0x6083, 0, 123), std::nullopt);
    EXPECT_EQ(bench.leadshine().writes({0x6083, 0}), acts ? 1U : 0U);
    EXPECT_EQ(bench.node().state(), NmtState::initialising);
    bench.pass(milliseconds(1100));
    EXPECT_EQ(bench.heard(cob::error_control + 1), std::vector<Bytes>{Bytes{0x00}});
    EXPECT_EQ(bench.number(0x6083), 10000);
  }
}

TEST_F(CanFaults, ALateReplyComesLaterAndADuplicateTwice) {
  bench.faults().late_by = milliseconds(70);
  bench.faults().next(DriveFault::late);
  EXPECT_THAT(ask(), IsEmpty());
  bench.pass(milliseconds(69));
  EXPECT_THAT(bench.received, IsEmpty());
  bench.pass(milliseconds(2));
  EXPECT_THAT(bench.received, SizeIs(1));
  bench.faults().next(DriveFault::duplicate);
  EXPECT_THAT(ask(), SizeIs(2));
}

TEST_F(CanFaults, AnAbortIsNotActedOn) {
  bench.faults().abort_code = 0x08000021;
  bench.faults().next(DriveFault::exception);
  EXPECT_EQ(bench.write(0x607A, 0, 5), 0x08000021U);
  EXPECT_EQ(bench.number(0x607A), 0);
}

TEST_F(CanFaults, AReplyMayNameAnotherNodeOrBreakOff) {
  bench.faults().next(DriveFault::wrong_station);
  (void)ask();
  EXPECT_THAT(ids(bench), ElementsAre(cob::sdo_reply + 2));
  bench.faults().next(DriveFault::wrong_length);
  const auto cut = ask();
  ASSERT_THAT(cut, SizeIs(1));
  EXPECT_LT(cut[0].size(), 8U);
}

TEST_F(CanFaults, ATwinAnswersEverythingOnceMore) {
  const std::size_t twin = bench.line().add_twin(0);
  EXPECT_THAT(ask(), SizeIs(2));
  EXPECT_THAT(bench.exchange(bus_remote_frame(cob::error_control + 1)), SizeIs(2));
  bench.line().connect(twin, false);
  EXPECT_THAT(ask(), SizeIs(1));
}

TEST_F(CanFaults, ADisconnectedDriveIsNeitherHeardNorHears) {
  bench.line().connect(0, false);
  EXPECT_THAT(ask(), IsEmpty());
  EXPECT_EQ(bench.line().requests_heard(), 0U);
  bench.line().connect(0, true);
  EXPECT_THAT(ask(), SizeIs(1));
}

TEST_F(CanFaults, StormsAndBabbleComeAtTheirPeriod) {
  bench.faults().babble_period = milliseconds(2);
  bench.faults().set_rate(DriveFault::emergencies, 1);
  bench.pass(milliseconds(100));
  EXPECT_THAT(bench.heard(0x081), SizeIs(testing::AllOf(testing::Ge(49U), testing::Le(51U))));
  EXPECT_EQ(bench.heard(0x081)[0], from_hex("10 81 00 00 00 00 00 00"));
  bench.faults().clear();
  bench.received.clear();
  bench.faults().babble_id = 0x1F0;
  bench.faults().set_rate(DriveFault::babble, 1);
  bench.pass(milliseconds(100));
  EXPECT_THAT(bench.heard(0x1F0), SizeIs(testing::AllOf(testing::Ge(49U), testing::Le(51U))));
}

TEST_F(CanFaults, BusOffAndACutCableLoseWhatIsUnderWayAndTheDrivesLiveOn) {
  CanBench slow(a_leadshine(), one_megabit());
  slow.send(read_status);
  slow.pass(microseconds(500));
  slow.line().cut();
  slow.pass(milliseconds(5));
  EXPECT_THAT(slow.received, IsEmpty());
  ASSERT_EQ(bench.write(0x1017, 0, 100), 0U);
  bench.line().set_bus_off(true);
  EXPECT_THAT(ask(), IsEmpty());
  bench.pass(milliseconds(1000));
  EXPECT_THAT(bench.received, IsEmpty());
  bench.line().set_bus_off(false);
  bench.pass(milliseconds(100));
  EXPECT_THAT(bench.received, SizeIs(1));
}

TEST(CanLine, TheSameSeedGivesTheSameRun) {
  const auto run = [](std::uint64_t seed) {
    CanBench bench(std::vector<CanDriveOptions>{a_leadshine(1), a_can_kinco(KincoType::jd, 2)}, one_megabit(), seed);
    for (const DriveFault fault : {DriveFault::mute, DriveFault::late, DriveFault::lose, DriveFault::duplicate,
                                   DriveFault::wrong_station, DriveFault::restart, DriveFault::exception}) {
      bench.faults(0).set_rate(fault, 0.1);
      bench.faults(1).set_rate(fault, 0.1);
    }
    for (int i = 0; i < 300; ++i) {
      bench.send(bus_frame(cob::sdo_request + 1 + static_cast<std::uint32_t>(i % 2), bytes_of(read_status)));
      bench.pass(milliseconds(7));
    }
    return bench.line().journal().hash();
  };
  EXPECT_EQ(run(5), run(5));
  EXPECT_NE(run(5), run(6));
}

TEST(CanLine, RefusesANodeThatCannotBe) {
  EXPECT_THROW(CanBench{a_leadshine(0)}, std::invalid_argument);
  EXPECT_THROW(CanBench{a_leadshine(128)}, std::invalid_argument);
  EXPECT_EQ(describe(CanDriveOptions(a_leadshine(9))), "ld2@9");
  EXPECT_EQ(describe(CanDriveOptions(a_can_kinco(KincoType::md, 2))), "md@2");
}

}  // namespace
}  // namespace axisgate::simulated
