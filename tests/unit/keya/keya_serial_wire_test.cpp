// Exchanges on Keya's serial lines: one reply each, none that belongs to another.
#include "adapters/keya/keya_fields.hpp"
#include "tests/unit/keya/keya_serial_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Kind = bus::Notice::Kind;

using KeyaSerialWireTest = KeyaSerialStage;

TEST_F(KeyaSerialWireTest, one_query_brings_the_fields_of_both_motors_at_the_same_bytes_on_both_lines) {
  wire->send(speeds_of());
  EXPECT_THAT(link->sent, ElementsAre("ED 01 02 00 00 00 00 00 00 00 00 F0"));
  bring(kSpeed485);
  begin(KeyaLine::rs232);
  wire->send(speeds_of());
  EXPECT_THAT(link->sent, ElementsAre("ED 02 00 00 00 00 00 00 00 00 00 00"));
  bus.replies = {kSpeeds};
  bring(kSpeed232);
  EXPECT_THAT(bus.replies, ElementsAre(kSpeeds, kSpeeds));
}

TEST_F(KeyaSerialWireTest, a_read_of_no_width_brings_the_first_four_bytes) {
  wire->send(read_of(0x2109));
  bring("ED 01 09 01 34 89 99 00 00 00 00 4E");
  EXPECT_THAT(bus.replies, ElementsAre(value_of(0x2109, 0, 4, 20220313)));
}

TEST_F(KeyaSerialWireTest, another_drives_answer_and_another_queries_answer_are_counted_and_not_taken) {
  wire->send(speeds_of(2));
  bring(kSpeed485);
  bring("ED 02 07 08 01 00 01 00 00 00 00 00");
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 2u);
  bring("ED 02 02 01 F5 FE 0E 00 00 00 00 F3");
  EXPECT_EQ(bus.replies.size(), 1u);
}

TEST_F(KeyaSerialWireTest, an_answer_with_a_wrong_sum_is_skipped_and_counted) {
  wire->send(speeds_of());
  bring("ED 01 02 01 F5 FE 0E 00 00 00 00 F3");
  runtime.advance_by(1s);
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().dropped_bytes, 12u);
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
}

TEST_F(KeyaSerialWireTest, a_late_reply_does_not_answer_the_next_request) {
  wire->send(speeds_of());
  wire->abandon();
  wire->send(read_of(0x2105, 0, 0, 1));
  bring(kSpeed485);
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  bring(kVoltage485);
  EXPECT_THAT(bus.replies, ElementsAre(value_of(0x2105, 0, 1, 49)));
}

TEST_F(KeyaSerialWireTest, two_requests_in_a_row_get_their_answers_and_what_came_before_a_request_is_not_one) {
  bus.then_send = [this] {
    bus.then_send = nullptr;
    wire->send(speeds_of());
  };
  wire->send(speeds_of());
  link->bring(from_hex(kSpeed485) + from_hex(kSpeed485));
  EXPECT_EQ(bus.replies.size(), 1u) << "the second came before its request was sent";
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  bring(kSpeed485);
  EXPECT_EQ(bus.replies.size(), 2u);
}

TEST_F(KeyaSerialWireTest, an_answer_that_began_before_the_request_is_late) {
  link->bring(Bytes(from_hex(kSpeed485)).first(5));
  wire->send(speeds_of());
  link->bring(Bytes(from_hex(kSpeed485)).subspan(5));
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(KeyaSerialWireTest, after_a_frame_that_was_cut_off_the_next_one_is_found) {
  for (std::size_t cut = 1; cut < 12; ++cut) {
    for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
      begin(line);
      const ByteRow answer = from_hex(line == KeyaLine::rs232 ? kSpeed232 : kSpeed485);
      wire->send(speeds_of());
      link->bring(Bytes(answer).first(cut));
      runtime.advance_by(keya::kInterByteTimeout);
      EXPECT_EQ(wire->statistics().dropped_bytes, cut);
      EXPECT_EQ(wire->statistics().bad_frames, 1u);
      link->bring(answer);
      EXPECT_THAT(bus.replies, ElementsAre(kSpeeds)) << "cut at " << cut;
    }
  }
}

TEST_F(KeyaSerialWireTest, a_frame_whose_bytes_keep_coming_is_waited_for) {
  wire->send(speeds_of());
  for (const Byte byte : from_hex(kSpeed485)) {
    runtime.advance_by(keya::kInterByteTimeout - 1ms);
    link->bring(Bytes(&byte, 1));
  }
  EXPECT_THAT(bus.replies, ElementsAre(kSpeeds));
}

TEST_F(KeyaSerialWireTest, a_link_lost_within_a_frame_takes_frame_and_exchange_along) {
  for (std::size_t cut = 1; cut < 12; ++cut) {
    begin(KeyaLine::rs232);
    wire->send(speeds_of());
    link->bring(Bytes(from_hex(kSpeed232)).first(cut));
    link->events->on_link_down("/dev/ttyUSB0: hung up");
    link->events->on_link_up();
    link->bring(Bytes(from_hex(kSpeed232)).subspan(cut));
    runtime.advance_by(1s);
    bring(kSpeed232);
    EXPECT_THAT(bus.told, ElementsAre("down: /dev/ttyUSB0: hung up", "up")) << cut;
    EXPECT_EQ(wire->statistics().reconnects, 1u);
  }
}

// --- Control frames -------------------------------------------------------------------------------------------------

TEST_F(KeyaSerialWireTest, a_control_frame_carries_the_whole_state_of_both_motors_in_any_order_of_fields) {
  wire->send(control_of(true, false, -1000, 30000));
  EXPECT_THAT(link->sent, ElementsAre("E0 01 01 FF FF FC 18 00 00 75 30 99"));
  begin(KeyaLine::rs232);
  wire->send(control_of(false, true, 50000, -6000));
  EXPECT_THAT(link->sent, ElementsAre("E0 02 00 00 00 00 C3 50 FF FF E8 90"));
}

TEST_F(KeyaSerialWireTest, a_control_frame_ends_ok_when_its_last_byte_has_left_and_not_before) {
  for (const auto& [baud, on_wire] :
       std::vector<std::pair<std::uint32_t, Duration>>{{115200, 1041666ns}, {19200, 6250us}, {9600, 12500us}}) {
    begin(KeyaLine::rs485, baud);
    wire->send(control_of(true, true, 0, 0));
    runtime.advance_by(on_wire - 1ns);
    EXPECT_THAT(bus.replies, IsEmpty());
    runtime.advance_by(1ns);
    EXPECT_THAT(bus.replies, ElementsAre(bus::ExchangeResult{})) << baud;
  }
}

TEST_F(KeyaSerialWireTest, a_control_frame_given_up_or_cut_off_with_the_link_ends_nothing) {
  wire->send(control_of(true, true, 0, 0));
  wire->abandon();
  runtime.advance_by(1s);
  wire->send(control_of(true, true, 0, 0));
  link->events->on_link_down("gone");
  runtime.advance_by(1s);
  EXPECT_THAT(bus.replies, IsEmpty());
}

TEST_F(KeyaSerialWireTest, the_next_request_may_go_out_when_a_control_frame_has_left) {
  bus.then_send = [this] {
    bus.then_send = nullptr;
    wire->send(speeds_of());
  };
  wire->send(control_of(true, true, 0, 0));
  runtime.advance_by(2ms);
  bring(kSpeed485);
  EXPECT_THAT(bus.replies, ElementsAre(bus::ExchangeResult{}, kSpeeds));
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
  const std::vector<std::pair<bus::Exchange, std::uint32_t>> cases{
      {three_fields, keya::kUnsupportedAccess},
      {one_twice, keya::kUnsupportedAccess},
      {write_of(0x2000, 1, 5), keya::kUnsupportedAccess},
      {write_of(0x2102, 0, 5), keya::kNoObject},
      {neither_on_nor_off, keya::kWrongValue},
      {narrow, keya::kWrongLength},
      {read_of(0x210A), keya::kNoObject},
      {read_of(0x20FF), keya::kNoObject},
      {read_of(0x2102, 1), keya::kNoObject},
      {read_of(0x2102, 0, 7, 2), keya::kWrongLength},
  };
  for (const auto& [exchange, code] : cases) {
    bus.replies.clear();
    wire->send(exchange);
    EXPECT_THAT(bus.replies, IsEmpty()) << "never from inside send()";
    runtime.run_due();
    EXPECT_THAT(bus.replies, ElementsAre(refusal_with(code)));
  }
  EXPECT_THAT(link->sent, IsEmpty());
}

TEST_F(KeyaSerialWireTest, rs232_carries_two_data_bytes_more_than_rs485) {
  begin(KeyaLine::rs232);
  wire->send(read_of(0x2102, 0, 8, 2));
  EXPECT_THAT(link->sent, SizeIs(1));
}

// --- Heartbeats, echoes, other masters ------------------------------------------------------------------------------

TEST_F(KeyaSerialWireTest, the_first_heartbeat_says_that_the_drive_is_there_and_so_does_one_after_a_silence) {
  begin(KeyaLine::rs232);
  for (int i = 0; i < 5; ++i, runtime.advance_by(1s)) bring(kBeat232);
  EXPECT_THAT(bus.kinds(), ElementsAre(Kind::present));
  EXPECT_EQ(bus.notices[0].node, keya::kRs232Node);
  EXPECT_EQ(bus.notices[0].state, bus::NodeState::operational);
  runtime.advance_by(keya::kSerialHeartbeatSilence);
  bring(kBeat232);
  link->events->on_link_down("pulled");
  link->events->on_link_up();
  bring(kBeat232);
  EXPECT_THAT(bus.kinds(), ElementsAre(Kind::present, Kind::present, Kind::present));
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
}

TEST_F(KeyaSerialWireTest, a_heartbeat_of_another_sum_is_accepted_and_counted) {
  begin(KeyaLine::rs232);
  bring("EE 01 F4 08 01 22 31 02 58 00 00 9A");
  EXPECT_THAT(bus.kinds(), ElementsAre(Kind::present));
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
  EXPECT_EQ(wire->statistics().dropped_bytes, 0u);
}

TEST_F(KeyaSerialWireTest, rs485_knows_no_heartbeat) {
  bring(kBeat232);
  runtime.advance_by(1s);
  EXPECT_THAT(bus.notices, IsEmpty());
  EXPECT_EQ(wire->statistics().dropped_bytes, 12u);
}

TEST_F(KeyaSerialWireTest, heartbeats_without_an_answer_are_no_noise) {
  begin(KeyaLine::rs232);
  for (int i = 0; i < 1000; ++i, runtime.advance_by(1ms)) bring(kBeat232);
  EXPECT_THAT(link->reopened, IsEmpty());
}

TEST_F(KeyaSerialWireTest, a_line_that_echoes_and_has_no_drive_answers_nothing_whatever_is_asked) {
  for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
    begin(line);
    for (int round = 0; round < 3; ++round) {
      for (int code = 1; code <= keya::kQueries; ++code) {
        wire->send(read_of(static_cast<std::uint16_t>(keya::kQueryIndex + code % keya::kQueries)));
        bring(link->sent.back());
        wire->abandon();
      }
    }
    EXPECT_THAT(bus.replies, IsEmpty()) << "a looped cable is no drive that stands still";
  }
}

TEST_F(KeyaSerialWireTest, behind_its_echo_an_answer_of_zeros_is_heard) {
  for (const std::uint16_t index : std::vector<std::uint16_t>{0x2105, 0x2102, 0x2107, 0x2102}) {
    wire->send(read_of(index));
    bring(link->sent.back());
    bus.replies.clear();
    bring(index == 0x2105 ? kVoltage485 : std::string_view(link->sent.back()));
    EXPECT_EQ(bus.replies.size(), 1u) << index;
  }
}

TEST_F(KeyaSerialWireTest, without_echo_an_answer_of_zeros_is_heard_as_soon_as_the_line_is_known) {
  wire->send(speeds_of());
  bring(link->sent.back());
  EXPECT_THAT(bus.replies, IsEmpty()) << "this may be the echo";
  wire->abandon();
  wire->send(read_of(0x2105, 0, 0, 1));
  bring(kVoltage485);
  bus.replies.clear();
  wire->send(speeds_of());
  bring(link->sent.back());
  EXPECT_THAT(bus.replies, ElementsAre(pair_value(0x2102, 0, 0, 0)));
}

TEST_F(KeyaSerialWireTest, our_own_control_frame_coming_back_is_dropped_and_another_masters_is_counted) {
  wire->send(control_of(true, true, 5, 5));
  bring(link->sent.back());
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
  bring("E0 01 00 00 00 00 00 00 00 00 00 E1");
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
  EXPECT_EQ(wire->statistics().dropped_bytes, 0u);
}

// --- Noise ----------------------------------------------------------------------------------------------------------

TEST_F(KeyaSerialWireTest, a_line_that_babbles_is_opened_anew_three_times_and_then_given_up_until_it_is_quiet) {
  for (int i = 0; i < 600; ++i, runtime.advance_by(1ms)) bring("55 01");
  EXPECT_EQ(link->reopened.size(), 3u);
  EXPECT_THAT(bus.told.back(), HasSubstr("opened anew 3 times, waiting for silence"));
  runtime.advance_by(2s);
  EXPECT_EQ(bus.told.back(), "up");
  wire->send(speeds_of());
  bring(kSpeed485);
  EXPECT_EQ(bus.replies.size(), 1u);
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

TEST_F(KeyaSerialWireTest, destroyed_with_an_exchange_outstanding_it_calls_nobody) {
  wire->send(control_of(true, true, 0, 0));
  bring("ED 01");
  wire.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(bus.told, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
