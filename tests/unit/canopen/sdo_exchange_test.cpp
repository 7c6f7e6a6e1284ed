// Exchanges of up to four bytes: one frame each way, and one reply for each request.
#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using SdoExchange = CanopenWireStage;

TEST_F(SdoExchange, a_read_is_sent_to_its_node_and_its_value_reported) {
  wire->send(read_of(0x6041, 0, 2));
  EXPECT_THAT(link->sent, ElementsAre(frame_of(0x601, "40 41 60 00 00 00 00 00")));
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0x0237)));
}

TEST_F(SdoExchange, a_frame_shorter_than_eight_bytes_is_taken) {
  wire->send(read_of(0x6041));
  bring(0x581, "4B 41 60 00 37 02");
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0x0237)));
}

TEST_F(SdoExchange, a_value_without_a_size_has_four_bytes) {
  wire->send(read_of(0x6064));
  bring(0x581, "42 64 60 00 E0 B1 FF FF");
  EXPECT_THAT(replies, ElementsAre(value_of(0x6064, 4, 0xFFFFB1E0)));
}

TEST_F(SdoExchange, a_width_other_than_asked_is_reported_as_it_came) {
  wire->send(read_of(0x6041, 0, 4));
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0x0237))) << "the profile's type decides what that means";
}

TEST_F(SdoExchange, a_write_is_ok_with_or_without_an_echo_of_its_data) {
  for (const char* ack : {"60 40 60 00 00 00 00 00", "60 40 60 00 0F 00 00 00", "60 40 60 00 0F 00"}) {
    wire->send(write_of(0x6040, 0x0F, 2));
    bring(0x581, ack);
  }
  EXPECT_THAT(link->sent, testing::Each(frame_of(0x601, "2B 40 60 00 0F 00 00 00")));
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}, bus::ExchangeResult{}, bus::ExchangeResult{}));
}

TEST_F(SdoExchange, an_abort_is_a_refusal_with_the_drives_own_number) {
  wire->send(read_of(0x9999));
  bring(0x581, "80 99 99 00 00 00 02 06");
  wire->send(write_of(0x6060, 9, 1));
  bring(0x581, "80 60 60 00 10 00 06 06");
  wire->send(write_of(0x6060, 9, 1));
  bring(0x581, "80 60 60 00 22 00 00 08");
  EXPECT_THAT(replies, ElementsAre(refusal_of(0x06020000), refusal_of(0x06060010), refusal_of(0x08000022, true)));
}

TEST_F(SdoExchange, only_the_reply_that_fits_in_everything_ends_the_exchange) {
  wire->send(read_of(0x6041, 0, 2));
  bring(0x582, "4B 41 60 00 01 00 00 00");  // another node
  bring(0x581, "4B 41 61 00 02 00 00 00");  // another object
  bring(0x581, "4B 41 60 01 03 00 00 00");  // another sub-index
  bring(0x581, "60 41 60 00 04 00 00 00");  // an acknowledgement
  bring(0x581, "80 41 60 01 00 00 02 06");  // an abort of another sub-index
  bring(0x581, "03 01 00 00 00 00 00 00");  // a segment
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 6u);
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0x0237)));
}

TEST_F(SdoExchange, what_is_no_reply_is_a_bad_frame_and_waiting_goes_on) {
  wire->send(read_of(0x6041));
  for (const char* hex : {"", "4B 41 60", "43 41 60 00 37 02", "E0 41 60 00 00 00 00 00"}) bring(0x581, hex);
  EXPECT_EQ(wire->statistics().bad_frames, 4u);
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(SdoExchange, a_timeout_is_told_to_the_server_and_its_reply_is_late) {
  wire->send(read_of(0x6041));
  clear();
  wire->abandon();
  EXPECT_THAT(link->sent, ElementsAre(frame_of(0x601, "80 41 60 00 00 00 04 05")));
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_THAT(told, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(SdoExchange, a_late_reply_does_not_answer_the_next_request) {
  wire->send(read_of(0x6041));
  wire->abandon();
  wire->send(read_of(0x6063));
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_THAT(replies, IsEmpty());
  bring(0x581, "43 63 60 00 B0 3C FF FF");
  EXPECT_THAT(replies, ElementsAre(value_of(0x6063, 4, 0xFFFF3CB0)));
}

TEST_F(SdoExchange, an_object_longer_than_wanted_is_refused_and_its_transfer_ended) {
  wire->send(read_of(0x1008, 0, 4));
  bring(0x581, "41 08 10 00 09 00 00 00");
  EXPECT_EQ(link->sent.back(), frame_of(0x601, "80 08 10 00 22 00 00 08"));
  EXPECT_THAT(replies, ElementsAre(refusal_of(0x06070010))) << "it will be as long the next time";
}

TEST_F(SdoExchange, three_bytes_fit_no_field_and_are_refused_where_a_field_is_wanted) {
  wire->send(read_of(0x2000));
  bring(0x581, "47 00 20 00 01 02 03 00");
  EXPECT_THAT(replies, ElementsAre(refusal_of(0x06070010)));
  wire->send(long_read_of(0x2000));
  bring(0x581, "47 00 20 00 01 02 03 00");
  ASSERT_TRUE(replies.back().bytes);
  EXPECT_EQ(*replies.back().bytes, from_hex("01 02 03"));
}

TEST_F(SdoExchange, the_next_request_may_be_sent_from_inside_a_reply) {
  wire->send(read_of(0x6041));
  next = read_of(0x6064);
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_EQ(link->sent.back(), frame_of(0x601, "40 64 60 00 00 00 00 00"));
  bring(0x581, "43 64 60 00 01 00 00 00");
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0x0237), value_of(0x6064, 4, 1)));
}

// --- Two devices, one number (a second reply) -----------------------------------------------------------------------

TEST_F(SdoExchange, a_second_reply_to_a_finished_request_tells_of_a_twin) {
  wire->send(read_of(0x6041));
  bring(0x581, "4B 41 60 00 37 02 00 00");
  runtime.advance_by(200ms);
  bring(0x581, "80 41 60 00 00 00 02 06");
  EXPECT_THAT(kinds(), ElementsAre(bus::Notice::Kind::twin));
  EXPECT_EQ(notices[0].node, 1);
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(SdoExchange, a_second_reply_after_two_timeouts_is_only_late) {
  wire->send(read_of(0x6041));
  bring(0x581, "4B 41 60 00 37 02 00 00");
  runtime.advance_by(201ms);
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_THAT(notices, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(SdoExchange, the_reply_to_a_request_given_up_is_no_twins) {
  wire->send(read_of(0x6041));
  wire->abandon();
  wire->send(read_of(0x6041));
  bring(0x581, "4B 41 60 00 37 02 00 00");  // to the first
  bring(0x581, "4B 41 60 00 37 02 00 00");  // to the second
  EXPECT_EQ(replies.size(), 1u);
  EXPECT_THAT(notices, IsEmpty());
  bring(0x581, "4B 41 60 00 37 02 00 00");  // one too many
  EXPECT_THAT(kinds(), ElementsAre(bus::Notice::Kind::twin));
}

TEST_F(SdoExchange, a_twin_is_told_once_in_ten_seconds) {
  const auto doubled = [&] {
    wire->send(read_of(0x6041));
    bring(0x581, "4B 41 60 00 37 02 00 00");
    bring(0x581, "4B 41 60 00 37 02 00 00");
  };
  doubled();
  doubled();
  EXPECT_EQ(notices.size(), 1u);
  runtime.advance_by(10s);
  doubled();
  EXPECT_EQ(notices.size(), 2u);
}

}  // namespace
}  // namespace axisgate::test
