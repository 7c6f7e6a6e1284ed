// Every frame of Keya's own protocols in the drive sheet (tests/vectors): forth and back, cut at every byte, glued to
// heartbeats and noise.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "adapters/keya/keya_serial_receiver.hpp"
#include "gateway/core/random.hpp"
#include "tests/unit/keya/keya_can_stage.hpp"
#include "tests/unit/keya/keya_serial_stage.hpp"

namespace axisgate::test {
namespace {

using keya::SerialReceiver;
using nlohmann::json;
using Heard = SerialReceiver::Heard;

struct Vector {
  std::string id;
  std::string protocol;
  bool request = false;
  std::uint32_t can_id = 0;
  ByteRow printed;
  ByteRow bytes;  ///< corrected, where the print is wrong
  json decoded;
  [[nodiscard]] KeyaLine line() const { return protocol == "keya-rs232" ? KeyaLine::rs232 : KeyaLine::rs485; }
};
void PrintTo(const Vector& vector, std::ostream* out) { *out << vector.id; }

std::uint32_t number(const json& value) {
  return value.is_string() ? static_cast<std::uint32_t>(std::stoul(value.get<std::string>(), nullptr, 16))
                           : static_cast<std::uint32_t>(value.get<std::int64_t>());
}

std::vector<Vector> all_vectors() {
  std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/keya-kydas4860-2e.json");
  const json sheet = json::parse(file);
  std::vector<Vector> all;
  for (const json& row : sheet.at("vectors")) {
    Vector vector;
    vector.id = row.at("id");
    vector.protocol = row.at("protocol");
    vector.decoded = row.at("decoded");
    if (!vector.protocol.starts_with("keya-")) continue;
    vector.request = row.at("direction") == "request";
    if (row.contains("can_id")) vector.can_id = number(row.at("can_id"));
    const std::string hex = row.at("hex");
    vector.printed = from_hex(hex);
    vector.bytes = from_hex(row.value("hex_corrected", hex));
    all.push_back(std::move(vector));
  }
  return all;
}

template <typename Which>
std::vector<Vector> vectors_that(Which which) {
  auto all = all_vectors();
  std::erase_if(all, [&](const Vector& vector) { return !which(vector); });
  return all;
}

bool on_can(const Vector& vector) { return vector.protocol == "keya-can"; }
bool is_heartbeat(const Vector& vector) { return vector.id.find("heartbeat") != std::string::npos; }
bool is_serial_request(const Vector& vector) { return !on_can(vector) && vector.request; }
bool is_serial_answer(const Vector& vector) { return !on_can(vector) && !vector.request && !is_heartbeat(vector); }

/// The query that a serial query or answer is about: as many fields as the sheet reads out of it.
bus::Exchange query_of(const Vector& vector) {
  const auto index = static_cast<std::uint16_t>(keya::kQueryIndex + number(vector.decoded.at("code")));
  if (index == 0x2105) return read_of(index, 0, 0, 1);
  if (index == 0x2108) return pair_of(index, 0, 4);
  if (index == 0x2109 || index == 0x2100) return read_of(index);
  bus::Exchange exchange = pair_of(index);
  if (index == 0x2106) exchange.more.push_back({{index, 0, 4}, 2});
  return exchange;
}

/// The numbers that the sheet reads out of a row of bytes, against what the fields say.
void expect_number(const json& decoded, const char* name, std::int64_t value) {
  if (!decoded.contains(name) || decoded.at(name).is_null()) return;
  EXPECT_EQ(value, decoded.at(name).get<std::int64_t>()) << name;
}

// --- CAN ------------------------------------------------------------------------------------------------------------

class KeyaCanVector : public testing::TestWithParam<Vector> {};

TEST_P(KeyaCanVector, says_what_the_sheet_says_and_encodes_to_the_same_bytes) {
  const Vector& vector = GetParam();
  const auto message = keya::decode(vector.bytes);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->index, number(vector.decoded.at("index")));
  EXPECT_EQ(message->sub, number(vector.decoded.at("sub")));
  EXPECT_EQ(static_cast<std::uint32_t>(message->command), number(vector.decoded.at("cs")));
  EXPECT_EQ(row(keya::encode(*message)), vector.bytes);
}

class KeyaCanRequest : public KeyaCanStage, public testing::WithParamInterface<Vector> {};

TEST_P(KeyaCanRequest, is_built_byte_for_byte_from_its_exchange) {
  const Vector& vector = GetParam();
  const auto index = static_cast<std::uint16_t>(number(vector.decoded.at("index")));
  const std::uint8_t sub = vector.decoded.at("sub");
  wire->send(vector.decoded.contains("query") ? read_of(index, sub)
                                              : write_of(index, sub, vector.decoded.value("value", 0)));
  ASSERT_EQ(link->sent.size(), 1u);
  EXPECT_EQ(link->sent[0], keya::extended_frame(vector.can_id, vector.bytes));
}

class KeyaCanReply : public KeyaCanStage, public testing::WithParamInterface<Vector> {};

TEST_P(KeyaCanReply, answers_its_exchange_with_the_numbers_of_the_sheet) {
  const Vector& vector = GetParam();
  const auto index = static_cast<std::uint16_t>(number(vector.decoded.at("index")));
  const std::uint8_t sub = vector.decoded.at("sub");
  const bool write = keya::is_command(index);
  bus::Exchange exchange = write ? write_of(index, sub, 0) : pair_of(index, sub, index == 0x2104 ? 4 : 2);
  if (index == 0x2104) exchange.more.clear();
  wire->send(exchange);
  bring(keya::extended_frame(vector.can_id, vector.bytes));
  ASSERT_EQ(bus.replies.size(), 1u);
  EXPECT_EQ(bus.replies[0].code, Errc::ok);
  EXPECT_EQ(bus.replies[0].fields.empty(), write);
  if (write) return;
  const std::uint32_t first = bus.replies[0].fields[0].raw;
  const auto second = bus.replies[0].fields.size() > 1 ? bus.replies[0].fields[1].raw : 0;
  expect_number(vector.decoded, "fault_m1", first);
  expect_number(vector.decoded, "fault_m2", second);
  expect_number(vector.decoded, "current_m1_A", first);
  expect_number(vector.decoded, "current_m2_A", second);
  expect_number(vector.decoded, "speed_m1_rpm", static_cast<std::int16_t>(first));
  expect_number(vector.decoded, "speed_m2_rpm", static_cast<std::int16_t>(second));
  expect_number(vector.decoded, "voltage_V", second);
  expect_number(vector.decoded, "drive_temp_C", first);
  expect_number(vector.decoded, "encoder_m1", static_cast<std::int32_t>(first));
  expect_number(vector.decoded, "encoder_m2", static_cast<std::int32_t>(first));
}

TEST(KeyaCanVectors, the_heartbeat_carries_the_numbers_of_the_sheet) {
  const auto beats = vectors_that([](const Vector& vector) { return on_can(vector) && is_heartbeat(vector); });
  ASSERT_EQ(beats.size(), 1u);
  const bus::ReplyFields fields = keya::heartbeat_fields(beats[0].bytes);
  expect_number(beats[0].decoded, "angle_m1", fields[0].raw);
  expect_number(beats[0].decoded, "angle_m2", fields[1].raw);
  expect_number(beats[0].decoded, "fault_m1", fields[2].raw);
  EXPECT_EQ(fields[3].raw << 8 | fields[4].raw, number(beats[0].decoded.at("control_state")));
}

// --- Serial ---------------------------------------------------------------------------------------------------------

class KeyaSerialFrame : public testing::TestWithParam<Vector> {};
class KeyaSerialRequest : public testing::TestWithParam<Vector> {};

TEST_P(KeyaSerialFrame, is_a_frame_and_encodes_to_the_same_bytes) {
  const Vector& vector = GetParam();
  const keya::Decoded decoded = keya::decode(vector.line(), vector.bytes);
  ASSERT_TRUE(std::holds_alternative<keya::SerialFrame>(decoded));
  EXPECT_EQ(row(keya::encode(vector.line(), std::get<keya::SerialFrame>(decoded))), vector.bytes);
  for (std::size_t size = 0; size < vector.bytes.size(); ++size) {
    EXPECT_EQ(keya::decode(vector.line(), Bytes(vector.bytes).first(size)), keya::Decoded(keya::NeedMore{}));
  }
}

TEST_P(KeyaSerialRequest, is_built_byte_for_byte_from_its_exchange) {
  const Vector& vector = GetParam();
  const unsigned code = vector.decoded.value("enable_code", 0U);
  const bus::Exchange exchange =
      vector.decoded.contains("query")
          ? query_of(vector)
          : control_of((code & 1U) != 0, (code & 2U) != 0, vector.decoded.at("motor_a"), vector.decoded.at("motor_b"));
  ASSERT_FALSE(keya::refusal_of(vector.line(), exchange));
  EXPECT_EQ(row(keya::encode(vector.line(), keya::request_of(vector.line(), exchange))), vector.bytes);
}

class KeyaSerialAnswer : public KeyaSerialStage, public testing::WithParamInterface<Vector> {
 protected:
  [[nodiscard]] const ByteRow& answer() const { return GetParam().bytes; }
  void ask() {
    begin(GetParam().line());
    wire->send(query_of(GetParam()));
  }
  /// Cut into two pieces.
  void bring_cut(const ByteRow& stream, std::size_t cut) {
    link->bring(Bytes(stream).first(cut));
    link->bring(Bytes(stream).subspan(cut));
  }
  void expect_the_answer_once(std::string_view context) {
    ASSERT_EQ(bus.replies.size(), 1u) << context;
    ASSERT_EQ(bus.replies[0].code, Errc::ok);
    std::vector<std::uint32_t> raw(4);
    std::ranges::transform(bus.replies[0].fields, raw.begin(), &bus::ReplyField::raw);
    const json& decoded = GetParam().decoded;
    expect_number(decoded, "speed_a_rpm", static_cast<std::int16_t>(raw[0]));
    expect_number(decoded, "speed_b_rpm", static_cast<std::int16_t>(raw[1]));
    expect_number(decoded, "current_a_A", raw[0]);
    expect_number(decoded, "current_b_A", raw[1]);
    expect_number(decoded, "fault_a", raw[0]);
    expect_number(decoded, "fault_b", raw[1]);
    expect_number(decoded, "drive_temp_C", raw[0]);
    expect_number(decoded, "motor_a_temp_C", static_cast<std::int16_t>(raw[1]));
    expect_number(decoded, "motor_b_temp_C", static_cast<std::int16_t>(raw[2]));
    expect_number(decoded, "voltage_V", raw[0]);
    expect_number(decoded, "encoder_a", static_cast<std::int32_t>(raw[0]));
    expect_number(decoded, "encoder_b", static_cast<std::int32_t>(raw[1]));
    expect_number(decoded, "version", raw[0]);
    if (decoded.contains("control_mode")) {
      EXPECT_EQ(raw[0] >> 28, number(decoded.at("control_mode")));
      EXPECT_EQ(raw[0] >> 24 & 0xF, number(decoded.at("feedback")));
      EXPECT_EQ(raw[0] >> 20 & 0xF, number(decoded.at("work_mode")));
    }
  }
};

TEST_P(KeyaSerialAnswer, is_heard_however_it_is_cut_with_and_without_echo) {
  for (const bool echoed : {false, true}) {
    for (std::size_t cut = 0; cut <= (echoed ? 24u : 12u); ++cut) {
      ask();
      bring_cut((echoed ? from_hex(link->sent.back()) : ByteRow{}) + answer(), cut);
      expect_the_answer_once("cut at " + std::to_string(cut));
      EXPECT_EQ(wire->statistics(), bus::Statistics{});
    }
  }
}

TEST_P(KeyaSerialAnswer, is_heard_among_heartbeats_wherever_the_stream_is_cut_and_whenever_it_was_asked_for) {
  if (GetParam().line() == KeyaLine::rs485) return;  // it has none
  for (const std::string_view beat : {kBeat232, std::string_view("EE 01 F4 08 01 22 31 02 58 00 00 55")}) {
    const ByteRow stream = from_hex(beat) + answer() + from_hex(beat);
    for (std::size_t asked = 0; asked <= 12; ++asked) {
      for (std::size_t cut = asked; cut <= stream.size(); ++cut) {
        begin(KeyaLine::rs232);
        link->bring(Bytes(stream).first(asked));
        wire->send(query_of(GetParam()));
        link->bring(Bytes(stream).subspan(asked, cut - asked));
        link->bring(Bytes(stream).subspan(cut));
        expect_the_answer_once("asked at " + std::to_string(asked) + ", cut at " + std::to_string(cut));
        EXPECT_EQ(wire->statistics().dropped_bytes, 0u);
        EXPECT_EQ(bus.notices.size(), 1u);
      }
    }
  }
}

TEST_P(KeyaSerialAnswer, is_heard_behind_and_before_noise_in_random_pieces) {
  Random random(11);
  const auto noise = [&] {
    ByteRow bytes(random.below(40));
    for (Byte& byte : bytes) byte = static_cast<Byte>(random.below(0xE0));  // no start byte among them
    return bytes;
  };
  for (int i = 0; i < 100; ++i) {
    ask();
    const ByteRow stream = noise() + answer() + noise();
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t size = std::min<std::size_t>(1 + random.below(15), stream.size() - at);
      link->bring(Bytes(stream).subspan(at, size));
      at += size;
    }
    expect_the_answer_once(hex_text(stream));
    EXPECT_EQ(wire->statistics().dropped_bytes, stream.size() - answer().size());
  }
}

TEST_P(KeyaSerialAnswer, is_counted_as_late_after_its_exchange_was_given_up) {
  ask();
  wire->abandon();
  link->bring(answer());
  EXPECT_TRUE(bus.replies.empty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

std::string test_name(const testing::TestParamInfo<Vector>& info) {
  std::string name = info.param.id;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Sheet, KeyaCanVector, testing::ValuesIn(vectors_that([](const Vector& vector) {
                           return on_can(vector) && !is_heartbeat(vector);
                         })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaCanRequest, testing::ValuesIn(vectors_that([](const Vector& vector) {
                           return on_can(vector) && vector.request;
                         })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaCanReply, testing::ValuesIn(vectors_that([](const Vector& vector) {
                           return on_can(vector) && !vector.request && !is_heartbeat(vector);
                         })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaSerialFrame,
                         testing::ValuesIn(vectors_that([](const Vector& vector) { return !on_can(vector); })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaSerialRequest, testing::ValuesIn(vectors_that(is_serial_request)), test_name);
INSTANTIATE_TEST_SUITE_P(Sheet, KeyaSerialAnswer, testing::ValuesIn(vectors_that(is_serial_answer)), test_name);

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
  int misprinted = 0;
  for (const Vector& vector : all_vectors()) {
    if (on_can(vector) || vector.printed == vector.bytes) continue;
    ++misprinted;
    if (frames_in(vector.line(), vector.printed) != std::vector<ByteRow>{vector.bytes}) not_found.insert(vector.id);
  }
  EXPECT_EQ(misprinted, 17);
  EXPECT_EQ(not_found, (std::set<std::string>{"rs485-enable-a", "rs485-enable-b", "rs485-enable-both", "rs485-q-status",
                                              "rs485-r-status"}));
}

TEST(KeyaSerialVectors, all_frames_that_a_drive_or_another_master_sends_are_found_in_order_when_glued_together) {
  for (const KeyaLine line : {KeyaLine::rs232, KeyaLine::rs485}) {
    std::vector<ByteRow> expected;
    ByteRow glued;
    for (const Vector& vector : all_vectors()) {
      // On RS232 nobody else can send a control frame.
      if (on_can(vector) || vector.line() != line || (line == KeyaLine::rs232 && vector.request)) continue;
      expected.push_back(vector.bytes);
      glued = glued + vector.bytes;
    }
    EXPECT_GE(expected.size(), 9u);
    EXPECT_EQ(frames_in(line, glued), expected);
  }
}

}  // namespace
}  // namespace axisgate::test
