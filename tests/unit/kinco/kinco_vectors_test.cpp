// SPDX-License-Identifier: Apache-2.0
// Every RS232 frame of both Kinco manuals, forth and back, cut at every byte and glued to its neighbours.
#include "adapters/kinco/kinco_receiver.hpp"
#include "tests/unit/bus/sheet_vectors.hpp"
#include "tests/unit/kinco/kinco_frames.hpp"

namespace axisgate::kinco {
namespace {

using namespace test;

template <typename Which>
std::vector<SheetVector> vectors_that(Which which) {
  return sheet_vectors({"kinco-jd", "kinco-md"},
                       [&](const SheetVector& v) { return v.protocol() == "kinco-rs232" && which(v); });
}
bool sum_is_good(const SheetVector& v) { return v.row.at("checksum_ok"); }
bool is_frame(const SheetVector& v) { return sum_is_good(v) && v.printed.size() == kFrameSize; }
bool is_sent(const SheetVector& v) { return is_frame(v) && is_request(static_cast<Command>(v.printed[1])); }
bool is_reply(const SheetVector& v) { return is_frame(v) && !is_sent(v); }

/// All frames in a row of bytes, as a receiver that awaits nothing hears them.
std::vector<Frame> frames_in(const ByteRow& bytes) {
  std::vector<Frame> frames;
  Receiver receiver;
  for (const Byte byte : bytes) {
    if (receiver.take(byte) != Receiver::Heard::nothing) frames.push_back(receiver.frame());
  }
  return frames;
}

class KincoFrame : public testing::TestWithParam<SheetVector> {};
class KincoRequest : public testing::TestWithParam<SheetVector> {};
class KincoReply : public testing::TestWithParam<SheetVector> {};

TEST_P(KincoFrame, says_what_the_sheet_says_and_encodes_to_the_same_bytes_and_no_less_than_all_of_it_is_a_frame) {
  const SheetVector& vector = GetParam();
  const Decoded decoded = decode(vector.printed);
  ASSERT_TRUE(std::holds_alternative<Frame>(decoded));
  const Frame& frame = std::get<Frame>(decoded);
  EXPECT_EQ(frame.node, vector.value("station"));
  EXPECT_EQ(static_cast<std::uint32_t>(frame.command), vector.value("command"));
  EXPECT_EQ(frame.object.index, vector.value("index"));
  EXPECT_EQ(frame.object.sub, vector.value("sub"));
  EXPECT_EQ(row(encode(frame)), vector.printed);
  const auto result = result_of(frame);
  if (vector.decoded().contains("value")) {
    EXPECT_EQ(result.fields.empty() ? frame.data : result.fields[0].raw, vector.value("value"));
  }
  if (vector.decoded().contains("error_code")) {
    EXPECT_EQ(result, refusal_of(vector.value("error_code")));
  }
  for (std::size_t size = 0; size < kFrameSize; ++size) {
    EXPECT_EQ(decode(Bytes(vector.printed).first(size)), Decoded(NeedMore{})) << size << " bytes";
  }
}

TEST_P(KincoRequest, is_built_byte_for_byte_from_its_exchange) {
  const SheetVector& vector = GetParam();
  const bool is_read = vector.says("op") == "read";
  const bus::Exchange exchange{
      .node = static_cast<std::uint8_t>(vector.value("station")),
      .access = is_read ? bus::Access::read : bus::Access::write,
      .object = {static_cast<std::uint16_t>(vector.value("index")), static_cast<std::uint8_t>(vector.value("sub"))},
      .size = static_cast<std::uint8_t>(is_read ? 0U : vector.value("size")),
      .raw = is_read ? 0U : vector.value("value")};
  EXPECT_EQ(row(encode(request_of(exchange))), vector.printed);
}

TEST_P(KincoReply, is_heard_however_it_is_cut_with_and_without_echo) {
  const Frame frame = std::get<Frame>(decode(GetParam().printed));
  bus::Exchange exchange = read_of(frame.object.index, frame.object.sub, 0, frame.node);
  if (frame.command == Command::written) {
    exchange.access = bus::Access::write;
    exchange.size = 2;
  }
  for (const bool echoed : {false, true}) {
    const ByteRow stream = (echoed ? row(encode(request_of(exchange))) : ByteRow{}) + GetParam().printed;
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

INSTANTIATE_TEST_SUITE_P(Sheets, KincoFrame, testing::ValuesIn(vectors_that(is_frame)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoRequest, testing::ValuesIn(vectors_that(is_sent)), vector_name);
INSTANTIATE_TEST_SUITE_P(Sheets, KincoReply, testing::ValuesIn(vectors_that(is_reply)), vector_name);

TEST(KincoVectors, printed_streams_fall_into_the_frames_that_the_sheet_names) {
  const auto streams = vectors_that([](const SheetVector& v) { return v.decoded().contains("frames"); });
  ASSERT_FALSE(streams.empty());
  for (const SheetVector& vector : streams) {
    std::vector<ByteRow> expected, found;
    for (const auto& hex : vector.decoded().at("frames")) expected.push_back(from_hex(hex.get<std::string>()));
    for (const Frame& frame : frames_in(vector.printed)) found.push_back(row(encode(frame)));
    EXPECT_EQ(found, expected) << vector.name;
  }
}

TEST(KincoVectors, a_frame_printed_with_a_wrong_sum_is_none) {
  const auto misprints = vectors_that([](const SheetVector& v) { return !sum_is_good(v); });
  ASSERT_FALSE(misprints.empty());
  for (const SheetVector& vector : misprints) {
    EXPECT_FALSE(std::holds_alternative<Frame>(decode(vector.printed))) << vector.name;
    EXPECT_TRUE(frames_in(vector.printed).empty()) << vector.name;
  }
}

TEST(KincoVectors, all_good_frames_of_both_sheets_glued_together_are_found_in_order) {
  ByteRow glued;
  std::vector<Frame> expected;
  for (const SheetVector& vector : vectors_that(sum_is_good)) {
    for (std::size_t at = 0; at < vector.printed.size(); at += kFrameSize) {
      expected.push_back(std::get<Frame>(decode(Bytes(vector.printed).subspan(at))));
    }
    glued = glued + vector.printed;
  }
  EXPECT_GT(expected.size(), 60u);
  EXPECT_EQ(frames_in(glued), expected);
}

}  // namespace
}  // namespace axisgate::kinco
