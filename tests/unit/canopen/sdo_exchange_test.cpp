// SPDX-License-Identifier: Apache-2.0
// Exchanges of up to four bytes: one frame each way, and one reply for each request.
#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = bus::UnsolicitedEvent::Kind;

constexpr std::string_view kStatus = "4B 41 60 00 37 02 00 00";

class SdoExchange : public CanopenWireStage {
 protected:
  /// A read of the statusword, and so many answers to it.
  void read_status(int answers = 1) {
    wire->send(read_of(0x6041));
    for (int i = 0; i < answers; ++i) bring(0x581, kStatus);
  }
};

TEST_F(SdoExchange, a_read_is_sent_to_its_node_and_its_value_reported_as_it_came) {
  struct Read {
    bus::Exchange asked;
    const char* reply;
    bus::ExchangeResult result;
  };
  const Read reads[] = {
      {read_of(0x6041, 0, 2), "4B 41 60 00 37 02 00 00", value_of(0x6041, 2, 0x0237)},
      {read_of(0x6041), "4B 41 60 00 37 02", value_of(0x6041, 2, 0x0237)},              // shorter than eight bytes
      {read_of(0x6064), "42 64 60 00 E0 B1 FF FF", value_of(0x6064, 4, 0xFFFFB1E0)},    // without a size: four bytes
      {read_of(0x6041, 0, 4), "4B 41 60 00 37 02 00 00", value_of(0x6041, 2, 0x0237)},  // of another width than asked
      {read_of(0x2000), "47 00 20 00 01 02 03 00", refusal_of(0x06070010, true)},       // three bytes fit no field
  };
  for (const Read& read : reads) {
    clear();
    wire->send(read.asked);
    ByteRow request = from_hex("40 00 00 00 00 00 00 00");
    store_le16(request, 1, read.asked.object.index);
    EXPECT_THAT(link->sent, ElementsAre(can::data_frame(0x601, request)));
    bring(0x581, read.reply);
    EXPECT_THAT(replies, ElementsAre(read.result)) << read.reply;
  }
  wire->send(long_read_of(0x2000));
  bring(0x581, "47 00 20 00 01 02 03 00");
  ASSERT_TRUE(replies.back().bytes);
  EXPECT_EQ(*replies.back().bytes, from_hex("01 02 03"));
}

TEST_F(SdoExchange, only_the_reply_that_fits_in_everything_ends_the_exchange) {
  wire->send(read_of(0x6041, 0, 2));
  bring(0x582, "4B 41 60 00 01 00 00 00");  // another node
  bring(0x581, "4B 41 61 00 02 00 00 00");  // another object
  bring(0x581, "4B 41 60 01 03 00 00 00");  // another sub-index
  bring(0x581, "60 41 60 00 04 00 00 00");  // an acknowledgement
  bring(0x581, "80 41 60 01 00 00 02 06");  // an abort of another sub-index
  bring(0x581, "03 01 00 00 00 00 00 00");  // a segment
  EXPECT_EQ(wire->statistics().late_replies, 6u);
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
  for (const char* no_reply : {"", "4B 41 60", "43 41 60 00 37 02", "E0 41 60 00 00 00 00 00"}) bring(0x581, no_reply);
  EXPECT_EQ(wire->statistics().bad_frames, 4u);
  EXPECT_THAT(replies, IsEmpty());
  bring(0x581, kStatus);
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0x0237)));
}

TEST_F(SdoExchange, a_timeout_is_told_to_the_server) {
  wire->send(read_of(0x6041));
  clear();
  wire->abandon();
  EXPECT_THAT(link->sent, ElementsAre(frame_of(0x601, "80 41 60 00 00 00 04 05")));
}

TEST_F(SdoExchange, an_object_longer_than_wanted_is_refused_and_its_transfer_ended) {
  wire->send(read_of(0x1008, 0, 4));
  bring(0x581, "41 08 10 00 09 00 00 00");
  EXPECT_EQ(link->sent.back(), frame_of(0x601, "80 08 10 00 22 00 00 08"));
  EXPECT_THAT(replies, ElementsAre(refusal_of(0x06070010, true)));
}

// --- Two devices, one number (a second reply) -----------------------------------------------------------------------

TEST_F(SdoExchange, a_second_reply_to_a_finished_request_within_two_timeouts_tells_of_two_devices) {
  read_status();
  runtime.advance_by(201ms);
  bring(0x581, kStatus);
  EXPECT_THAT(unsolicited_events, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  read_status();
  runtime.advance_by(200ms);
  bring(0x581, "80 41 60 00 00 00 02 06");
  EXPECT_THAT(kinds(), ElementsAre(Kind::duplicate_node));
  EXPECT_EQ(unsolicited_events[0].node, 1);
  EXPECT_EQ(replies.size(), 2u);
}

TEST_F(SdoExchange, the_reply_to_a_request_given_up_is_no_second_devices) {
  wire->send(read_of(0x6041));
  wire->abandon();
  read_status(2);  // one to the first request, one to the second
  EXPECT_EQ(replies.size(), 1u);
  EXPECT_THAT(unsolicited_events, IsEmpty());
  bring(0x581, kStatus);  // one too many
  EXPECT_THAT(kinds(), ElementsAre(Kind::duplicate_node));
}

TEST_F(SdoExchange, nor_is_the_reply_to_a_request_that_the_boot_up_has_crossed) {
  wire->send(read_of(0x6041));
  bring(0x701, "00");
  wire->abandon();
  read_status(2);
  EXPECT_EQ(replies.size(), 1u);
  EXPECT_THAT(kinds(), ElementsAre(Kind::started));
  bring(0x581, kStatus);  // one too many
  EXPECT_THAT(kinds(), ElementsAre(Kind::started, Kind::duplicate_node));
}

TEST_F(SdoExchange, two_devices_are_told_once_in_ten_seconds) {
  read_status(2);
  read_status(2);
  EXPECT_EQ(unsolicited_events.size(), 1u);
  runtime.advance_by(10s);
  read_status(2);
  EXPECT_EQ(unsolicited_events.size(), 2u);
}

}  // namespace
}  // namespace axisgate::test
