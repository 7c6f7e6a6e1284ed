// SPDX-License-Identifier: Apache-2.0
// Every frame of Keya's own protocols in the drive sheet: forth and back, cut at every byte, glued to heartbeats and
// noise.
#include <set>

#include "adapters/keya/keya_serial_receiver.hpp"
#include "tests/unit/bus/sheet_vectors.hpp"
#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::test {
namespace {

using keya::SerialReceiver;
using Heard = SerialReceiver::Heard;

template <typename Which>
std::vector<SheetVector> vectors_that(Which which) {
  return sheet_vectors({"keya-kydas4860-2e"},
                       [&](const SheetVector& v) { return v.protocol().starts_with("keya-") && which(v); });
}
KeyaLine line_of(const SheetVector& v) { return v.protocol() == "keya-rs232" ? KeyaLine::rs232 : KeyaLine::rs485; }
bool is_heartbeat(const SheetVector& v) { return v.name.find("heartbeat") != std::string::npos; }
bool on_can(const SheetVector& v) { return v.protocol() == "keya-can"; }
bool is_can_message(const SheetVector& v) { return on_can(v) && !is_heartbeat(v); }
bool is_can_request(const SheetVector& v) { return on_can(v) && v.request(); }
bool is_can_reply(const SheetVector& v) { return is_can_message(v) && !v.request(); }
bool is_serial(const SheetVector& v) { return !on_can(v); }
bool is_serial_request(const SheetVector& v) { return is_serial(v) && v.request(); }
bool is_serial_answer(const SheetVector& v) { return is_serial(v) && !v.request() && !is_heartbeat(v); }

std::uint16_t index_of(const SheetVector& v) { return static_cast<std::uint16_t>(v.value("index")); }
std::uint8_t sub_of(const SheetVector& v) { return static_cast<std::uint8_t>(v.value("sub")); }
can::CanFrame frame_of(const SheetVector& v) { return keya::extended_frame(number(v.row.at("can_id")), v.bytes); }

/// The query that a serial query or answer is about: as many fields as the sheet reads out of it.
bus::Exchange query_of(const SheetVector& vector) {
  const auto index = static_cast<std::uint16_t>(keya::kQueryIndex + vector.value("code"));
  if (index == 0x2105) return read_of(index, 0, 0, 1);
  if (index == 0x2108) return pair_of(index, 0, 4);
  if (index == 0x2109 || index == 0x2100) return read_of(index);
  bus::Exchange exchange = pair_of(index);
  if (index == 0x2106) exchange.more.push_back({{index, 0, 4}, 2});
  return exchange;
}

/// The fields against those of these numbers that the sheet reads out of the frame.
void expect_numbers(const SheetVector& vector, const bus::ReplyFields& fields,
                    const std::vector<std::tuple<const char*, std::size_t, bool>>& names) {
  for (const auto& [name, at, is_signed] : names) {
    if (vector.says(name).is_null()) continue;
    ASSERT_LT(at, fields.size()) << name;
    const std::uint32_t raw = fields[at].raw;
    const auto value = !is_signed             ? std::int64_t{raw}
                       : fields[at].size == 2 ? static_cast<std::int16_t>(raw)
                                              : static_cast<std::int32_t>(raw);
    EXPECT_EQ(value, vector.says(name).get<std::int64_t>()) << name;
  }
}

// --- CAN ------------------------------------------------------------------------------------------------------------

class KeyaCanVector : public testing::TestWithParam<SheetVector> {};

TEST_P(KeyaCanVector, says_what_the_sheet_says_and_encodes_to_the_same_bytes) {
  const SheetVector& vector = GetParam();
  const auto message = keya::decode(vector.bytes);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->index, vector.value("index"));
  EXPECT_EQ(message->sub, vector.value("sub"));
  EXPECT_EQ(static_cast<std::uint32_t>(message->command), vector.value("cs"));
  EXPECT_EQ(row(keya::encode(*message)), vector.bytes);
}

class KeyaCanRequest : public KeyaCanStage, public testing::WithParamInterface<SheetVector> {};

TEST_P(KeyaCanRequest, is_built_byte_for_byte_from_its_exchange) {
  const SheetVector& vector = GetParam();
  wire->send(vector.decoded().contains("query")
                 ? read_of(index_of(vector), sub_of(vector))
                 : write_of(index_of(vector), sub_of(vector), vector.decoded().value("value", 0)));
  EXPECT_THAT(link->sent, testing::ElementsAre(frame_of(vector)));
}

class KeyaCanReply : public KeyaCanStage, public testing::WithParamInterface<SheetVector> {};

TEST_P(KeyaCanReply, answers_its_exchange_with_the_numbers_of_the_sheet) {
  const SheetVector& vector = GetParam();
  const std::uint16_t index = index_of(vector);
  const bool write = keya::is_command(index);
  bus::Exchange exchange =
      write ? write_of(index, sub_of(vector), 0) : pair_of(index, sub_of(vector), index == 0x2104 ? 4 : 2);
  if (index == 0x2104) exchange.more.clear();
  wire->send(exchange);
  bring(frame_of(vector));
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(replies[0].code, Errc::ok);
  EXPECT_EQ(replies[0].fields.empty(), write);
  if (write) return;
  expect_numbers(vector, replies[0].fields,
                 {{"fault_m1", 0, false},
                  {"fault_m2", 1, false},
                  {"current_m1_A", 0, false},
                  {"current_m2_A", 1, false},
                  {"speed_m1_rpm", 0, true},
                  {"speed_m2_rpm", 1, true},
                  {"voltage_V", 1, false},
                  {"drive_temp_C", 0, false},
                  {"encoder_m1", 0, true},
                  {"encoder_m2", 0, true}});
}

TEST(KeyaCanVectors, the_heartbeat_carries_the_numbers_of_the_sheet) {
  const auto beats = vectors_that([](const SheetVector& v) { return on_can(v) && is_heartbeat(v); });
  ASSERT_EQ(beats.size(), 1u);
  const bus::ReplyFields fields = keya::heartbeat_fields(beats[0].bytes);
  expect_numbers(beats[0], fields, {{"angle_m1", 0, false}, {"angle_m2", 1, false}, {"fault_m1", 2, false}});
  EXPECT_EQ(fields[3].raw << 8 | fields[4].raw, beats[0].value("control_state"));
}

// --- Serial ---------------------------------------------------------------------------------------------------------

class KeyaSerialFrame : public testing::TestWithParam<SheetVector> {};
class KeyaSerialRequest : public testing::TestWithParam<SheetVector> {};

TEST_P(KeyaSerialFrame, is_a_frame_and_encodes_to_the_same_bytes_and_no_less_than_all_of_it_is_one) {
  const KeyaLine line = line_of(GetParam());
  const ByteRow& bytes = GetParam().bytes;
  const keya::Decoded decoded = keya::decode(line, bytes);
  ASSERT_TRUE(std::holds_alternative<keya::SerialFrame>(decoded));
  EXPECT_EQ(row(keya::encode(line, std::get<keya::SerialFrame>(decoded))), bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(keya::decode(line, Bytes(bytes).first(size)), keya::Decoded(keya::NeedMore{}));
  }
}

TEST_P(KeyaSerialRequest, is_built_byte_for_byte_from_its_exchange) {
  const SheetVector& vector = GetParam();
  const unsigned code = vector.decoded().value("enable_code", 0U);
  const bus::Exchange exchange =
      vector.decoded().contains("query")
          ? query_of(vector)
          : control_of((code & 1U) != 0, (code & 2U) != 0, vector.says("motor_a"), vector.says("motor_b"));
  ASSERT_FALSE(keya::refusal_of(line_of(vector), exchange));
  EXPECT_EQ(row(keya::encode(line_of(vector), keya::request_of(line_of(vector), exchange))), vector.bytes);
}

class KeyaSerialAnswer : public KeyaSerialStage, public testing::WithParamInterface<SheetVector> {
 protected:
  [[nodiscard]] const ByteRow& answer() const { return GetParam().bytes; }
  /// Each answer is of a line of its own, which has been heard up to byte `before` of the stream.
  void ask(const ByteRow& stream = {}, std::size_t before = 0) {
    begin(line_of(GetParam()));
    link->bring(Bytes(stream).first(before));
    wire->send(query_of(GetParam()));
  }
  void expect_the_answer_once() {
    ASSERT_EQ(replies.size(), 1u);
    ASSERT_EQ(replies[0].code, Errc::ok);
    expect_numbers(GetParam(), replies[0].fields,
                   {{"speed_a_rpm", 0, true},
                    {"speed_b_rpm", 1, true},
                    {"current_a_A", 0, false},
                    {"current_b_A", 1, false},
                    {"fault_a", 0, false},
                    {"fault_b", 1, false},
                    {"drive_temp_C", 0, false},
                    {"motor_a_temp_C", 1, true},
                    {"motor_b_temp_C", 2, true},
                    {"voltage_V", 0, false},
                    {"encoder_a", 0, true},
                    {"encoder_b", 1, true},
                    {"version", 0, false}});
    if (GetParam().decoded().contains("control_mode")) {
      const std::uint32_t raw = replies[0].fields[0].raw;
      EXPECT_EQ(raw >> 28, GetParam().value("control_mode"));
      EXPECT_EQ(raw >> 24 & 0xF, GetParam().value("feedback"));
      EXPECT_EQ(raw >> 20 & 0xF, GetParam().value("work_mode"));
    }
  }
};

TEST_P(KeyaSerialAnswer, is_heard_however_it_is_cut_with_and_without_echo) {
  for (const bool echoed : {false, true}) {
    for (std::size_t cut = 0; cut <= (echoed ? 24u : 12u); ++cut) {
      SCOPED_TRACE("cut at " + std::to_string(cut));
      ask();
      const ByteRow stream = (echoed ? from_hex(link->sent.back()) : ByteRow{}) + answer();
      link->bring(Bytes(stream).first(cut));
      link->bring(Bytes(stream).subspan(cut));
      expect_the_answer_once();
      EXPECT_EQ(wire->statistics(), bus::Statistics{.echoes = wire->statistics().echoes});
    }
  }
}

TEST_P(KeyaSerialAnswer, is_heard_among_heartbeats_wherever_the_stream_is_cut_and_whenever_it_was_asked_for) {
  if (line_of(GetParam()) == KeyaLine::rs485) return;  // it has none
  for (const std::string_view beat : {kBeat232, std::string_view("EE 01 F4 08 01 22 31 02 58 00 00 55")}) {
    const ByteRow stream = from_hex(beat) + answer() + from_hex(beat);
    for (std::size_t asked = 0; asked <= 12; ++asked) {
      for (std::size_t cut = asked; cut <= stream.size(); ++cut) {
        SCOPED_TRACE("asked at " + std::to_string(asked) + ", cut at " + std::to_string(cut));
        ask(stream, asked);
        link->bring(Bytes(stream).subspan(asked, cut - asked));
        link->bring(Bytes(stream).subspan(cut));
        expect_the_answer_once();
        EXPECT_EQ(wire->statistics().dropped_bytes, 0u);
        EXPECT_EQ(unsolicited_events.size(), 1u);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sheet, KeyaCanVector, testing::ValuesIn(vectors_that(is_can_message)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaCanRequest, testing::ValuesIn(vectors_that(is_can_request)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaCanReply, testing::ValuesIn(vectors_that(is_can_reply)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaSerialFrame, testing::ValuesIn(vectors_that(is_serial)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaSerialRequest, testing::ValuesIn(vectors_that(is_serial_request)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaSerialAnswer, testing::ValuesIn(vectors_that(is_serial_answer)), vector_name);

/// The whole frames in a row of bytes.
std::vector<ByteRow> frames_in(KeyaLine line, const ByteRow& bytes) {
  std::vector<ByteRow> frames;
  SerialReceiver receiver(line);
  for (const Byte byte : bytes) {
    if (receiver.take(byte) != Heard::nothing) frames.push_back(row(receiver.frame_bytes()));
  }
  if (receiver.on_silence() != Heard::nothing) frames.push_back(row(receiver.frame_bytes()));
  return frames;
}

// RS485: with a byte too many the sum is not at its place. RS232: the surplus byte is a 0 behind the frame, and
// skipped.
TEST(KeyaSerialVectors, of_the_misprinted_frames_those_without_a_sum_are_found_and_those_with_one_are_not) {
  std::set<std::string> not_found;
  const auto misprinted = vectors_that([](const SheetVector& v) { return is_serial(v) && v.printed != v.bytes; });
  for (const SheetVector& v : misprinted) {
    if (frames_in(line_of(v), v.printed) != std::vector<ByteRow>{v.bytes}) not_found.insert(v.row.at("id"));
  }
  EXPECT_EQ(misprinted.size(), 17u);
  EXPECT_EQ(not_found, (std::set<std::string>{"rs485-enable-a", "rs485-enable-b", "rs485-enable-both", "rs485-q-status",
                                              "rs485-r-status"}));
}

TEST(KeyaSerialVectors, all_frames_that_a_drive_or_another_master_sends_are_found_in_order_when_glued_together) {
  for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
    std::vector<ByteRow> expected;
    ByteRow glued;
    for (const SheetVector& v : vectors_that(is_serial)) {
      // On RS232 nobody else can send a control frame.
      if (line_of(v) != line || (line == KeyaLine::rs232 && v.request())) continue;
      expected.push_back(v.bytes);
      glued = glued + v.bytes;
    }
    EXPECT_GE(expected.size(), 9u);
    EXPECT_EQ(frames_in(line, glued), expected);
  }
}

}  // namespace
}  // namespace axisgate::test
