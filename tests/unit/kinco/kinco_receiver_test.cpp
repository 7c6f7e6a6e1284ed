// What the receiver hears in a stream, told by example.
#include "adapters/kinco/kinco_receiver.hpp"

#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using test::ByteRow;
using test::from_hex;
using test::read_of;
using testing::ElementsAre;
using testing::IsEmpty;
using Heard = Receiver::Heard;

const ByteRow kStatus = from_hex(test::kStatusReply);
const ByteRow kRequest = from_hex(test::kReadStatus);
const ByteRow kOtherObject = from_hex("01 43 63 60 00 B0 3C FF FF 0F");  // 6063h: -50000
const ByteRow kAcknowledgement = from_hex("01 60 40 60 00 0F 00 00 00 F0");

class KincoReceiver : public testing::Test {
 protected:
  std::vector<Heard> hear(const ByteRow& bytes) {
    std::vector<Heard> heard;
    for (const Byte byte : bytes) {
      if (const Heard one = receiver.take(byte); one != Heard::nothing) heard.push_back(one);
    }
    return heard;
  }
  Receiver receiver;
};

TEST_F(KincoReceiver, hears_the_answer_it_awaits) {
  receiver.await(read_of(0x6041));
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::answer));
  EXPECT_EQ(receiver.frame().data, 0xC037u);
  EXPECT_EQ(hex_text(receiver.frame_bytes()), test::kStatusReply);
  EXPECT_EQ(receiver.dropped_bytes(), 0u);
}

TEST_F(KincoReceiver, hears_one_answer_only) {
  receiver.await(read_of(0x6041));
  using test::operator+;
  EXPECT_THAT(hear(kStatus + kStatus), ElementsAre(Heard::answer, Heard::late));
  EXPECT_EQ(receiver.late_replies(), 1u);
}

TEST_F(KincoReceiver, awaiting_nothing_every_reply_is_late) { EXPECT_THAT(hear(kStatus), ElementsAre(Heard::late)); }

TEST_F(KincoReceiver, a_reply_after_giving_up_is_late) {
  receiver.await(read_of(0x6041));
  receiver.give_up();
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::late));
}

TEST_F(KincoReceiver, a_late_reply_to_something_else_does_not_end_the_wait) {
  receiver.await(read_of(0x6041));
  using test::operator+;
  EXPECT_THAT(hear(kOtherObject + kAcknowledgement + kStatus), ElementsAre(Heard::late, Heard::late, Heard::answer));
  EXPECT_EQ(receiver.late_replies(), 2u);
  EXPECT_EQ(receiver.dropped_bytes(), 0u) << "whole frames are no noise";
}

TEST_F(KincoReceiver, drops_the_echo_of_drives_in_a_chain) {
  receiver.await(read_of(0x6041));
  using test::operator+;
  EXPECT_THAT(hear(kRequest + kStatus), ElementsAre(Heard::echo, Heard::answer));
  EXPECT_EQ(receiver.echoes(), 1u);
  EXPECT_EQ(receiver.late_replies(), 0u);
  EXPECT_EQ(receiver.dropped_bytes(), 0u);
}

TEST_F(KincoReceiver, drops_a_late_echo_of_an_older_request) {
  receiver.await(read_of(0x6041));
  using test::operator+;
  EXPECT_THAT(hear(from_hex(test::kWriteControl) + kRequest + kStatus),
              ElementsAre(Heard::echo, Heard::echo, Heard::answer));
}

TEST_F(KincoReceiver, an_echo_without_a_reply_means_nobody_answered) {
  receiver.await(read_of(0x6041));
  EXPECT_THAT(hear(kRequest), ElementsAre(Heard::echo));
}

TEST_F(KincoReceiver, finds_the_answer_behind_half_a_frame) {
  for (std::size_t size = 1; size < kFrameSize; ++size) {
    Receiver fresh;
    receiver = fresh;
    receiver.await(read_of(0x6041));
    ByteRow bytes(kOtherObject.begin(), kOtherObject.begin() + static_cast<std::ptrdiff_t>(size));
    using test::operator+;
    EXPECT_THAT(hear(bytes + kStatus), testing::Contains(Heard::answer)) << size << " bytes before";
    EXPECT_EQ(receiver.frame().data, 0xC037u);
  }
}

TEST_F(KincoReceiver, noise_that_adds_up_across_the_start_of_the_answer_does_not_swallow_it) {
  // Five bytes of noise and the first five of the answer make a well-summed reply of station 9.
  ByteRow noise{9, 0x43, 0x11, 0x22, 0};
  int sum = 0;
  for (const Byte byte : noise) sum += byte;
  for (std::size_t i = 0; i < 5; ++i) sum += kStatus[i];
  noise[4] = static_cast<Byte>(-sum);
  receiver.await(read_of(0x6041));
  using test::operator+;
  EXPECT_THAT(hear(noise + kStatus), ElementsAre(Heard::late, Heard::answer));
  EXPECT_EQ(receiver.frame().data, 0xC037u);
}

TEST_F(KincoReceiver, counts_a_broken_frame_once_and_its_bytes_one_by_one) {
  ByteRow broken = kOtherObject;
  broken[6] ^= 0x10;
  receiver.await(read_of(0x6041));
  using test::operator+;
  EXPECT_THAT(hear(broken + kStatus), ElementsAre(Heard::answer));
  EXPECT_EQ(receiver.bad_frames(), 1u);
  EXPECT_EQ(receiver.dropped_bytes(), 10u);
}

TEST_F(KincoReceiver, bytes_left_over_are_dropped_before_the_next_request) {
  using test::operator+;
  const ByteRow head(kStatus.begin(), kStatus.begin() + 7);
  const ByteRow tail(kStatus.begin() + 7, kStatus.end());
  EXPECT_THAT(hear(head), IsEmpty());
  receiver.await(read_of(0x6041));
  EXPECT_EQ(receiver.dropped_bytes(), 7u);
  EXPECT_THAT(hear(tail), IsEmpty()) << "head and tail of a reply must not meet across a request";
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::answer));
  EXPECT_EQ(receiver.dropped_bytes(), 10u);
}

TEST_F(KincoReceiver, a_new_line_starts_with_nothing) {
  receiver.await(read_of(0x6041));
  hear({kStatus.begin(), kStatus.begin() + 5});
  receiver.reset();
  EXPECT_THAT(hear({kStatus.begin() + 5, kStatus.end()}), IsEmpty());
  EXPECT_THAT(hear(kStatus), ElementsAre(Heard::late)) << "nothing is awaited on it";
}

}  // namespace
}  // namespace axisgate::kinco
