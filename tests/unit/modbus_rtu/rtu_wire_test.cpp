// Exchanges on the wire: one reply each, none that belongs to another.
#include "tests/unit/modbus_rtu/rtu_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using RtuWireTest = RtuWireStage;

constexpr const char* kReadStatus = "01 03 32 00 00 01";
constexpr const char* kStatus = "01 03 02 C0 37";
const bus::ExchangeResult kStatusValue = value_of(0x3200, 2, 0xC037);

TEST_F(RtuWireTest, sends_a_request_and_reports_its_answer) {
  wire->send(read_of(0x3200));
  EXPECT_THAT(link->sent, ElementsAre(kReadStatus));
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(kStatusValue));
}

TEST_F(RtuWireTest, each_drive_has_its_own_word_order_and_error_functions) {
  wire->send(read_of(0x3700, 4, 1));
  link->bring("01 03 04 00 01 00 02");
  wire->send(read_of(0x3700, 4, 3));
  link->bring("03 03 04 00 01 00 02");
  wire->send(read_of(0x3700, 4, 1));
  link->bring("01 81 02");
  wire->send(read_of(0x3700, 4, 3));
  link->bring("03 81 02");
  EXPECT_THAT(replies, ElementsAre(value_of(0x3700, 4, 0x00020001), value_of(0x3700, 4, 0x00010002), refused(2, false)))
      << "0x81 is no answer of the third drive";
}

TEST_F(RtuWireTest, an_error_of_the_drive_is_reported_with_its_code) {
  wire->send(write_of(0x3100, 0x0F, 2));
  link->bring("01 86 06");
  EXPECT_THAT(replies, ElementsAre(refused(6, true)));
}

TEST_F(RtuWireTest, a_second_answer_is_counted_and_not_reported) {
  wire->send(read_of(0x3200));
  link->bring(kStatus);
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(kStatusValue));
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(RtuWireTest, an_answer_after_abandon_is_counted_and_not_reported) {
  wire->send(read_of(0x3200));
  wire->abandon();
  link->bring(kStatus);
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(RtuWireTest, a_request_that_was_given_up_shall_not_leave_any_more) {
  wire->send(read_of(0x3200));
  wire->abandon();
  EXPECT_THAT(link->withdrawn, ElementsAre(link->newest));
}

TEST_F(RtuWireTest, what_was_heard_before_the_request_was_sent_does_not_answer_it) {
  wire->send(read_of(0x3200));
  const auto before = link->newest;
  wire->abandon();
  wire->send(read_of(0x3200));
  link->bring(before, kStatus);
  EXPECT_THAT(replies, IsEmpty()) << "all of it fits, but for its time";
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(kStatusValue));
}

TEST_F(RtuWireTest, a_frame_that_does_not_fit_is_counted_and_the_answer_still_awaited) {
  wire->send(read_of(0x3200));
  link->bring("02 03 02 00 01");        // another drive
  link->bring("01 06 31 00 00 0F");     // another function
  link->bring("01 03 04 00 01 00 02");  // another length
  EXPECT_EQ(wire->statistics().late_replies, 3u);
  link->bring("63 03 02 00 01");  // no drive of this line
  link->bring("01 2B 0E");        // nothing we ever ask for
  link->bring("01 03 04 00 01");  // a length that contradicts itself
  EXPECT_EQ(wire->statistics().bad_frames, 3u);
  EXPECT_EQ(wire->statistics().late_replies, 3u);
  EXPECT_THAT(replies, IsEmpty());
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(kStatusValue));
}

TEST_F(RtuWireTest, an_echo_of_another_write_is_not_its_acknowledgement) {
  wire->send(write_of(0x3100, 0x2F, 2));
  wire->abandon();
  wire->send(write_of(0x3100, 0x3F, 2));
  link->bring("01 06 31 00 00 2F");
  EXPECT_THAT(replies, IsEmpty());
  link->bring("01 06 31 00 00 3F");
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(RtuWireTest, the_bus_may_send_from_inside_a_reply) {
  wire->send(read_of(0x3200));
  next = read_of(0x3700, 4);
  link->bring(kStatus);
  link->bring("01 03 04 C3 50 00 00");
  EXPECT_THAT(replies, ElementsAre(kStatusValue, value_of(0x3700, 4, 50000)));
}

TEST_F(RtuWireTest, frames_nobody_asked_for_are_counted_and_touch_nothing) {
  for (int i = 0; i < 1000; ++i) link->bring(0, kStatus);
  EXPECT_THAT(told, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1000u);
  EXPECT_THAT(link->reopened, IsEmpty()) << "whole frames are no noise";
}

TEST_F(RtuWireTest, a_call_to_all_ends_when_it_has_left_and_is_answered_by_nobody) {
  const auto stop_all = write_of(323, 6, 2, 255);
  wire->send(stop_all);
  EXPECT_THAT(link->sent, ElementsAre("FF 06 01 43 00 06"));
  const Duration leaving = modbus_rtu::wire_time(19200, 0, 8, 0) + modbus_rtu::gap_time(19200);
  runtime.advance_by(leaving - 1ns);
  EXPECT_THAT(replies, IsEmpty());
  runtime.advance_by(1ns);
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
  runtime.advance_by(1h);
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(RtuWireTest, a_drive_that_answers_a_call_to_all_is_counted_and_not_believed) {
  wire->send(write_of(323, 6, 2, 255));
  link->bring("FF 06 01 43 00 06");
  link->bring("02 06 01 43 00 06");
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 2u);
  runtime.advance_by(1s);
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(RtuWireTest, unit_0_is_all_drives_as_well_and_told_in_the_word_order_of_a_drive_of_the_line) {
  wire->send(write_of(0x6F00, 0x00085555, 4, 0));
  EXPECT_THAT(link->sent, ElementsAre("00 10 6F 00 00 02 04 55 55 00 08"));
  runtime.advance_by(1s);
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(RtuWireTest, a_call_to_all_that_was_given_up_or_lost_ends_only_once) {
  wire->send(write_of(323, 6, 2, 255));
  wire->abandon();
  runtime.advance_by(1s);
  wire->send(write_of(323, 6, 2, 255));
  link->events->on_link_down("/dev/ttyUSB0: hung up");
  runtime.advance_by(1s);
  link->events->on_link_up();
  runtime.advance_by(1s);
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(RtuWireTest, the_end_of_one_call_to_all_does_not_end_the_next_exchange) {
  wire->send(write_of(323, 6, 2, 255));
  wire->abandon();
  wire->send(read_of(0x3200));
  runtime.advance_by(1s);
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(RtuWireTest, a_lost_link_takes_the_awaited_answer_along) {
  wire->send(read_of(0x3200));
  link->events->on_link_down("/dev/ttyUSB0: hung up");
  link->events->on_link_up();
  link->bring(kStatus);
  EXPECT_THAT(told, ElementsAre("down: /dev/ttyUSB0: hung up", "up"));
  EXPECT_EQ(wire->statistics().reconnects, 1u);
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(RtuWireTest, decodes_every_frame_into_the_log_when_asked) {
  wire->send(read_of(0x3200));
  link->bring(kStatus);
  EXPECT_THAT(log_lines, IsEmpty());
  wire->set_decode(true);
  wire->send(read_of(0x3200));
  link->bring(0, kStatus);
  link->bring("01 06 31 00 00 0F");
  link->events->on_bad_frame(1, 7);
  link->bring(kStatus);
  link->bring(kStatus);
  EXPECT_THAT(
      log_lines,
      ElementsAre("bus lift: -> 01 03 32 00 00 01  unit 1: read 1 register at 12800 (0x3200)",
                  "bus lift: <- 01 03 02 C0 37  unit 1: 1 register = 0xC037  (late)",
                  "bus lift: <- 01 06 31 00 00 0F  unit 1: written 12544 (0x3100) = 0x000F  (another function)",
                  "bus lift: <- 7 bytes that are no frame", "bus lift: <- 01 03 02 C0 37  unit 1: 1 register = 0xC037",
                  "bus lift: <- 01 03 02 C0 37  unit 1: 1 register = 0xC037  (not asked for)"));
}

TEST_F(RtuWireTest, destroyed_with_an_exchange_outstanding_it_calls_nobody) {
  wire->send(write_of(323, 6, 2, 255));
  wire.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(told, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
