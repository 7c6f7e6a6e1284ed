#include "gateway/upstream/modbus_tcp/mbap.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/hex.hpp"

namespace axisgate::modbus_tcp {
namespace {

using test::bytes;
using Verdict = MbapFramer::Verdict;

Verdict verdict_on(const std::string& hex) {
  MbapFramer framer;
  Frame frame;
  framer.push(bytes(hex));
  return framer.next(frame);
}

TEST(Mbap, TakesAFrameOffTheStream) {
  MbapFramer framer;
  Frame frame;
  framer.push(bytes("12 34 00 00 00 06 05 03 00 64 00 02"));
  ASSERT_EQ(framer.next(frame), Verdict::frame);
  EXPECT_EQ(frame.transaction, 0x1234);
  EXPECT_EQ(frame.unit, 5);
  EXPECT_EQ(hex_text(frame.pdu), "03 00 64 00 02");
  EXPECT_EQ(framer.kept(), 0U);
  EXPECT_EQ(framer.next(frame), Verdict::need_more);
}

TEST(Mbap, FindsTheSameFrameAtEverySplit) {
  const auto whole = bytes("12 34 00 00 00 06 05 03 00 64 00 02");
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    MbapFramer framer;
    Frame frame;
    framer.push(Bytes(whole).first(cut));
    if (cut < whole.size()) {
      ASSERT_EQ(framer.next(frame), Verdict::need_more) << cut;
      framer.push(Bytes(whole).subspan(cut));
    }
    ASSERT_EQ(framer.next(frame), Verdict::frame) << cut;
    EXPECT_EQ(hex_text(frame.pdu), "03 00 64 00 02");
  }
}

TEST(Mbap, FindsTwoFramesGluedTogether) {
  MbapFramer framer;
  Frame frame;
  framer.push(bytes("00 01 00 00 00 02 01 07 00 02 00 00 00 03 02 08 09 00"));
  ASSERT_EQ(framer.next(frame), Verdict::frame);
  EXPECT_EQ(hex_text(frame.pdu), "07");
  ASSERT_EQ(framer.next(frame), Verdict::frame);
  EXPECT_EQ(frame.transaction, 2);
  EXPECT_EQ(hex_text(frame.pdu), "08 09");
  EXPECT_EQ(framer.next(frame), Verdict::need_more);
  EXPECT_EQ(framer.kept(), 1U);
}

TEST(Mbap, TellsAWrongProtocolAsSoonAsItShows) {
  EXPECT_EQ(verdict_on("00 01"), Verdict::need_more);
  EXPECT_EQ(verdict_on("00 01 01"), Verdict::malformed);
  EXPECT_EQ(verdict_on("00 01 00 01"), Verdict::malformed);
}

TEST(Mbap, TakesLengthsOf2To254AndNoOthers) {
  EXPECT_EQ(verdict_on("00 01 00 00 00 00"), Verdict::malformed);
  EXPECT_EQ(verdict_on("00 01 00 00 00 01"), Verdict::malformed);
  EXPECT_EQ(verdict_on("00 01 00 00 00 02"), Verdict::need_more);
  EXPECT_EQ(verdict_on("00 01 00 00 00 FE"), Verdict::need_more);
  EXPECT_EQ(verdict_on("00 01 00 00 00 FF"), Verdict::malformed);
  EXPECT_EQ(verdict_on("00 01 00 00 01 02"), Verdict::malformed);
}

TEST(Mbap, TakesTheLargestFrame) {
  MbapFramer framer;
  Frame frame;
  std::vector<Byte> whole = bytes("00 01 00 00 00 FE 01");
  whole.resize(260, 0x55);
  framer.push(whole);
  ASSERT_EQ(framer.next(frame), Verdict::frame);
  EXPECT_EQ(frame.pdu.size(), 253U);
}

}  // namespace
}  // namespace axisgate::modbus_tcp
