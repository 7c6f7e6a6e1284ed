// Every RS232 frame of both Kinco manuals (tests/vectors), forth and back, cut at every byte and glued to its
// neighbours.
#include <fstream>
#include <nlohmann/json.hpp>

#include "adapters/kinco/kinco_receiver.hpp"
#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using test::ByteRow;
using test::from_hex;

struct Vector {
  std::string id;
  ByteRow bytes;
  bool sum_is_good = false;
  nlohmann::json decoded;
};
void PrintTo(const Vector& vector, std::ostream* out) { *out << vector.id; }

std::uint32_t number(const nlohmann::json& value) {
  return value.is_string() ? static_cast<std::uint32_t>(std::stoul(value.get<std::string>(), nullptr, 16))
                           : value.get<std::uint32_t>();
}

std::vector<Vector> vectors() {
  std::vector<Vector> all;
  for (const char* name : {"kinco-jd", "kinco-md"}) {
    std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/tests/vectors/" + name + ".json");
    const auto sheet = nlohmann::json::parse(file);
    for (const auto& vector : sheet.at("vectors")) {
      if (vector.at("protocol") != "kinco-rs232") continue;
      all.push_back({std::string(name) + "/" + vector.at("id").get<std::string>(),
                     from_hex(vector.at("hex").get<std::string>()), vector.at("checksum_ok").get<bool>(),
                     vector.at("decoded")});
    }
  }
  return all;
}

/// All frames in a row of bytes, as a receiver that awaits nothing hears them.
std::vector<Frame> frames_in(const ByteRow& bytes) {
  std::vector<Frame> frames;
  Receiver receiver;
  for (const Byte byte : bytes) {
    if (receiver.take(byte) != Receiver::Heard::nothing) frames.push_back(receiver.frame());
  }
  return frames;
}

[[nodiscard]] bool is_well_summed_frame(const Vector& vector) {
  return vector.sum_is_good && vector.bytes.size() == kFrameSize;
}
[[nodiscard]] bool is_a_request(const Vector& vector) {
  return is_well_summed_frame(vector) && is_request(static_cast<Command>(vector.bytes[1]));
}
[[nodiscard]] bool is_a_reply(const Vector& vector) {
  return is_well_summed_frame(vector) && !is_request(static_cast<Command>(vector.bytes[1]));
}

template <typename Which>
std::vector<Vector> vectors_that(Which which) {
  auto all = vectors();
  std::erase_if(all, [&](const Vector& vector) { return !which(vector); });
  return all;
}

class KincoFrame : public testing::TestWithParam<Vector> {};
class KincoRequest : public testing::TestWithParam<Vector> {};
class KincoReply : public testing::TestWithParam<Vector> {};
class KincoStream : public testing::TestWithParam<Vector> {};
class KincoBadSum : public testing::TestWithParam<Vector> {};

TEST_P(KincoFrame, says_what_the_sheet_says_and_encodes_to_the_same_bytes) {
  const Vector& vector = GetParam();
  const Decoded decoded = decode(vector.bytes);
  ASSERT_TRUE(std::holds_alternative<Frame>(decoded));
  const Frame& frame = std::get<Frame>(decoded);
  EXPECT_EQ(frame.node, vector.decoded.at("station"));
  EXPECT_EQ(static_cast<std::uint32_t>(frame.command), number(vector.decoded.at("command")));
  EXPECT_EQ(frame.object.index, number(vector.decoded.at("index")));
  EXPECT_EQ(frame.object.sub, number(vector.decoded.at("sub")));
  EXPECT_EQ(test::row(encode(frame)), vector.bytes);
  const auto result = result_of(frame);
  if (vector.decoded.contains("value")) {
    EXPECT_EQ(result.fields.empty() ? frame.data : result.fields[0].raw, number(vector.decoded.at("value")));
  }
  if (vector.decoded.contains("error_code")) {
    EXPECT_EQ(result.detail, number(vector.decoded.at("error_code")));
  }
}

TEST_P(KincoRequest, is_built_byte_for_byte_from_its_exchange) {
  const Vector& vector = GetParam();
  const bool is_read = vector.decoded.at("op") == "read";
  const bus::Exchange exchange{.node = vector.decoded.at("station"),
                               .access = is_read ? bus::Access::read : bus::Access::write,
                               .object = {static_cast<std::uint16_t>(number(vector.decoded.at("index"))),
                                          static_cast<std::uint8_t>(number(vector.decoded.at("sub")))},
                               .size = static_cast<std::uint8_t>(is_read ? 0U : number(vector.decoded.at("size"))),
                               .raw = is_read ? 0U : number(vector.decoded.at("value"))};
  EXPECT_EQ(test::row(encode(request_of(exchange))), vector.bytes);
}

TEST_P(KincoReply, is_heard_however_it_is_cut_with_and_without_echo) {
  const Frame frame = std::get<Frame>(decode(GetParam().bytes));
  bus::Exchange exchange = test::read_of(frame.object.index, frame.object.sub, 0, frame.node);
  if (frame.command == Command::written) {
    exchange.access = bus::Access::write;
    exchange.size = 2;
  }
  for (const bool echoed : {false, true}) {
    const ByteRow echo = echoed ? test::row(encode(request_of(exchange))) : ByteRow{};
    const ByteRow stream = test::operator+(echo, GetParam().bytes);
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
      Receiver receiver;
      receiver.await(exchange);
      int answers_heard = 0;
      const auto take = [&](Bytes part) {
        for (const Byte byte : part) answers_heard += receiver.take(byte) == Receiver::Heard::answer ? 1 : 0;
      };
      take(Bytes(stream).first(cut));
      take(Bytes(stream).subspan(cut));
      EXPECT_EQ(answers_heard, 1) << "cut at " << cut;
      EXPECT_EQ(receiver.frame(), frame);
      EXPECT_EQ(receiver.echoes(), echoed ? 1u : 0u);
      EXPECT_EQ(receiver.dropped_bytes(), 0u);
    }
  }
}

TEST_P(KincoStream, falls_into_the_frames_that_the_sheet_names) {
  std::vector<ByteRow> expected;
  for (const auto& hex : GetParam().decoded.at("frames")) expected.push_back(from_hex(hex.get<std::string>()));
  std::vector<ByteRow> found;
  for (const Frame& frame : frames_in(GetParam().bytes)) found.push_back(test::row(encode(frame)));
  EXPECT_EQ(found, expected);
}

TEST_P(KincoBadSum, is_no_frame) {
  EXPECT_FALSE(std::holds_alternative<Frame>(decode(GetParam().bytes)));
  EXPECT_TRUE(frames_in(GetParam().bytes).empty());
}

std::string test_name(const testing::TestParamInfo<Vector>& info) {
  std::string name = info.param.id;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Sheets, KincoFrame, testing::ValuesIn(vectors_that(is_well_summed_frame)), test_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRequest, testing::ValuesIn(vectors_that(is_a_request)), test_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoReply, testing::ValuesIn(vectors_that(is_a_reply)), test_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoStream, testing::ValuesIn(vectors_that([](const Vector& vector) {
                           return vector.decoded.contains("frames");
                         })),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoBadSum,
                         testing::ValuesIn(vectors_that([](const Vector& vector) { return !vector.sum_is_good; })),
                         test_name);

TEST(KincoVectors, all_good_frames_of_both_sheets_glued_together_are_found_in_order) {
  ByteRow glued;
  std::vector<Frame> expected;
  for (const Vector& vector : vectors()) {
    if (!vector.sum_is_good) continue;
    for (std::size_t at = 0; at < vector.bytes.size(); at += kFrameSize) {
      expected.push_back(std::get<Frame>(decode(Bytes(vector.bytes).subspan(at))));
    }
    glued = test::operator+(glued, vector.bytes);
  }
  EXPECT_GT(expected.size(), 60u);
  EXPECT_EQ(frames_in(glued), expected);
}

}  // namespace
}  // namespace axisgate::kinco
