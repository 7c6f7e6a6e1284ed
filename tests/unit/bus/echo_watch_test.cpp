// SPDX-License-Identifier: Apache-2.0
// What a line must show before it is known to echo or not, and what a copy of a request is meanwhile.
#include "adapters/bus/echo_watch.hpp"

#include <gmock/gmock.h>

#include "adapters/bus/glitch_skip.hpp"
#include "adapters/bus/line_remarks.hpp"

namespace axisgate::bus {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Belief = EchoWatch::Belief;
using Copy = EchoWatch::Copy;

class EchoWatchTest : public testing::Test {
 protected:
  void read_comes_back(bool answered = true) {
    watch.on_sent(true);
    EXPECT_EQ(watch.on_copy(false), Copy::echo) << "no drive answers a read with its request";
    if (answered) watch.on_answer(true);
  }
  void read_is_answered(bool clean = true) {
    watch.on_sent(true);
    watch.on_answer(clean);
  }
  void line_without_echo() { read_is_answered(); }
  void line_with_echo() {
    for (int i = 0; i < EchoWatch::kReadsThatCameBack; ++i) read_comes_back();
  }
  /// Of a write that a drive acknowledges by a copy of it.
  Copy copy_of_write() {
    watch.on_sent(false);
    return watch.on_copy(true);
  }
  EchoWatch watch;
};

TEST_F(EchoWatchTest, while_it_is_not_known_the_copy_of_a_write_is_neither_echo_nor_answer) {
  EXPECT_EQ(copy_of_write(), Copy::undecided);
  EXPECT_EQ(watch.on_copy(true), Copy::undecided) << "nor is a second one";
  read_comes_back();
  read_comes_back();
  EXPECT_EQ(copy_of_write(), Copy::undecided) << "two reads are not three";
}

TEST_F(EchoWatchTest, on_a_line_without_echo_the_copy_of_a_write_is_its_answer) {
  line_without_echo();
  EXPECT_EQ(copy_of_write(), Copy::answer);
}

TEST_F(EchoWatchTest, on_a_line_that_echoes_one_copy_is_dropped_and_the_second_is_the_answer) {
  line_with_echo();
  EXPECT_EQ(watch.belief(), Belief::echoes);
  EXPECT_EQ(copy_of_write(), Copy::echo);
  EXPECT_EQ(watch.on_copy(true), Copy::answer);
}

TEST_F(EchoWatchTest, learns_from_reads_alone) {
  for (int i = 0; i < 10; ++i) {
    watch.on_sent(false);
    EXPECT_EQ(watch.on_copy(true), Copy::undecided);
    watch.on_answer(true);
    watch.on_sent(false);
    EXPECT_EQ(watch.on_copy(false), Copy::echo);
    watch.on_answer(true);
  }
  EXPECT_EQ(watch.belief(), Belief::unknown);
  EXPECT_FALSE(watch.only_copies());
}

TEST_F(EchoWatchTest, an_answer_amid_noise_or_owed_from_before_shows_nothing) {
  read_is_answered(false);
  EXPECT_EQ(watch.belief(), Belief::unknown) << "the echo may have been the noise";
}

TEST_F(EchoWatchTest, one_read_that_comes_back_ends_the_belief_in_a_line_without_echo) {
  line_without_echo();
  read_comes_back();
  EXPECT_EQ(copy_of_write(), Copy::undecided);
  read_is_answered();
  read_is_answered();
  EXPECT_EQ(copy_of_write(), Copy::undecided);
  read_is_answered();
  EXPECT_EQ(copy_of_write(), Copy::answer);
}

TEST_F(EchoWatchTest, a_copy_behind_the_answer_of_a_read_counts_as_one_before_it) {
  line_without_echo();
  read_is_answered();
  EXPECT_EQ(watch.on_copy(false), Copy::echo);
  EXPECT_EQ(copy_of_write(), Copy::undecided);
}

TEST_F(EchoWatchTest, a_line_that_echoed_is_known_not_to_after_three_clean_answers_without) {
  line_with_echo();
  read_is_answered();
  read_is_answered();
  read_is_answered(false);
  EXPECT_EQ(watch.belief(), Belief::echoes);
  read_is_answered();
  EXPECT_EQ(watch.belief(), Belief::silent);
}

TEST_F(EchoWatchTest, three_that_came_back_with_one_between_them_that_did_not_are_not_in_a_row) {
  read_comes_back();
  read_comes_back();
  watch.on_sent(true);  // nothing comes at all
  read_comes_back();
  EXPECT_EQ(watch.belief(), Belief::unknown);
}

TEST_F(EchoWatchTest, of_a_read_that_a_drive_could_answer_so_the_first_copy_counts_once_its_answer_came) {
  for (int i = 0; i < EchoWatch::kReadsThatCameBack; ++i) {
    watch.on_sent(true);
    EXPECT_EQ(watch.on_copy(true), Copy::undecided);
    watch.on_answer(true);
  }
  EXPECT_EQ(watch.belief(), Belief::echoes);
}

TEST_F(EchoWatchTest, a_new_line_is_an_unknown_one) {
  line_with_echo();
  watch.reset();
  EXPECT_EQ(copy_of_write(), Copy::undecided);
}

TEST_F(EchoWatchTest, only_copies_are_told_after_three_reads_and_no_more_after_anything_else_came) {
  for (int i = 0; i < EchoWatch::kCopiesAlone; ++i) {
    EXPECT_FALSE(watch.only_copies());
    read_comes_back(false);
  }
  watch.on_sent(true);
  EXPECT_TRUE(watch.only_copies());
  watch.on_other();
  EXPECT_FALSE(watch.only_copies()) << "somebody else is there";
}

TEST(GlitchSkipTest, skips_eight_bytes_before_a_frame_and_takes_more_for_noise) {
  GlitchSkip skip;
  for (std::size_t i = 0; i < GlitchSkip::kMost; ++i) EXPECT_TRUE(skip.skips(i % 2 == 0 ? 0x00 : 0xFF));
  EXPECT_FALSE(skip.skips(0x00)) << "a line that is held low";
  skip.renew();
  EXPECT_FALSE(skip.skips(0x7F));
  EXPECT_TRUE(skip.skips(0xFF));
}

TEST(LineRemarksTest, say_each_kind_once_a_minute_and_how_many_were_left_out) {
  std::vector<std::string> lines;
  const Log log{[&](LogLevel, std::string_view, std::string_view message) { lines.emplace_back(message); }};
  LineRemarks remarks(log, bus_source("lift"));
  Instant now = Instant{} + std::chrono::hours(1);
  const Instant end = now + LineRemarks::kPause;
  for (; now < end; now += std::chrono::milliseconds(10)) remarks.misfit("read", "a value", "another length", now);
  EXPECT_THAT(lines,
              ElementsAre("a valid frame that does not fit: asked was \"read\", what came is \"a value\" (another "
                          "length)"));
  remarks.misfit("read", "a value", "another length", now);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_THAT(lines.back(), HasSubstr("; 5999 more since the last such line"));
}

}  // namespace
}  // namespace axisgate::bus
