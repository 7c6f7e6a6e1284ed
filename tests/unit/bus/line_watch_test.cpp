#include "adapters/bus/line_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::bus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A watched line whose wire is the test. `story`: what was asked of the wire and told to the bus, in order.
class WatchedLine : public testing::Test, protected WireEvents {
 protected:
  WatchedLine() { watch.start(*this); }
  void on_wire_up() override { story.emplace_back("up"); }
  void on_wire_down(std::string_view why) override { story.push_back("down: " + std::string(why)); }
  void on_reply(const ExchangeResult&) override {}

  void reopen(std::string_view why) {
    story.push_back("reopen: " + std::string(why));
    watch.on_link_down(why);
    if (opens_again) watch.on_link_up();
  }
  void babble(Duration how_long) {
    for (const Instant end = runtime.now() + how_long; runtime.now() < end; runtime.advance_by(1ms)) watch.on_noise();
  }
  /// Up, and then given up for its noise.
  void give_up() {
    watch.on_link_up();
    babble(500ms);
    ASSERT_FALSE(watch.up());
    story.clear();
  }

  bool opens_again = true;
  std::vector<std::string> story;
  test::ManualRuntime runtime;
  LineWatch watch{
      runtime,
      {.reopen = [this](std::string_view why) { reopen(why); }, .drop = [this] { story.emplace_back("drop"); }}};
};

TEST_F(WatchedLine, is_down_until_its_link_is_up) {
  EXPECT_FALSE(watch.up());
  watch.on_link_up();
  EXPECT_TRUE(watch.up());
  watch.on_link_down("/dev/ttyS1: hung up");
  EXPECT_FALSE(watch.up());
  EXPECT_THAT(story, ElementsAre("up", "down: /dev/ttyS1: hung up"));
}

TEST_F(WatchedLine, is_told_in_turn_however_often_the_link_tells) {
  watch.on_link_down("not there");
  watch.on_link_up();
  watch.on_link_up();
  watch.on_link_down("gone");
  watch.on_link_down("gone");
  EXPECT_THAT(story, ElementsAre("up", "down: gone"));
}

TEST_F(WatchedLine, counts_each_time_it_was_up_again) {
  watch.on_link_up();
  EXPECT_EQ(watch.reconnects(), 0u);
  for (int i = 0; i < 3; ++i) {
    watch.on_link_down("gone");
    watch.on_link_up();
  }
  EXPECT_EQ(watch.reconnects(), 3u);
}

TEST_F(WatchedLine, a_short_noise_is_nothing) {
  watch.on_link_up();
  babble(100ms);
  EXPECT_TRUE(watch.noisy());
  runtime.advance_by(1s);
  EXPECT_FALSE(watch.noisy());
  EXPECT_THAT(story, ElementsAre("up"));
}

TEST_F(WatchedLine, that_babbles_is_opened_anew_three_times_and_then_given_up) {
  watch.on_link_up();
  story.clear();
  babble(500ms);
  ASSERT_THAT(story, SizeIs(11));
  for (std::size_t i = 0; i < 9; i += 3) {
    EXPECT_THAT(story[i], HasSubstr("reopen: noise without a pause"));
    EXPECT_THAT(story[i + 1], HasSubstr("down: noise without a pause"));
    EXPECT_EQ(story[i + 2], "up");
  }
  EXPECT_EQ(story[9], "drop") << "before the bus is told";
  EXPECT_THAT(story[10], HasSubstr("opened anew 3 times, waiting for silence"));
}

TEST_F(WatchedLine, an_answer_starts_the_count_of_openings_anew) {
  watch.on_link_up();
  for (int i = 0; i < 10; ++i) {
    babble(110ms);
    watch.on_answer();
    EXPECT_FALSE(watch.noisy());
  }
  EXPECT_TRUE(watch.up());
  EXPECT_EQ(watch.reconnects(), 10u);
}

TEST_F(WatchedLine, that_was_given_up_and_stays_noisy_is_opened_anew_each_second_and_the_bus_hears_nothing) {
  give_up();
  babble(5s);
  EXPECT_THAT(story, SizeIs(5));
  EXPECT_THAT(story, testing::Each(std::string("reopen: the line is still noisy")));
}

TEST_F(WatchedLine, that_was_given_up_is_taken_back_at_the_first_look_at_a_quiet_line) {
  give_up();
  runtime.advance_by(LineWatch::kSecondLook - 500ms);
  EXPECT_THAT(story, IsEmpty());
  runtime.advance_by(500ms);
  EXPECT_THAT(story, ElementsAre("up"));
  story.clear();
  babble(150ms);
  EXPECT_THAT(story, SizeIs(3)) << "with all its openings again";
}

TEST_F(WatchedLine, that_was_given_up_and_then_lost_is_taken_back_when_its_link_is_there) {
  give_up();
  watch.on_link_down("hung up");
  runtime.advance_by(10s);
  EXPECT_THAT(story, IsEmpty()) << "down was told already, and a link that is down is not opened anew";
  watch.on_link_up();
  EXPECT_THAT(story, IsEmpty());
  runtime.advance_by(1s);
  EXPECT_THAT(story, ElementsAre("up"));
}

TEST_F(WatchedLine, whose_link_does_not_open_again_stays_down) {
  opens_again = false;
  watch.on_link_up();
  babble(3s);
  EXPECT_FALSE(watch.up());
  EXPECT_EQ(watch.reconnects(), 0u);
}

}  // namespace
}  // namespace axisgate::bus
