// Exchanges on the wire: one reply each, none that belongs to another.
#include "tests/unit/kinco/kinco_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using KincoWireTest = KincoWireStage;

const ByteRow kStatus = from_hex(kStatusReply);

TEST_F(KincoWireTest, sends_a_request_and_reports_its_answer) {
  wire->send(read_of(0x6041, 0, 2));
  EXPECT_THAT(link->sent, ElementsAre(kReadStatus));
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0xC037)));
}

TEST_F(KincoWireTest, reports_an_answer_that_comes_byte_by_byte_behind_its_echo) {
  wire->send(read_of(0x6041));
  for (const Byte byte : from_hex(kReadStatus) + kStatus) link->bring({byte});
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0xC037)));
}

TEST_F(KincoWireTest, an_acknowledged_write_is_ok_with_or_without_echo_of_the_data) {
  for (const char* reply : {"01 60 40 60 00 0F 00 00 00 F0", "01 60 40 60 00 00 00 00 00 FF"}) {
    wire->send(write_of(0x6040, 0x0F, 2));
    link->bring(from_hex(reply));
  }
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}, bus::ExchangeResult{}));
}

TEST_F(KincoWireTest, an_error_of_the_drive_is_reported_with_its_code) {
  wire->send(read_of(0x9999));
  link->bring(from_hex("01 80 99 99 00 00 00 02 06 45"));
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(replies[0].code, Errc::refused_by_drive);
  EXPECT_EQ(replies[0].detail, 0x06020000u);
}

TEST_F(KincoWireTest, a_width_other_than_asked_is_reported_as_it_came) {
  wire->send(read_of(0x6041, 0, 4));
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0xC037))) << "the profile's type decides what that means";
}

TEST_F(KincoWireTest, a_reply_after_abandon_is_counted_and_not_reported) {
  wire->send(read_of(0x6041));
  wire->abandon();
  link->bring(kStatus);
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(KincoWireTest, a_late_reply_does_not_answer_the_next_request) {
  wire->send(read_of(0x6041));
  wire->abandon();
  wire->send(read_of(0x6063));
  link->bring(kStatus);
  EXPECT_THAT(replies, IsEmpty());
  link->bring(from_hex("01 43 63 60 00 B0 3C FF FF 0F"));
  EXPECT_THAT(replies, ElementsAre(value_of(0x6063, 4, 0xFFFF3CB0)));
}

TEST_F(KincoWireTest, bytes_that_came_with_an_answer_cannot_answer_what_is_sent_next) {
  wire->send(read_of(0x6041));
  next = read_of(0x6041);
  link->bring(kStatus + kStatus);
  EXPECT_EQ(replies.size(), 1u) << "the second came before its request was sent";
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  link->bring(kStatus);
  EXPECT_EQ(replies.size(), 2u);
}

TEST_F(KincoWireTest, bytes_left_over_from_before_are_dropped_and_counted) {
  link->bring({1, 2, 3});
  wire->send(read_of(0x6041));
  link->bring(kStatus);
  EXPECT_EQ(replies.size(), 1u);
  EXPECT_EQ(wire->statistics().dropped_bytes, 3u);
}

TEST_F(KincoWireTest, a_lost_link_takes_the_awaited_answer_along) {
  wire->send(read_of(0x6041));
  link->events->on_link_down("/dev/ttyUSB0: hung up");
  link->events->on_link_up();
  link->bring(kStatus);
  EXPECT_THAT(told, ElementsAre("down: /dev/ttyUSB0: hung up", "up"));
  EXPECT_EQ(wire->statistics().reconnects, 1u);
}

TEST_F(KincoWireTest, decodes_every_frame_into_the_log_when_asked) {
  wire->send(read_of(0x6041));
  link->bring(kStatus);
  EXPECT_THAT(log_lines, IsEmpty());
  wire->set_decode(true);
  wire->send(write_of(0x6040, 0x0F, 2));
  link->bring(from_hex(kWriteControl) + kStatus + ByteRow{0xFF, 0xFF} + from_hex("01 60 40 60 00 0F 00 00 00 F0"));
  EXPECT_THAT(log_lines, ElementsAre("bus lift: -> 01 2B 40 60 00 0F 00 00 00 25  write 6040.00 = 0x000F",
                                     "bus lift: <- 01 2B 40 60 00 0F 00 00 00 25  write 6040.00 = 0x000F  (echo)",
                                     "bus lift: <- 01 4B 41 60 00 37 C0 00 00 1C  value 6041.00 = 0xC037  (late)",
                                     "bus lift: <- 01 60 40 60 00 0F 00 00 00 F0  written 6040.00",
                                     "bus lift: <- skipped 2 bytes"));
}

TEST_F(KincoWireTest, destroyed_with_an_exchange_outstanding_it_calls_nobody) {
  wire->send(read_of(0x6041));
  wire.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(told, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
