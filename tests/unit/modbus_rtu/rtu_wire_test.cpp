// SPDX-License-Identifier: Apache-2.0
// Modbus RTU's wire. What it shares with others is in tests/unit/bus/wire_rules_test.cpp.
#include "adapters/modbus_rtu/rtu_wire.hpp"

#include "tests/unit/bus/scripted_links.hpp"
#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kStatus = "01 03 02 C0 37";
const bus::ExchangeResult kStatusValue = value_of(0x3200, 2, 0xC037);
const bus::Exchange kStopAll = write_of(323, 6, 2, 255);

class RtuWireTest : public WireStage {
 protected:
  RtuWireTest() {
    auto made = std::make_unique<ScriptedRtuLink>();
    link = made.get();
    wire = std::make_unique<modbus_rtu::RtuWire>(
        "lift", std::vector{kinco_node(1), stepper_node(2), modbus_rtu::RtuNode{.node = 3, .worst_reply = 1s}},
        modbus_rtu::LineSpeed{.baud = 19200, .parity_bits = 0}, std::move(made), runtime, log);
    wire->start(*this);
    link->events->on_link_up();
    forget();
  }
  /// On which the copy of a write is its answer: one read was answered without a copy before it.
  void line_without_echo() {
    runtime.advance_by(1s);
    wire->send(read_of(0x3200, 2, 3));
    runtime.advance_by(12ms);
    link->bring("03 03 02 00 00");
    runtime.advance_by(1s);
    forget();
  }
  [[nodiscard]] std::uint32_t late() const { return wire->statistics().late_replies; }
  ScriptedRtuLink* link = nullptr;
};

TEST_F(RtuWireTest, each_drive_has_its_own_word_order_and_error_functions) {
  wire->send(read_of(0x3700, 4, 1));
  EXPECT_THAT(link->sent, ElementsAre("01 03 37 00 00 02"));
  link->bring("01 03 04 00 01 00 02");
  wire->send(read_of(0x3700, 4, 3));
  link->bring("03 03 04 00 01 00 02");
  wire->send(write_of(0x3100, 0x0F, 2));
  link->bring("01 86 06");
  wire->send(read_of(0x3700, 4, 1));
  link->bring("01 81 02");
  wire->send(read_of(0x3700, 4, 3));
  link->bring("03 81 02");
  EXPECT_THAT(replies, ElementsAre(value_of(0x3700, 4, 0x00020001), value_of(0x3700, 4, 0x00010002),
                                   refusal_of(6, true), refusal_of(2)))
      << "0x81 is no answer of the third drive";
}

TEST_F(RtuWireTest, a_request_given_up_shall_not_leave_and_what_was_heard_before_the_next_does_not_answer_that) {
  wire->send(read_of(0x3200));
  const auto before = link->newest;
  wire->abandon();
  EXPECT_THAT(link->withdrawn, ElementsAre(before));
  wire->send(read_of(0x3200));
  link->bring(before, kStatus);
  EXPECT_THAT(replies, IsEmpty()) << "all of it fits, but for its time";
  EXPECT_EQ(late(), 1u);
  runtime.advance_by(12ms);
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(kStatusValue));
}

TEST_F(RtuWireTest, an_answer_that_is_said_twice_does_not_answer_the_next_request) {
  wire->send(read_of(0x3200));
  runtime.advance_by(12ms);
  link->bring(kStatus);
  wire->send(read_of(0x3200));
  runtime.advance_by(4ms);  // as long as the answer alone takes
  link->bring(kStatus);
  EXPECT_THAT(replies, SizeIs(1)) << "the request has not even reached the drive";
  EXPECT_EQ(late(), 1u);
  runtime.advance_by(8ms);
  link->bring("01 03 02 C0 38");
  EXPECT_THAT(replies, ElementsAre(kStatusValue, value_of(0x3200, 2, 0xC038)));
  wire->send(read_of(0x3200));
  runtime.advance_by(12ms);
  link->bring("01 03 02 C0 38");
  EXPECT_THAT(replies, SizeIs(3)) << "in its time the same value is an answer";
}

// Nothing in the frame tells which register it speaks of: whatever the next one asks for, the copy would be its value.
TEST_F(RtuWireTest, an_answer_that_is_said_twice_is_no_value_of_the_next_register_whenever_it_comes_too_soon) {
  for (int gap = 0; gap <= 7; ++gap) {
    wire->send(read_of(0x3200));
    runtime.advance_by(12ms);
    link->bring(kStatus);
    wire->send(read_of(0x3300));
    runtime.advance_by(std::chrono::milliseconds(gap));
    link->bring(kStatus);
    EXPECT_EQ(late(), static_cast<unsigned>(gap) + 1) << gap << " ms after its request";
    runtime.advance_by(12ms);
    link->bring("01 03 02 C0 38");
    EXPECT_EQ(replies.back(), value_of(0x3300, 2, 0xC038)) << gap << " ms after its request";
  }
}

TEST_F(RtuWireTest, an_early_answer_that_may_be_owed_from_before_does_not_end_the_watch_for_answers_said_twice) {
  line_without_echo();
  const std::string acknowledged = "01 06 31 00 00 0F";
  wire->send(write_of(0x3100, 0x0F, 2, 1));
  runtime.advance_by(220ms);
  wire->abandon();
  wire->send(write_of(0x3100, 0x0F, 2, 1));
  runtime.advance_by(1ms);
  link->bring(acknowledged);
  EXPECT_THAT(replies, SizeIs(1)) << "the acknowledgement of the first try";
  wire->send(read_of(0x3200));
  runtime.advance_by(12ms);
  link->bring(kStatus);
  wire->send(read_of(0x3300));
  runtime.advance_by(4ms);
  link->bring(kStatus);
  EXPECT_THAT(replies, SizeIs(2));
  EXPECT_EQ(late(), 1u);
}

// Between the two, a neighbour has answered.
TEST_F(RtuWireTest, an_answer_that_nobody_waited_for_is_not_the_answer_to_the_next_request_when_it_is_said_again) {
  const std::string owed = "01 03 04 E2 6E 00 00";
  wire->send(read_of(0x3700, 4, 3));
  runtime.advance_by(5ms);
  link->bring(owed);
  EXPECT_EQ(late(), 1u);
  runtime.advance_by(12ms);
  link->bring("03 03 04 00 00 00 00");
  wire->send(read_of(0x3700, 4, 1));
  runtime.advance_by(1ms);
  link->bring(owed);
  EXPECT_THAT(replies, SizeIs(1)) << "the request has not even reached the drive";
  EXPECT_EQ(late(), 2u);
  runtime.advance_by(16ms);
  link->bring("01 03 04 E3 00 00 00");
  EXPECT_THAT(replies, SizeIs(2));
}

TEST_F(RtuWireTest, a_drive_that_may_take_long_may_owe_an_answer_for_as_much_longer) {
  line_without_echo();
  wire->send(write_of(0x3100, 0x0F, 2, 3));
  wire->abandon();
  runtime.advance_by(3s);
  wire->send(write_of(0x3100, 0x0F, 2, 3));
  runtime.advance_by(1ms);
  link->bring("03 06 31 00 00 0F");
  wire->send(read_of(0x3200, 2, 3));
  runtime.advance_by(12ms);
  link->bring("03 03 02 C0 37");
  wire->send(read_of(0x3300, 2, 3));
  runtime.advance_by(4ms);
  link->bring("03 03 02 C0 37");
  EXPECT_THAT(replies, SizeIs(2));
  EXPECT_EQ(late(), 1u);
}

TEST_F(RtuWireTest, a_line_without_a_rate_of_its_own_is_believed_at_once_after_a_request_given_up_too) {
  wire->send(read_of(0x3200));
  wire->abandon();
  for (int i = 0; i < 3; ++i) {
    wire->send(read_of(0x3200));
    link->bring(kStatus);
  }
  EXPECT_THAT(replies, ElementsAre(kStatusValue, kStatusValue, kStatusValue));
}

TEST_F(RtuWireTest, a_frame_that_does_not_fit_is_counted_and_the_answer_still_awaited) {
  wire->send(read_of(0x3200));
  link->bring("02 03 02 00 01");        // another drive
  link->bring("01 06 31 00 00 0F");     // another function
  link->bring("01 03 04 00 01 00 02");  // another length
  EXPECT_EQ(late(), 3u);
  link->bring("63 03 02 00 01");  // no drive of this line
  link->bring("01 2B 0E");        // nothing we ever ask for
  link->bring("01 03 04 00 01");  // a length that contradicts itself
  EXPECT_EQ(wire->statistics().bad_frames, 3u);
  EXPECT_EQ(late(), 3u);
  EXPECT_THAT(replies, IsEmpty());
  link->bring(kStatus);
  EXPECT_THAT(replies, ElementsAre(kStatusValue));
}

TEST_F(RtuWireTest, a_call_to_all_ends_when_it_has_left_and_no_drive_that_answers_it_is_believed) {
  wire->send(kStopAll);
  EXPECT_THAT(link->sent, ElementsAre("FF 06 01 43 00 06"));
  link->bring("FF 06 01 43 00 06");
  link->bring("02 06 01 43 00 06");
  EXPECT_EQ(late(), 1u);
  EXPECT_EQ(wire->statistics().echoes, 1u) << "nobody answers it: its copy is its echo";
  const Duration leaving = modbus_rtu::wire_time(19200, 0, 8, 0) + modbus_rtu::gap_time(19200);
  runtime.advance_by(leaving - 1ns);
  EXPECT_THAT(replies, IsEmpty());
  runtime.advance_by(1ns);
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
  runtime.advance_by(1h);
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(RtuWireTest, unit_0_is_all_drives_as_well_and_told_in_the_word_order_of_a_drive_of_the_line) {
  wire->send(write_of(0x6F00, 0x00085555, 4, 0));
  EXPECT_THAT(link->sent, ElementsAre("00 10 6F 00 00 02 04 55 55 00 08"));
  runtime.advance_by(1s);
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(RtuWireTest, a_call_to_all_that_was_given_up_or_lost_ends_neither_itself_nor_the_next_exchange) {
  wire->send(kStopAll);
  wire->abandon();
  runtime.advance_by(1s);
  wire->send(kStopAll);
  link->events->on_link_down("/dev/ttyUSB0: hung up");
  runtime.advance_by(1s);
  link->events->on_link_up();
  runtime.advance_by(1s);
  wire->send(kStopAll);
  wire->abandon();
  wire->send(read_of(0x3200));
  runtime.advance_by(1s);
  wire->abandon();
  wire->send(kStopAll);
  wire.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(replies, IsEmpty());
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

}  // namespace
}  // namespace axisgate::test
