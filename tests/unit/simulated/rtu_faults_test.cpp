// Every fault switch on an RTU line does what its name says, and a late reply tells what was true when it was asked.
#include <gmock/gmock.h>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

const Bytes read_status = seal_rtu(1, read_pdu(0x3200, 1));
const Bytes read_position = seal_rtu(1, read_pdu(0x3700, 2));
const Bytes enable = seal_rtu(1, write_pdu(0x3100, 0x0F));

RtuBench a_jd() { return RtuBench(an_rtu_kinco(KincoType::jd)); }

TEST(RtuFaultSwitch, MuteNeitherActsNorAnswers) {
  RtuBench bench = a_jd();
  bench.faults().next(DriveFault::mute);
  EXPECT_TRUE(bench.exchange(enable).empty());
  EXPECT_EQ(bench.kinco().state(), Cia402State::switch_on_disabled);
  EXPECT_EQ(bench.exchange(enable), enable);
}

TEST(RtuFaultSwitch, ALostReplyComesFromADriveThatActed) {
  RtuBench bench = a_jd();
  bench.faults().next(DriveFault::lose);
  EXPECT_TRUE(bench.exchange(enable).empty());
  EXPECT_EQ(bench.kinco().state(), Cia402State::operation_enabled);
}

TEST(RtuFaultSwitch, ALateReplyTellsWhatWasTrueWhenItWasAskedAndDelaysThoseBehindIt) {
  RtuBench bench = a_jd();
  bench.faults().late_by = milliseconds(260);
  bench.faults().next(DriveFault::late);
  const Bytes before = seal_rtu(1, read_reply(std::vector<std::uint16_t>{0x4050}));
  EXPECT_TRUE(bench.exchange(read_status).empty());
  bench.pass(milliseconds(100));
  bench.exchange(enable);
  bench.exchange(read_position);
  EXPECT_TRUE(bench.received.empty());
  bench.pass(milliseconds(159));
  EXPECT_TRUE(bench.arrivals.empty());
  bench.pass(milliseconds(1));
  ASSERT_EQ(bench.arrivals.size(), 3U);
  EXPECT_EQ(bench.arrivals[0].bytes, before);  // not yet enabled
  EXPECT_EQ(bench.arrivals[1].bytes, enable);
  EXPECT_EQ(bench.arrivals[2].bytes.size(), 9U);
  EXPECT_EQ(bench.line().journal().entries()[0].sent, before);
  EXPECT_EQ(bench.line().journal().entries()[0].reply_ready, milliseconds(260));
}

TEST(RtuFaultSwitch, ADriveLeavesAGapBetweenItsAnswers) {
  RtuBench bench(an_rtu_kinco(KincoType::jd), RtuLineOptions{});
  bench.faults().late_by = milliseconds(100);
  bench.faults().next(DriveFault::late);
  bench.exchange(read_status);
  bench.pass(milliseconds(30));
  bench.exchange(read_position);
  bench.pass(milliseconds(200));
  ASSERT_EQ(bench.arrivals.size(), 2U);
  const Time begun = bench.arrivals[1].at - bench.line().on_wire(9);
  EXPECT_GE(begun - bench.arrivals[0].at, bench.line().frame_gap());
}

TEST(RtuFaultSwitch, NoiseStandsBeforeOrAfterTheReply) {
  RtuBench clean = a_jd();
  const Bytes reply = clean.exchange(read_status);
  RtuBench before = a_jd();
  before.faults().next(DriveFault::noise_before);
  const Bytes late_start = before.exchange(read_status);
  ASSERT_GT(late_start.size(), reply.size());
  EXPECT_TRUE(std::equal(reply.rbegin(), reply.rend(), late_start.rbegin()));
  RtuBench after = a_jd();
  after.faults().next(DriveFault::noise_after);
  const Bytes long_end = after.exchange(read_status);
  ASSERT_GT(long_end.size(), reply.size());
  EXPECT_TRUE(std::equal(reply.begin(), reply.end(), long_end.begin()));
}

TEST(RtuFaultSwitch, CorruptFlipsOneBitSoTheCrcIsWrong) {
  RtuBench bench = a_jd();
  const Bytes good = bench.exchange(read_status);
  bench.faults().next(DriveFault::corrupt);
  const Bytes bad = bench.exchange(read_status);
  ASSERT_EQ(bad.size(), good.size());
  int bits = 0;
  for (std::size_t i = 0; i < good.size(); ++i) bits += std::popcount(static_cast<unsigned>(good[i] ^ bad[i]));
  EXPECT_EQ(bits, 1);
  EXPECT_FALSE(open_rtu(bad).has_value());
}

TEST(RtuFaultSwitch, HalfAReplyBreaksOff) {
  RtuBench bench = a_jd();
  const Bytes good = bench.exchange(read_position);
  bench.faults().next(DriveFault::half);
  const Bytes half = bench.exchange(read_position);
  ASSERT_LT(half.size(), good.size());
  EXPECT_GE(half.size(), 1U);
  EXPECT_TRUE(std::equal(half.begin(), half.end(), good.begin()));
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.received, half);
}

TEST(RtuFaultSwitch, SplitSendsTwoPiecesWithAGap) {
  RtuBench bench = a_jd();
  bench.faults().split_gap = milliseconds(4);
  bench.faults().next(DriveFault::split);
  EXPECT_LT(bench.exchange(read_status).size(), 7U);
  bench.pass(milliseconds(4));
  EXPECT_TRUE(open_rtu(bench.received).has_value());
  EXPECT_EQ(bench.arrivals[1].at - bench.arrivals[0].at, milliseconds(4));
}

TEST(RtuFaultSwitch, GluedPutsAnOlderReplyBehindTheNewOneWithoutAGap) {
  RtuBench bench = a_jd();
  const Bytes status = bench.exchange(read_status);
  bench.faults().next(DriveFault::glued);
  Bytes expected = bench.exchange(read_position);
  ASSERT_EQ(expected.size(), 9U + 7U);
  EXPECT_EQ(Bytes(expected.begin() + 9, expected.end()), status);
  EXPECT_TRUE(open_rtu(Bytes(expected.begin(), expected.begin() + 9)).has_value());
}

TEST(RtuFaultSwitch, DuplicateSendsTheReplyTwiceWithAGap) {
  RtuBench bench(an_rtu_kinco(KincoType::jd), RtuLineOptions{});
  bench.faults().next(DriveFault::duplicate);
  bench.exchange(read_status);
  bench.pass(milliseconds(100));
  ASSERT_EQ(bench.arrivals.size(), 2U);
  EXPECT_EQ(bench.arrivals[0].bytes, bench.arrivals[1].bytes);
  EXPECT_EQ(bench.arrivals[1].at - bench.arrivals[0].at, bench.line().on_wire(7) + bench.line().frame_gap());
}

TEST(RtuFaultSwitch, WrongStationAndWrongLengthKeepARightCrc) {
  RtuBench bench = a_jd();
  bench.faults().next(DriveFault::wrong_station);
  const auto foreign = open_rtu(bench.exchange(read_status));
  ASSERT_TRUE(foreign.has_value());
  EXPECT_NE(foreign->unit, 1);
  bench.faults().next(DriveFault::wrong_length, 3);
  const auto longer = open_rtu(bench.exchange(read_status));
  ASSERT_TRUE(longer.has_value());
  EXPECT_EQ(longer->pdu.size(), 2U + 4U);
  EXPECT_EQ(longer->pdu[1], 4);
  const auto shorter = open_rtu(bench.exchange(read_position));
  ASSERT_TRUE(shorter.has_value());
  EXPECT_EQ(shorter->pdu[1], 2);
  const auto acknowledgement = open_rtu(bench.exchange(enable));
  ASSERT_TRUE(acknowledgement.has_value());
  EXPECT_EQ(acknowledgement->pdu.size(), 7U);
}

TEST(RtuFaultSwitch, AnExceptionOfAChosenCodeComesFromADriveThatDidNotAct) {
  RtuBench bench = a_jd();
  bench.faults().exception_code = 6;
  bench.faults().next(DriveFault::exception, 2);
  EXPECT_EQ(*bench.ask(write_pdu(0x3100, 0x0F)), (Bytes{0x86, 6}));
  EXPECT_EQ(*bench.ask(read_pdu(0x3200, 1)), (Bytes{0x81, 6}));
  EXPECT_EQ(bench.kinco().state(), Cia402State::switch_on_disabled);
}

TEST(RtuFaultSwitch, RestartTakesTheReplyAndTheRam) {
  RtuBench bench = a_jd();
  bench.write_pair(0x4000, 77);
  bench.faults().next(DriveFault::restart);
  EXPECT_TRUE(bench.exchange(read_status).empty());
  EXPECT_EQ(bench.kinco().restarts(), 1U);
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.pair(0x4000), 0);
}

TEST(RtuFaultSwitch, ARestartTakesAwayAReplyThatWaits) {
  RtuLineOptions line = no_line_timing();
  line.reply_delay = milliseconds(5);
  RtuBench bench(an_rtu_kinco(KincoType::jd), line);
  bench.exchange(read_status);
  bench.line().restart(0, bench.now);
  bench.pass(milliseconds(20));
  EXPECT_TRUE(bench.received.empty());
}

TEST(RtuFaultSwitch, BabbleSendsNoiseAndWholeFramesUnaskedAndNoReadReplyAmongThem) {
  RtuBench bench = a_jd();
  bench.pass(milliseconds(100));
  bench.faults().set_rate(DriveFault::babble, 1);
  bench.pass(std::chrono::seconds(2));
  EXPECT_GE(bench.arrivals.size(), 190U);
  int frames = 0;
  for (const auto& arrival : bench.arrivals) {
    EXPECT_EQ(arrival.origin, ByteOrigin::noise);
    EXPECT_EQ(arrival.tag, 0U);
    const auto frame = open_rtu(arrival.bytes);
    if (!frame) continue;
    ++frames;
    EXPECT_EQ(frame->pdu[0], function::write_one);
  }
  EXPECT_GT(frames, 50);
  EXPECT_LT(frames, 150);
  bench.faults().clear();
  bench.received.clear();
  bench.pass(milliseconds(100));
  EXPECT_TRUE(bench.received.empty());
}

std::uint64_t run_hash(std::uint64_t seed) {
  Id286proOptions id;
  id.unit = 2;
  RtuBench bench(std::vector<RtuDriveOptions>{an_rtu_kinco(KincoType::md, 1), id}, RtuLineOptions{}, seed);
  for (std::size_t position = 0; position < 2; ++position) {
    for (std::size_t i = 0; i < drive_fault_count; ++i) {
      const auto fault = static_cast<DriveFault>(i);
      bench.faults(position).set_rate(fault, fault == DriveFault::restart ? 0.002 : 0.05);
    }
  }
  Random client(seed + 1);
  for (int i = 0; i < 2000; ++i) {
    const auto unit = static_cast<std::uint8_t>(1 + client.below(3));
    bench.exchange(seal_rtu(unit, client.chance(0.5) ? read_pdu(client.chance(0.5) ? 0x3200 : 109, 1)
                                                     : write_long_pdu(client.chance(0.5) ? 0x4000 : 313, i)));
    bench.pass(milliseconds(25));
  }
  std::uint64_t hash = bench.line().journal().hash();
  for (const auto& arrival : bench.arrivals) {
    hash = (hash ^ static_cast<std::uint64_t>(arrival.at.count())) * 0x100000001B3U;
    for (const std::uint8_t byte : arrival.bytes) hash = (hash ^ byte) * 0x100000001B3U;
  }
  return hash;
}

TEST(RtuDeterminism, TheSameSeedGivesTheSameRun) {
  EXPECT_EQ(run_hash(7), run_hash(7));
  EXPECT_NE(run_hash(7), run_hash(8));
}

}  // namespace
}  // namespace axisgate::simulated
