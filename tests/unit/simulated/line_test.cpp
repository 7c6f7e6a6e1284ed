// Frames on the wire: split anywhere, wrong, foreign, timed (JD 2.1, MD 2.2).
#include <gtest/gtest.h>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {
namespace {

const Bytes read_status = from_hex("01 40 41 60 00 00 00 00 00 1E");

TEST(Line, ARequestSplitAtEveryByteIsUnderstood) {
  for (std::size_t cut = 1; cut < frame_length; ++cut) {
    Bench bench(a_drive(KincoType::jd));
    bench.exchange(Bytes(read_status.begin(), read_status.begin() + static_cast<std::ptrdiff_t>(cut)));
    EXPECT_TRUE(bench.received.empty());
    bench.pass(milliseconds(5));
    EXPECT_EQ(bench.exchange(Bytes(read_status.begin() + static_cast<std::ptrdiff_t>(cut), read_status.end())).size(),
              frame_length)
        << cut;
  }
}

TEST(Line, ByteByByteAndTwoGluedRequestsAreUnderstood) {
  Bench bench(a_drive(KincoType::jd));
  for (std::size_t i = 0; i + 1 < frame_length; ++i) EXPECT_TRUE(bench.exchange(Bytes{read_status[i]}).empty());
  EXPECT_EQ(bench.exchange(Bytes{read_status.back()}).size(), frame_length);
  Bytes two = read_status;
  two.insert(two.end(), read_status.begin(), read_status.end());
  EXPECT_EQ(bench.exchange(two).size(), 2 * frame_length);
}

TEST(Line, AWrongChecksumMeetsSilenceAndChangesNothing) {
  Bench bench(a_drive(KincoType::md));
  EXPECT_TRUE(bench.exchange(from_hex("01 2B 40 60 00 2F 00 00 00 06")).empty());
  EXPECT_EQ(bench.drive().writes({0x6040, 0}), 0U);
  EXPECT_EQ(bench.exchange(read_status).size(), frame_length);
}

TEST(Line, AnotherStationMeetsSilence) {
  Bench bench(a_drive(KincoType::jd));
  EXPECT_TRUE(bench.exchange(seal(2, FrameCommand::read, 0x6041, 0, 0)).empty());
}

TEST(Line, SilenceDropsWhatWasBegun) {
  Bench bench(a_drive(KincoType::jd));
  bench.exchange(Bytes(read_status.begin(), read_status.begin() + 7));
  bench.pass(milliseconds(25));
  EXPECT_EQ(bench.exchange(read_status).size(), frame_length);
}

TEST(Line, ErrorsCarryCia301Codes) {
  Bench bench(a_drive(KincoType::jd));
  EXPECT_EQ(bench.ask(FrameCommand::read, 0x9999, 0, 0)->data, 0x06020000U);
  EXPECT_EQ(bench.ask(FrameCommand::write_2, 0x6041, 0, 1)->data, 0x06010002U);
  EXPECT_EQ(bench.ask(FrameCommand::write_1, 0x6040, 0, 1)->data, 0x06070010U);
  EXPECT_EQ(bench.write(0x6060, 0, 2), 0x06090030U);
}

TEST(Line, TheJdClampsWhereTheMdRefuses) {
  Bench jd(a_drive(KincoType::jd));
  EXPECT_EQ(jd.write(0x60FF, 0, 20000000), 0U);
  EXPECT_EQ(jd.read(0x60FF), 16777215);
  Bench md(a_drive(KincoType::md));
  EXPECT_EQ(md.write(0x60FF, 0, 60000000), 0x06090030U);
  EXPECT_EQ(md.read(0x60FF), 0);
  EXPECT_EQ(md.drive().writes({0x60FF, 0}), 0U);
}

TEST(Line, BytesTakeTheirTimeAtABaudRate) {
  LineOptions line;
  line.baud = 38400;
  line.reply_delay = milliseconds(5);
  Bench bench(a_drive(KincoType::jd), line);
  bench.exchange(read_status);
  while (bench.arrivals.empty()) {
    const auto next = bench.line().next_event();
    ASSERT_TRUE(next.has_value());
    bench.now = *next;
    bench.line().advance(*next);
  }
  // Twice 100 bits at 38400 (JD 2.1: 2.6 ms each) and 5 ms between them.
  EXPECT_NEAR(static_cast<double>(bench.arrivals.front().at.count()), 10.208e6, 0.01e6);
}

TEST(Line, ADriveAtAnotherBaudHearsNothing) {
  LineOptions line;
  line.baud = 115200;
  line.check_baud = true;
  Bench bench(a_drive(KincoType::jd), line);
  bench.exchange(read_status);
  bench.pass(milliseconds(50));
  EXPECT_TRUE(bench.received.empty());
}

TEST(Line, TheSinkMaySendTheNextRequest) {
  int replies = 0;
  SerialLine* self = nullptr;
  SerialLine line({}, Random(1), [&](const ToHost& arrived) {
    if (++replies < 5) self->from_host(read_status, arrived.at);
  });
  self = &line;
  line.add(a_drive(KincoType::jd));
  line.from_host(read_status, milliseconds(1));
  EXPECT_EQ(replies, 5);
}

TEST(Line, TheJournalTiesEachReplyToItsRequest) {
  LineOptions line;
  line.journal_capacity = 3;
  Bench bench(a_drive(KincoType::jd), line);
  for (int i = 0; i < 5; ++i) bench.exchange(read_status);
  EXPECT_EQ(bench.line().journal().recorded(), 5U);
  ASSERT_EQ(bench.line().journal().entries().size(), 3U);
  EXPECT_EQ(bench.line().journal().entries().back().tag, 5U);
  EXPECT_EQ(bench.line().journal().entries().back().sent, bench.received);
  EXPECT_EQ(bench.arrivals.back().tag, 5U);
}

}  // namespace
}  // namespace axisgate::simulated
