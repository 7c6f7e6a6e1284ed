// SPDX-License-Identifier: Apache-2.0
// What the receiver hears in a stream, told by example. Streams at random: kinco_receiver_property_test.cpp.
#include "adapters/kinco/kinco_receiver.hpp"

#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using test::ByteRow;
using test::from_hex;
using test::read_of;
using testing::ElementsAre;
using testing::IsEmpty;
using test::operator+;
using Heard = Receiver::Heard;

const ByteRow kStatus = from_hex(test::kStatusReply);
const ByteRow kRequest = from_hex(test::kReadStatus);
const ByteRow kOlderRequest = from_hex(test::kWriteControl);
const ByteRow kOtherObject = from_hex("01 43 63 60 00 B0 3C FF FF 0F");  // 6063h: -50000
const ByteRow kAcknowledgement = from_hex("01 60 40 60 00 0F 00 00 00 F0");

class KincoReceiver : public testing::Test {
 protected:
  KincoReceiver() { receiver.await(read_of(0x6041)); }
  std::vector<Heard> hear(const ByteRow& bytes) {
    std::vector<Heard> heard;
    for (const Byte byte : bytes) {
      if (const Heard one = receiver.take(byte); one != Heard::nothing) heard.push_back(one);
    }
    return heard;
  }
  Receiver receiver;
};

TEST_F(KincoReceiver, hears_whole_frames_for_what_they_are_and_none_as_noise) {
  const std::pair<ByteRow, std::vector<Heard>> streams[] = {
      {kStatus, {Heard::answer}},
      {kStatus + kStatus, {Heard::answer, Heard::late}},
      {kOtherObject + kAcknowledgement + kStatus, {Heard::late, Heard::late, Heard::answer}},
      {kRequest + kStatus, {Heard::echo, Heard::answer}},
      {kOlderRequest + kRequest + kStatus, {Heard::foreign, Heard::echo, Heard::answer}},
      {kRequest, {Heard::echo}},
  };
  for (const auto& [stream, expected] : streams) {
    SCOPED_TRACE(hex_text(stream));
    receiver = Receiver();
    receiver.await(read_of(0x6041));
    EXPECT_EQ(hear(stream), expected);
    EXPECT_EQ(receiver.late_replies(), std::ranges::count(expected, Heard::late));
    EXPECT_EQ(receiver.echoes(), std::ranges::count(expected, Heard::echo));
    EXPECT_EQ(receiver.foreign_frames(), std::ranges::count(expected, Heard::foreign));
    EXPECT_EQ(receiver.dropped_bytes(), 0u);
  }
}

TEST_F(KincoReceiver, awaiting_nothing_or_no_more_every_reply_is_late) {
  receiver.give_up();
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::late));
  receiver = Receiver();
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::late));
}

TEST_F(KincoReceiver, skips_a_glitch_before_answer_and_echo_and_counts_no_bad_frame) {
  for (const Byte glitch : {Byte{0x00}, Byte{0xFF}}) {
    for (std::size_t size = 1; size <= bus::GlitchSkip::kMost; ++size) {
      receiver = Receiver();
      receiver.await(read_of(0x6041));
      const ByteRow before(size, glitch);
      EXPECT_THAT(hear(before + kRequest + before + kStatus), ElementsAre(Heard::echo, Heard::answer));
      EXPECT_EQ(receiver.dropped_bytes(), 2 * size);
      EXPECT_EQ(receiver.bad_frames(), 0u);
    }
  }
}

TEST_F(KincoReceiver, counts_a_broken_frame_once_and_its_bytes_one_by_one) {
  ByteRow broken = kOtherObject;
  broken[6] ^= 0x10;
  EXPECT_THAT(hear(broken + kStatus), ElementsAre(Heard::answer));
  EXPECT_EQ(receiver.bad_frames(), 1u);
  EXPECT_EQ(receiver.dropped_bytes(), 10u);
}

TEST_F(KincoReceiver, head_and_tail_of_a_reply_do_not_meet_across_a_request_or_a_new_line) {
  const ByteRow head(kStatus.begin(), kStatus.begin() + 7);
  const ByteRow tail(kStatus.begin() + 7, kStatus.end());
  EXPECT_THAT(hear(head), IsEmpty());
  receiver.await(read_of(0x6041));
  EXPECT_EQ(receiver.dropped_bytes(), 7u);
  EXPECT_THAT(hear(tail), IsEmpty());
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::answer));
  EXPECT_EQ(receiver.dropped_bytes(), 10u);
  receiver.await(read_of(0x6041));
  hear(head);
  receiver.reset();
  EXPECT_THAT(hear(tail), IsEmpty());
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::late)) << "nothing is awaited on a new line";
}

}  // namespace
}  // namespace axisgate::kinco
