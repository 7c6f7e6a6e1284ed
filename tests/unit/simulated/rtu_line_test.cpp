// Frames on an RTU line: split anywhere, wrong, foreign, timed, several kinds of drives (JD 2.2, MD 3, iD286pro 2).
#include <gmock/gmock.h>

#include "tests/unit/simulated/rtu_bench.hpp"

namespace axisgate::simulated {
namespace {

using std::chrono::microseconds;

const Bytes read_jd = seal_rtu(1, read_pdu(0x3200, 1));
const Bytes read_id = seal_rtu(2, read_pdu(108, 2));
constexpr std::size_t reply_jd = 7;

std::vector<RtuDriveOptions> a_jd_and_an_id286pro() {
  Id286proOptions id;
  id.unit = 2;
  return {an_rtu_kinco(KincoType::jd, 1), id};
}

// Times of a line at 19200 baud: 521 us a byte, 1.82 ms of silence between frames.
RtuBench a_real_line() { return RtuBench(a_jd_and_an_id286pro(), RtuLineOptions{}); }

Bytes part(const Bytes& bytes, std::size_t from, std::size_t to) {
  return {bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.begin() + static_cast<std::ptrdiff_t>(to)};
}

// Sends the frame in two parts with this much silence between them, and waits for an answer.
bool answered(RtuBench& bench, const Bytes& frame, std::size_t cut, Time silence) {
  bench.arrivals.clear();
  bench.exchange(part(frame, 0, cut));
  bench.pass(bench.line().on_wire(cut) + silence);
  bench.exchange(part(frame, cut, frame.size()));
  return bench.pass_until([&] { return !bench.arrivals.empty(); }, milliseconds(100));
}

TEST(RtuLine, ARequestSplitAtEveryByteIsUnderstoodWhileThePauseIsShort) {
  for (std::size_t cut = 1; cut < read_jd.size(); ++cut) {
    RtuBench bench = a_real_line();
    EXPECT_TRUE(answered(bench, read_jd, cut, microseconds(700))) << cut;
    EXPECT_TRUE(answered(bench, read_id, cut, microseconds(700))) << cut;
  }
}

TEST(RtuLine, APauseOfThreeAndAHalfCharactersEndsAFrame) {
  for (std::size_t cut = 1; cut < read_jd.size(); ++cut) {
    RtuBench bench = a_real_line();
    EXPECT_FALSE(answered(bench, read_jd, cut, microseconds(1900))) << cut;
    EXPECT_FALSE(answered(bench, read_id, cut, microseconds(1900))) << cut;
    EXPECT_TRUE(answered(bench, read_jd, 4, Time{})) << cut;  // the next frame is whole again
  }
}

TEST(RtuLine, OneAndAHalfCharactersInsideAFrameAbortItOnTheId286proAlone) {
  RtuBench bench = a_real_line();
  EXPECT_TRUE(answered(bench, read_jd, 4, microseconds(1000)));
  EXPECT_FALSE(answered(bench, read_id, 4, microseconds(1000)));
  EXPECT_TRUE(answered(bench, read_id, 4, microseconds(700)));
}

TEST(RtuLine, TwoFramesWithoutASilenceBetweenThemAreNone) {
  RtuBench bench(a_jd_and_an_id286pro());
  Bytes two = read_jd;
  two.insert(two.end(), read_jd.begin(), read_jd.end());
  EXPECT_TRUE(bench.exchange(two).empty());
  EXPECT_EQ(bench.exchange(read_jd).size(), reply_jd);
}

TEST(RtuLine, AnySingleWrongBitMeetsSilenceAndChangesNothing) {
  RtuBench bench(a_jd_and_an_id286pro());
  const Bytes enable = seal_rtu(1, write_pdu(0x3100, 0x0F));
  for (std::size_t bit = 0; bit < 8 * enable.size(); ++bit) {
    Bytes wrong = enable;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_TRUE(bench.exchange(wrong).empty()) << bit;
  }
  EXPECT_EQ(bench.kinco(0).writes({0x6040, 0}), 0U);
  EXPECT_EQ(bench.line().journal().recorded(), 0U);
}

TEST(RtuLine, AForeignUnitAndAFrameWithoutFunctionMeetSilence) {
  RtuBench bench(a_jd_and_an_id286pro());
  EXPECT_TRUE(bench.exchange(seal_rtu(3, read_pdu(0x3200, 1))).empty());
  EXPECT_TRUE(bench.exchange(seal_rtu(1, Bytes{})).empty());
  EXPECT_TRUE(bench.exchange(Bytes(300, 0x01)).empty());
  EXPECT_EQ(bench.exchange(read_jd).size(), reply_jd);
}

TEST(RtuLine, EachDriveAnswersWithItsOwnDelay) {
  RtuBench bench = a_real_line();
  bench.exchange(read_jd);
  ASSERT_TRUE(bench.pass_until([&] { return !bench.arrivals.empty(); }, milliseconds(50)));
  // 8 bytes, 3.5 characters of silence, 7 bytes.
  EXPECT_NEAR(static_cast<double>(bench.arrivals[0].at.count()), (8 + 3.5 + 7) * 520833, 100);
  bench.arrivals.clear();
  bench.now = milliseconds(100);
  bench.exchange(read_id);
  ASSERT_TRUE(bench.pass_until([&] { return !bench.arrivals.empty(); }, milliseconds(100)));
  // 8 bytes, 20 ms, 9 bytes (iD286pro 2: about 33 ms with the gaps).
  EXPECT_NEAR(static_cast<double>(bench.arrivals[0].at.count()), 100e6 + 20e6 + (8 + 9) * 520833, 100);
}

TEST(RtuLine, AGlobalDelayReplacesTheDrivesOwn) {
  RtuLineOptions line;
  line.reply_delay = milliseconds(5);
  RtuBench bench(a_jd_and_an_id286pro(), line);
  bench.exchange(read_id);
  ASSERT_TRUE(bench.pass_until([&] { return !bench.arrivals.empty(); }, milliseconds(100)));
  EXPECT_NEAR(static_cast<double>(bench.arrivals[0].at.count()), 5e6 + (8 + 9) * 520833, 100);
}

TEST(RtuLine, OfferingBothKindsOnOneLineAnswersEachInItsOwnWay) {
  RtuBench bench(a_jd_and_an_id286pro());
  EXPECT_EQ(bench.ask(read_pdu(0x9999, 1), 1)->at(0), 0x81);
  EXPECT_EQ(bench.ask(read_pdu(999, 1), 2)->at(0), 0x83);
  EXPECT_EQ(bench.line().slave(0).describe(), "jd@1");
  EXPECT_EQ(bench.line().slave(1).describe(), "id286pro@2");
}

TEST(RtuLine, OnlyTheAddressedKindObeysABroadcast) {
  RtuBench bench(a_jd_and_an_id286pro());
  EXPECT_TRUE(bench.exchange(seal_rtu(255, write_pdu(301, 55))).empty());
  EXPECT_EQ(bench.word(301, 2), 55);
  EXPECT_TRUE(bench.exchange(seal_rtu(0, write_pdu(301, 66))).empty());
  EXPECT_EQ(bench.word(301, 2), 55);
  EXPECT_TRUE(bench.exchange(seal_rtu(255, read_pdu(301, 1))).empty());
  EXPECT_EQ(bench.kinco(0).state(), Cia402State::switch_on_disabled);
}

TEST(RtuLine, TheJournalTellsWhoAskedWhenAndWhatTheDriveHeldThen) {
  RtuLineOptions line;
  line.journal_capacity = 2;
  RtuBench bench(a_jd_and_an_id286pro(), line);
  for (int i = 0; i < 3; ++i) {
    bench.exchange(read_jd);
    bench.pass(milliseconds(50));
  }
  ASSERT_EQ(bench.line().journal().entries().size(), 2U);
  EXPECT_EQ(bench.line().journal().recorded(), 3U);
  const RtuExchange& newest = bench.line().journal().entries().back();
  EXPECT_EQ(newest.tag, 3U);
  EXPECT_EQ(newest.station, 1);
  EXPECT_EQ(newest.request, read_jd);
  EXPECT_EQ(newest.sent, bench.arrivals.back().bytes);
  EXPECT_EQ(bench.arrivals.back().tag, 3U);
  EXPECT_EQ(newest.reply_ready + bench.line().on_wire(reply_jd), bench.arrivals.back().at);
}

TEST(RtuLine, ACutCableLosesWhatIsUnderWay) {
  RtuBench bench = a_real_line();
  bench.exchange(read_jd);
  bench.line().cut();
  bench.pass(milliseconds(50));
  EXPECT_TRUE(bench.received.empty());
  EXPECT_EQ(bench.line().journal().recorded(), 0U);
  bench.exchange(read_id);
  bench.pass(milliseconds(10));  // heard, not yet answered
  bench.line().cut();
  bench.pass(milliseconds(50));
  EXPECT_TRUE(bench.received.empty());
  EXPECT_EQ(bench.line().journal().recorded(), 1U);
}

TEST(RtuLine, AnAddressOutOfTheKindsRangeIsRefused) {
  EXPECT_THROW(RtuBench bench(an_rtu_kinco(KincoType::jd, 128)), std::invalid_argument);
  Id286proOptions id;
  id.unit = 255;
  EXPECT_THROW(RtuBench bench(id), std::invalid_argument);
}

TEST(RtuLine, TheSinkMaySendTheNextRequest) {
  int replies = 0;
  RtuLine* self = nullptr;
  RtuLine line(no_line_timing(), Random(1), [&](const ToHost& arrived) {
    if (++replies < 5) self->from_host(read_jd, arrived.at);
  });
  self = &line;
  line.add(an_rtu_kinco(KincoType::jd));
  line.from_host(read_jd, milliseconds(1));
  EXPECT_EQ(replies, 5);
}

}  // namespace
}  // namespace axisgate::simulated
