// Every fault switch does what its name says, once or by chance, and the same seed gives the same run.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

const Bytes read_status = from_hex("01 40 41 60 00 00 00 00 00 1E");
const Bytes enable = from_hex("01 2B 40 60 00 0F 00 00 00 25");

TEST(FaultSwitch, MuteNeitherActsNorAnswers) {
  Bench bench(a_drive(KincoType::jd));
  bench.faults().set_rate(DriveFault::mute, 1);
  EXPECT_TRUE(bench.exchange(enable).empty());
  EXPECT_EQ(bench.drive().state(), Cia402State::switch_on_disabled);
  bench.faults().clear();
  EXPECT_EQ(bench.exchange(enable).size(), frame_length);
}

TEST(FaultSwitch, ALostReplyComesFromADriveThatActed) {
  Bench bench(a_drive(KincoType::jd));
  bench.faults().next(DriveFault::lose);
  EXPECT_TRUE(bench.exchange(enable).empty());
  EXPECT_EQ(bench.drive().state(), Cia402State::operation_enabled);
  EXPECT_EQ(bench.exchange(read_status).size(), frame_length);
}

TEST(FaultSwitch, ALateReplyDelaysThoseBehindIt) {
  Bench bench(a_drive(KincoType::jd));
  bench.faults().late_by = milliseconds(260);
  bench.faults().next(DriveFault::late);
  EXPECT_TRUE(bench.exchange(read_status).empty());
  bench.pass(milliseconds(100));
  EXPECT_TRUE(bench.exchange(seal(1, FrameCommand::read, 0x6063, 0, 0)).empty());
  bench.pass(milliseconds(159));
  EXPECT_TRUE(bench.received.empty());
  bench.pass(milliseconds(1));
  ASSERT_EQ(bench.received.size(), 2 * frame_length);
  EXPECT_EQ(bench.received[2], 0x41);  // in the order of the requests
  EXPECT_EQ(bench.received[12], 0x63);
}

TEST(FaultSwitch, NoiseStandsBeforeOrAfterTheReply) {
  Bench clean(a_drive(KincoType::jd));
  const Bytes reply = clean.exchange(read_status);
  Bench before(a_drive(KincoType::jd));
  before.faults().next(DriveFault::noise_before);
  const Bytes late_start = before.exchange(read_status);
  ASSERT_GT(late_start.size(), frame_length);
  EXPECT_TRUE(std::equal(reply.rbegin(), reply.rend(), late_start.rbegin()));
  Bench after(a_drive(KincoType::jd));
  after.faults().next(DriveFault::noise_after);
  const Bytes long_end = after.exchange(read_status);
  ASSERT_GT(long_end.size(), frame_length);
  EXPECT_TRUE(std::equal(reply.begin(), reply.end(), long_end.begin()));
}

TEST(FaultSwitch, CorruptFlipsOneBitSoTheSumIsWrong) {
  Bench bench(a_drive(KincoType::jd));
  const Bytes good = bench.exchange(read_status);
  bench.faults().next(DriveFault::corrupt);
  const Bytes bad = bench.exchange(read_status);
  ASSERT_EQ(bad.size(), frame_length);
  int bits = 0;
  for (std::size_t i = 0; i < frame_length; ++i) bits += std::popcount(static_cast<unsigned>(good[i] ^ bad[i]));
  EXPECT_EQ(bits, 1);
}

TEST(FaultSwitch, SplitSendsTwoPiecesWithAGap) {
  Bench bench(a_drive(KincoType::jd));
  bench.faults().split_gap = milliseconds(4);
  bench.faults().next(DriveFault::split);
  EXPECT_LT(bench.exchange(read_status).size(), frame_length);
  bench.pass(milliseconds(4));
  EXPECT_EQ(bench.received.size(), frame_length);
  EXPECT_EQ(bench.arrivals.back().at - bench.arrivals.front().at, milliseconds(4));
}

TEST(FaultSwitch, DuplicateSendsTheReplyTwice) {
  Bench bench(a_drive(KincoType::jd));
  bench.faults().next(DriveFault::duplicate);
  const Bytes both = bench.exchange(read_status);
  ASSERT_EQ(both.size(), 2 * frame_length);
  EXPECT_TRUE(std::equal(both.begin(), both.begin() + frame_length, both.begin() + frame_length));
}

TEST(FaultSwitch, WrongStationKeepsARightSum) {
  Bench bench(a_drive(KincoType::jd));
  bench.faults().next(DriveFault::wrong_station);
  const Bytes reply = bench.exchange(read_status);
  TenByteFrame frame{};
  std::copy(reply.begin(), reply.end(), frame.begin());
  EXPECT_TRUE(sums_to_zero(frame));
  EXPECT_NE(station_of(frame), 1);
}

TEST(FaultSwitch, RestartTakesTheReplyAndTheRam) {
  Bench bench(a_drive(KincoType::jd));
  bench.write(0x607A, 0, 77);
  bench.faults().next(DriveFault::restart);
  EXPECT_TRUE(bench.exchange(read_status).empty());
  EXPECT_EQ(bench.drive().restarts(), 1U);
  EXPECT_TRUE(bench.exchange(read_status).empty());  // still booting
  bench.pass(std::chrono::seconds(1));
  EXPECT_EQ(bench.read(0x607A), 0);
}

TEST(FaultSwitch, ARestartTakesAwayAReplyThatWaits) {
  LineOptions line;
  line.reply_delay = milliseconds(5);
  Bench bench(a_drive(KincoType::jd), line);
  bench.exchange(read_status);
  bench.line().restart(0, bench.now);
  bench.pass(milliseconds(20));
  EXPECT_TRUE(bench.received.empty());
}

TEST(FaultSwitch, BabbleSendsBytesUnasked) {
  Bench bench(a_drive(KincoType::jd));
  bench.pass(milliseconds(100));
  bench.faults().set_rate(DriveFault::babble, 1);
  bench.pass(milliseconds(100));
  EXPECT_GE(bench.arrivals.size(), 8U);
  EXPECT_EQ(bench.arrivals.front().origin, ByteOrigin::noise);
  EXPECT_EQ(bench.arrivals.front().tag, 0U);
  bench.faults().clear();
  bench.received.clear();
  bench.pass(milliseconds(100));
  EXPECT_TRUE(bench.received.empty());
}

TEST(FaultSwitch, EveryFaultHasANameThatIsFoundAgain) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < drive_fault_count; ++i) {
    const auto fault = static_cast<DriveFault>(i);
    names.insert(name_of(fault));
    EXPECT_EQ(drive_fault_named(name_of(fault)), fault);
  }
  EXPECT_EQ(names.size(), drive_fault_count);
  EXPECT_EQ(drive_fault_named("deaf"), std::nullopt);
}

// A minute of traffic with all faults at once.
std::uint64_t run_hash(std::uint64_t seed) {
  Bench bench(std::vector{a_drive(KincoType::jd, 1)}, {}, seed);
  for (std::size_t i = 0; i < drive_fault_count; ++i) {
    bench.faults().set_rate(static_cast<DriveFault>(i),
                            static_cast<DriveFault>(i) == DriveFault::restart ? 0.002 : 0.05);
  }
  Random client(seed + 1);
  for (int i = 0; i < 3000; ++i) {
    const bool write = client.chance(0.3);
    bench.exchange(write ? seal(1, FrameCommand::write_4, 0x607A, 0, static_cast<std::uint32_t>(client.below(9999)))
                         : seal(1, FrameCommand::read, 0x6041, 0, 0));
    bench.pass(milliseconds(20));
  }
  std::uint64_t hash = bench.line().journal().hash();
  for (const auto& arrival : bench.arrivals) {
    hash = (hash ^ static_cast<std::uint64_t>(arrival.at.count())) * 0x100000001B3U;
    hash = (hash ^ arrival.length) * 0x100000001B3U;
  }
  return hash;
}

TEST(Determinism, TheSameSeedGivesTheSameRun) {
  EXPECT_EQ(run_hash(7), run_hash(7));
  EXPECT_NE(run_hash(7), run_hash(8));
}

TEST(Determinism, TheGeneratorGivesTheseNumbersEverywhere) {
  Random random(1);
  EXPECT_EQ(random.next(), 0xB3F2AF6D0FC710C5U);
  Random again(1);
  EXPECT_EQ(again.below(1000), 0xB3F2AF6D0FC710C5U % 1000);
}

TEST(Determinism, StepsOfTimeDoNotMatter) {
  Bench coarse(a_drive(KincoType::jd));
  Bench fine(a_drive(KincoType::jd));
  for (Bench* bench : {&coarse, &fine}) {
    bench->write(0x6060, 0, 1);
    bench->control(0x0F);
    bench->write(0x607A, 0, 123456);
    bench->control(0x2F);
    bench->control(0x3F);
  }
  coarse.pass(milliseconds(1777));
  for (int i = 0; i < 17770; ++i) fine.pass(std::chrono::microseconds(100));
  EXPECT_EQ(coarse.drive().axis().actual(), fine.drive().axis().actual());
  EXPECT_NE(coarse.drive().position(), 0);
}

}  // namespace
}  // namespace axisgate::simulated
