// SPDX-License-Identifier: Apache-2.0
// Exchanges on Keya's serial lines. What the wire shares with others is in tests/unit/bus/wire_rules_test.cpp.
#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using Kind = bus::UnsolicitedEvent::Kind;

using KeyaSerialWireTest = KeyaSerialStage;

TEST_F(KeyaSerialWireTest, one_query_brings_the_fields_of_both_motors_at_the_same_bytes_on_both_lines) {
  wire->send(speeds_of());
  EXPECT_THAT(link->sent, ElementsAre("ED 01 02 00 00 00 00 00 00 00 00 F0"));
  bring(kSpeed485);
  EXPECT_THAT(replies, ElementsAre(kSpeeds));
  wire->send(read_of(0x2109));
  bring("ED 01 09 01 34 89 99 00 00 00 00 4E");
  EXPECT_EQ(replies.back(), value_of(0x2109, 4, 20220313)) << "no width: the first four bytes";
  begin(KeyaLine::rs232);
  wire->send(speeds_of());
  EXPECT_THAT(link->sent, ElementsAre("ED 02 00 00 00 00 00 00 00 00 00 00"));
  bring(kSpeed232);
  EXPECT_THAT(replies, ElementsAre(kSpeeds));
}

TEST_F(KeyaSerialWireTest, answers_of_others_to_others_or_with_a_wrong_sum_are_counted_and_not_taken) {
  wire->send(speeds_of(2));
  bring(kSpeed485);
  bring("ED 02 07 08 01 00 01 00 00 00 00 00");
  EXPECT_EQ(wire->statistics().late_replies, 2u);
  bring("ED 02 02 01 F5 FE 0E 00 00 00 00 F4");
  runtime.advance_by(1s);
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().dropped_bytes, 12u);
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
  bring("ED 02 02 01 F5 FE 0E 00 00 00 00 F3");
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(KeyaSerialWireTest, an_answer_that_began_before_the_request_is_late) {
  link->bring(Bytes(from_hex(kSpeed485)).first(5));
  wire->send(speeds_of());
  link->bring(Bytes(from_hex(kSpeed485)).subspan(5));
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(KeyaSerialWireTest, after_a_frame_cut_off_by_silence_or_a_loss_of_the_link_the_next_one_is_found) {
  for (std::size_t cut = 1; cut < 12; ++cut) {
    for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
      SCOPED_TRACE(cut);
      const ByteRow answer = from_hex(line == KeyaLine::rs232 ? kSpeed232 : kSpeed485);
      begin(line);
      wire->send(speeds_of());
      link->bring(Bytes(answer).first(cut));
      runtime.advance_by(keya::kInterByteTimeout);
      EXPECT_EQ(wire->statistics().dropped_bytes, cut);
      EXPECT_EQ(wire->statistics().bad_frames, 1u);
      link->bring(answer);
      EXPECT_THAT(replies, ElementsAre(kSpeeds));
      begin(line);
      wire->send(speeds_of());
      link->bring(Bytes(answer).first(cut));
      link->events->on_link_down("hung up");
      link->events->on_link_up();
      link->bring(Bytes(answer).subspan(cut));
      runtime.advance_by(1s);
      link->bring(answer);
      EXPECT_THAT(told, ElementsAre("down: hung up", "up"));
    }
  }
}

TEST_F(KeyaSerialWireTest, a_frame_whose_bytes_keep_coming_is_waited_for) {
  wire->send(speeds_of());
  for (const Byte byte : from_hex(kSpeed485)) {
    runtime.advance_by(keya::kInterByteTimeout - 1ms);
    link->bring(Bytes(&byte, 1));
  }
  EXPECT_THAT(replies, ElementsAre(kSpeeds));
}

// --- Control frames -------------------------------------------------------------------------------------------------

constexpr std::array<std::int32_t, 7> kValues{0, 1, -1, 10000, -10000, INT32_MAX, INT32_MIN};

TEST(KeyaControlFrame, says_on_off_and_value_of_both_motors_in_every_combination) {
  for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
    const bool summed = line == KeyaLine::rs485;
    for (unsigned i = 0; i < 4 * kValues.size() * kValues.size(); ++i) {
      const unsigned code = i % 4;
      const std::int32_t a = kValues.at(i / 4 % kValues.size());
      const std::int32_t b = kValues.at(i / 4 / kValues.size());
      const bus::Exchange exchange = control_of((code & 1U) != 0, (code & 2U) != 0, a, b, 5);
      ASSERT_FALSE(keya::refusal_of(line, exchange));
      ByteRow expected =
          summed ? ByteRow{0xE0, 5, static_cast<Byte>(code)} : ByteRow{0xE0, static_cast<Byte>(code), 0, 0};
      for (const std::int32_t value : {a, b}) {
        for (const int shift : {24, 16, 8, 0}) expected.push_back(static_cast<Byte>(value >> shift));
      }
      unsigned sum = 0;
      for (const Byte byte : expected) sum += byte;
      if (summed) expected.push_back(static_cast<Byte>(sum));
      EXPECT_EQ(row(keya::encode(line, keya::request_of(line, exchange))), expected);
    }
  }
}

TEST(KeyaControlFrame, on_and_off_may_have_any_width_and_only_its_bytes_count_and_nothing_answers_it) {
  bus::Exchange exchange = control_of(true, false, 7, 8);
  exchange.more[0].raw = 0xFFFFFF01;
  exchange.more[2].size = 4;
  for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
    ASSERT_FALSE(keya::refusal_of(line, exchange));
    EXPECT_EQ(keya::request_of(line, exchange), keya::request_of(line, control_of(true, false, 7, 8)));
    EXPECT_FALSE(keya::answers(line, keya::request_of(line, exchange), exchange));
    EXPECT_FALSE(keya::answers(line, {.node = 1, .code = 2}, exchange));
  }
}

TEST_F(KeyaSerialWireTest, a_control_frame_ends_ok_when_its_twelve_bytes_have_left_and_not_before) {
  for (const auto& [baud, on_wire] :
       std::vector<std::pair<std::uint32_t, Duration>>{{115200, 1041666ns}, {19200, 6250us}, {9600, 12500us}}) {
    begin(KeyaLine::rs485, baud);
    wire->send(control_of(true, false, -1000, 30000));
    EXPECT_THAT(link->sent, ElementsAre("E0 01 01 FF FF FC 18 00 00 75 30 99"));
    next = speeds_of();
    runtime.advance_by(on_wire - 1ns);
    EXPECT_THAT(replies, IsEmpty());
    runtime.advance_by(1ns);
    EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{})) << baud;
    bring(kSpeed485);
    EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}, kSpeeds)) << "the next request went out at once";
  }
}

TEST_F(KeyaSerialWireTest, a_control_frame_given_up_or_cut_off_with_the_link_or_the_wire_ends_nothing) {
  const auto control = control_of(true, true, 0, 0);
  wire->send(control);
  wire->abandon();
  runtime.advance_by(1s);
  wire->send(control);
  link->events->on_link_down("gone");
  runtime.advance_by(1s);
  link->events->on_link_up();
  wire->send(control);
  bring("ED 01");
  wire.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(KeyaSerialWireTest, what_the_protocol_cannot_say_is_refused_and_not_sent) {
  bus::Exchange three_fields = control_of(true, true, 1, 2);
  three_fields.more.pop_back();
  bus::Exchange one_twice = control_of(true, true, 1, 2);
  one_twice.more[0].object = one_twice.object;
  bus::Exchange neither_on_nor_off = control_of(true, true, 1, 2);
  neither_on_nor_off.more[0].raw = 2;
  bus::Exchange narrow = control_of(true, true, 1, 2);
  narrow.more[1].size = 2;
  expect_refusals({{three_fields, keya::kUnsupportedAccess},
                   {one_twice, keya::kUnsupportedAccess},
                   {write_of(0x2000, 1, 5), keya::kUnsupportedAccess},
                   {write_of(0x2102, 0, 5), keya::kNoObject},
                   {neither_on_nor_off, keya::kWrongValue},
                   {narrow, keya::kWrongLength},
                   {read_of(0x210A), keya::kNoObject},
                   {read_of(0x20FF), keya::kNoObject},
                   {read_of(0x2102, 1), keya::kNoObject},
                   {read_of(0x2102, 0, 7, 2), keya::kWrongLength}});
  EXPECT_THAT(link->sent, IsEmpty());
  begin(KeyaLine::rs232);
  wire->send(read_of(0x2102, 0, 8, 2));
  EXPECT_THAT(link->sent, SizeIs(1)) << "RS232 carries two data bytes more";
}

// --- Heartbeats, echoes, other masters ------------------------------------------------------------------------------

TEST_F(KeyaSerialWireTest, the_first_heartbeat_says_that_the_drive_is_there_and_so_does_one_after_a_silence_or_a_loss) {
  begin(KeyaLine::rs232);
  for (int i = 0; i < 5; ++i, runtime.advance_by(1s)) bring(kBeat232);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present));
  EXPECT_EQ(unsolicited_events[0].node, keya::kRs232Node);
  EXPECT_EQ(unsolicited_events[0].state, bus::NodeState::operational);
  runtime.advance_by(keya::kSerialHeartbeatSilence);
  bring(kBeat232);
  link->events->on_link_down("pulled");
  link->events->on_link_up();
  bring(kBeat232);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present, Kind::present, Kind::present));
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
}

TEST_F(KeyaSerialWireTest, a_heartbeat_of_another_sum_is_accepted_and_counted_and_rs485_knows_none) {
  begin(KeyaLine::rs232);
  bring("EE 01 F4 08 01 22 31 02 58 00 00 9A");
  EXPECT_THAT(kinds(), ElementsAre(Kind::present));
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
  EXPECT_EQ(wire->statistics().dropped_bytes, 0u);
  begin(KeyaLine::rs485);
  bring(kBeat232);
  runtime.advance_by(1s);
  EXPECT_THAT(unsolicited_events, IsEmpty());
  EXPECT_EQ(wire->statistics().dropped_bytes, 12u);
}

TEST_F(KeyaSerialWireTest, behind_its_echo_an_answer_of_zeros_is_heard) {
  for (const std::uint16_t index : std::vector<std::uint16_t>{0x2105, 0x2102, 0x2107, 0x2102}) {
    wire->send(read_of(index));
    bring(link->sent.back());
    replies.clear();
    bring(index == 0x2105 ? kVoltage485 : std::string_view(link->sent.back()));
    EXPECT_EQ(replies.size(), 1u) << index;
  }
}

TEST_F(KeyaSerialWireTest, without_echo_an_answer_of_zeros_is_heard_as_soon_as_the_line_is_known) {
  wire->send(speeds_of());
  bring(link->sent.back());
  EXPECT_THAT(replies, IsEmpty()) << "this may be the echo";
  wire->abandon();
  wire->send(read_of(0x2105, 0, 0, 1));
  bring(kVoltage485);
  replies.clear();
  wire->send(speeds_of());
  bring(link->sent.back());
  EXPECT_THAT(replies, ElementsAre(pair_value(0x2102, 0, 0, 0)));
}

TEST_F(KeyaSerialWireTest, our_own_control_frame_coming_back_is_dropped_and_another_masters_is_counted) {
  wire->send(control_of(true, true, 5, 5));
  bring(link->sent.back());
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
  bring("E0 01 00 00 00 00 00 00 00 00 00 E1");
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
  EXPECT_EQ(wire->statistics().dropped_bytes, 0u);
}

TEST_F(KeyaSerialWireTest, decodes_every_frame_into_the_log_when_asked) {
  wire->send(speeds_of());
  bring(kSpeed485);
  EXPECT_THAT(log_lines, IsEmpty());
  wire->set_decode(true);
  wire->send(read_of(0x2107));
  bring("FF");
  bring(kSpeed485);
  bring(kFaults485);
  EXPECT_THAT(log_lines, ElementsAre("bus belt: -> ED 01 07 00 00 00 00 00 00 00 00 F5  query faults",
                                     "bus belt: <- skipped 1 bytes",
                                     "bus belt: <- ED 01 02 01 F5 FE 0E 00 00 00 00 F2  speed: A 501, B -498  (late)",
                                     "bus belt: <- ED 01 07 08 01 00 01 00 00 00 00 FF  faults: A 0x0801, B 0x0001"));
}

}  // namespace
}  // namespace axisgate::test
