// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/wire/mbap.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/hex.hpp"

namespace axisgate::modbus_tcp {
namespace {

using test::bytes;
using Verdict = MbapFramer::Verdict;

TEST(Mbap, finds_frames_at_every_split_and_glued_together) {
  const auto stream = bytes("12 34 00 00 00 06 05 03 00 64 00 02 00 02 00 00 00 03 02 08 09 00");
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    SCOPED_TRACE(cut);
    MbapFramer framer;
    Frame frame;
    framer.push(Bytes(stream).first(cut));
    if (cut < 12) {
      ASSERT_EQ(framer.next(frame), Verdict::need_more);
    }
    framer.push(Bytes(stream).subspan(cut));
    ASSERT_EQ(framer.next(frame), Verdict::frame);
    EXPECT_EQ(frame.transaction, 0x1234);
    EXPECT_EQ(frame.unit, 5);
    EXPECT_EQ(hex_text(frame.pdu), "03 00 64 00 02");
    ASSERT_EQ(framer.next(frame), Verdict::frame);
    EXPECT_EQ(frame.transaction, 2);
    EXPECT_EQ(hex_text(frame.pdu), "08 09");
    EXPECT_EQ(framer.next(frame), Verdict::need_more);
    EXPECT_EQ(framer.kept(), 1U);
  }
}

TEST(Mbap, tells_a_wrong_protocol_or_length_as_soon_as_it_shows) {
  const std::pair<const char*, Verdict> heads[] = {
      {"00 01", Verdict::need_more},
      {"00 01 01", Verdict::malformed},
      {"00 01 00 01", Verdict::malformed},
      {"00 01 00 00 00 00", Verdict::malformed},
      {"00 01 00 00 00 01", Verdict::malformed},
      {"00 01 00 00 00 02", Verdict::need_more},
      {"00 01 00 00 00 FE", Verdict::need_more},
      {"00 01 00 00 00 FF", Verdict::malformed},
      {"00 01 00 00 01 02", Verdict::malformed},
  };
  for (const auto& [head, verdict] : heads) {
    MbapFramer framer;
    Frame frame;
    framer.push(bytes(head));
    EXPECT_EQ(framer.next(frame), verdict) << head;
  }
}

TEST(Mbap, takes_the_largest_frame) {
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
