// SPDX-License-Identifier: Apache-2.0
// What a line that brings back our frames must show before an answer of zeros is believed.
#include "adapters/keya/keya_echo.hpp"

#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::keya {
namespace {

FrameBytes query(std::uint8_t code) { return encode(KeyaLine::rs485, {.start = kQuery, .node = 1, .code = code}); }

class KeyaEcho : public testing::Test {
 protected:
  /// Sends a query; whether the frame that is equal to it is the echo.
  bool comes_back(std::uint8_t code = 2) {
    watch.on_sent(query(code));
    return watch.is_echo(query(code), !is_never_zero(code));
  }
  void is_answered(bool clean = true) {
    watch.on_sent(query(2));
    watch.on_answer(clean);
  }
  EchoWatch watch;
};

TEST_F(KeyaEcho, one_clean_answer_without_echo_shows_that_an_unknown_line_has_none) {
  EXPECT_TRUE(comes_back()) << "on an unknown line what is equal to the query is its echo";
  watch.reset();
  is_answered(false);
  EXPECT_TRUE(comes_back()) << "an answer amid noise shows nothing: the echo may have been the noise";
  watch.reset();
  is_answered();
  EXPECT_FALSE(comes_back()) << "it stands still";
  watch.reset();
  EXPECT_TRUE(comes_back()) << "a new line is an unknown one";
}

TEST_F(KeyaEcho, what_no_drive_answers_with_zeros_shows_the_echo_at_once) {
  is_answered();
  EXPECT_TRUE(comes_back(5)) << "no drive runs on 0 V";
  EXPECT_TRUE(comes_back());
}

TEST_F(KeyaEcho, an_answer_behind_its_echo_shows_the_echo) {
  EXPECT_TRUE(comes_back());
  watch.on_answer(true);
  is_answered();
  EXPECT_TRUE(comes_back()) << "on an unknown line the one clean answer would have shown that there is none";
}

TEST_F(KeyaEcho, there_is_one_echo_of_one_frame_and_another_frame_is_none) {
  watch.on_sent(query(2));
  EXPECT_FALSE(watch.is_echo(query(3), true));
  EXPECT_TRUE(watch.is_echo(query(2), true));
  EXPECT_FALSE(watch.is_echo(query(2), true)) << "the answer";
}

TEST_F(KeyaEcho, a_line_that_echoed_is_believed_silent_after_three_clean_answers_without) {
  EXPECT_TRUE(comes_back(5));
  is_answered();
  is_answered();
  EXPECT_TRUE(comes_back());
  is_answered();
  EXPECT_FALSE(comes_back());
}

}  // namespace
}  // namespace axisgate::keya
