// SPDX-License-Identifier: Apache-2.0
// Which bytes of a line are a frame, a copy of the request, a glitch or noise, however they are cut.
#include "adapters/modbus_rtu/frame_finder.hpp"

#include <fmt/format.h>

#include "tests/unit/modbus_rtu/rtu_frames.hpp"

namespace axisgate::modbus_rtu {
namespace {

using test::ByteRow;
using test::from_hex;
using test::with_crc;
using testing::ElementsAre;
using testing::IsEmpty;
using test::operator+;
using Kind = FrameFinder::Found::Kind;

class FrameFinderTest : public testing::Test {
 protected:
  void ask(std::string_view request) { finder.sent(with_crc(request)); }
  std::vector<std::string> found(bool patience_over = false) {
    static constexpr std::array kNames{"", "frame", "copy", "glitch", "noise"};
    std::vector<std::string> all;
    for (auto one = finder.next(patience_over); one.kind != Kind::nothing; one = finder.next(patience_over)) {
      all.push_back(fmt::format("{} {}", kNames.at(static_cast<std::size_t>(one.kind)), hex_text(one.bytes)));
    }
    return all;
  }
  /// The same, byte by byte.
  std::vector<std::string> take(const ByteRow& bytes) {
    std::vector<std::string> all;
    for (const Byte byte : bytes) {
      finder.take(ByteRow{byte});
      for (std::string& one : found()) all.push_back(std::move(one));
    }
    return all;
  }
  static std::string whole(std::string_view frame) { return hex_text(with_crc(frame)); }
  FrameFinder finder;
};

TEST_F(FrameFinderTest, the_copy_of_a_read_is_told_whole_and_its_answer_behind_it_too) {
  ask("01 03 31 00 00 02");
  EXPECT_THAT(take(with_crc("01 03 31 00 00 02") + with_crc("01 03 04 C3 50 00 00")),
              ElementsAre("copy " + whole("01 03 31 00 00 02"), "frame " + whole("01 03 04 C3 50 00 00")));
  EXPECT_FALSE(finder.unfinished());
}

TEST_F(FrameFinderTest, a_glitch_is_skipped_before_copy_and_answer_each) {
  ask("01 03 31 00 00 01");
  EXPECT_THAT(take(from_hex("00 00") + with_crc("01 03 31 00 00 01") + from_hex("FF") + with_crc("01 03 02 00 00")),
              ElementsAre("glitch 00", "glitch 00", "copy " + whole("01 03 31 00 00 01"), "glitch FF",
                          "frame " + whole("01 03 02 00 00")));
}

TEST_F(FrameFinderTest, more_than_eight_of_them_are_noise) {
  ask("01 03 31 00 00 01");
  finder.take(ByteRow(9, 0x00) + with_crc("01 03 02 00 00"));
  EXPECT_THAT(found(), ElementsAre("glitch 00 00 00 00 00 00 00 00", "frame 00 01 03 02 00 00 B8 44"))
      << "whose sum will be found wrong";
}

// The answer to a long write is the head of it but for the sum; where even that fits, only silence tells.
TEST_F(FrameFinderTest, an_answer_that_may_still_become_the_copy_of_its_write_is_waited_for) {
  const ByteRow answer = with_crc("01 10 6F 00 00 02");
  ByteRow request = answer + from_hex("00 01 02");
  finder.sent(request);
  EXPECT_THAT(take(answer), IsEmpty()) << "an echo must not acknowledge a write";
  EXPECT_THAT(found(true), ElementsAre("frame " + hex_text(answer)));
  finder.sent(request);
  EXPECT_THAT(take(request), ElementsAre("copy " + hex_text(request)));
}

TEST_F(FrameFinderTest, a_call_to_all_that_comes_back_is_a_copy_and_no_glitch) {
  ask("FF 06 01 43 00 06");
  EXPECT_THAT(take(with_crc("FF 06 01 43 00 06")), ElementsAre("copy " + whole("FF 06 01 43 00 06")));
}

TEST_F(FrameFinderTest, what_is_no_whole_frame_when_the_patience_is_over_is_noise_to_the_last) {
  ask("01 03 31 00 00 02");
  EXPECT_THAT(take(from_hex("01 03 31 00")), IsEmpty());
  EXPECT_THAT(found(true), ElementsAre("noise 01 03 31 00"));
  EXPECT_FALSE(finder.unfinished());
}

TEST_F(FrameFinderTest, a_stream_of_anything_is_told_to_the_last_byte_and_leaves_room) {
  std::uint32_t random = 7;
  ask("01 03 31 00 00 02");
  std::size_t given = 0, told = 0;
  for (int i = 0; i < 20000; ++i) {
    random = random * 1664525 + 1013904223;
    ASSERT_GT(finder.room(), 0u);
    finder.take(ByteRow{static_cast<Byte>(random >> 24)});
    ++given;
    for (auto one = finder.next(i % 37 == 0); one.kind != Kind::nothing; one = finder.next(false)) {
      told += one.bytes.size();
    }
  }
  EXPECT_EQ(told + finder.drop(), given);
}

}  // namespace
}  // namespace axisgate::modbus_rtu
