// SPDX-License-Identifier: Apache-2.0
// A line that is noisy, lost or opened anew; what is worked out from instants alone: noise, load, the pauses of probes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "adapters/bus/backoff.hpp"
#include "adapters/bus/exchange_times.hpp"
#include "adapters/bus/line_watch.hpp"
#include "adapters/bus/load_meter.hpp"
#include "adapters/bus/noise_watch.hpp"
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

TEST_F(WatchedLine, is_told_in_turn_however_often_the_link_tells_and_its_returns_are_counted) {
  EXPECT_FALSE(watch.up());
  watch.on_link_down("not there");
  for (std::uint32_t again = 0; again < 3; ++again) {
    story.clear();
    watch.on_link_up();
    watch.on_link_up();
    EXPECT_TRUE(watch.up());
    EXPECT_EQ(watch.reconnects(), again);
    watch.on_link_down("gone");
    watch.on_link_down("gone");
    EXPECT_FALSE(watch.up());
    EXPECT_THAT(story, ElementsAre("up", "down: gone"));
  }
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

TEST_F(WatchedLine, that_was_given_up_is_opened_anew_each_second_and_taken_back_at_the_first_look_at_a_quiet_line) {
  give_up();
  babble(5s);
  EXPECT_THAT(story, SizeIs(5));
  EXPECT_THAT(story, testing::Each(std::string("reopen: the line is still noisy")));
  story.clear();
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

// --- Instants alone --------------------------------------------------------------------------------------------------

constexpr Instant kStart = Instant{} + 1h;

TEST(Backoff, doubles_from_half_a_second_up_to_200_timeouts_and_starts_anew_after_a_reset) {
  Backoff backoff(20ms);
  for (const Duration pause : {500ms, 1000ms, 2000ms, 4000ms, 4000ms}) EXPECT_EQ(backoff.next(), pause);
  backoff.reset();
  EXPECT_EQ(backoff.next(), 500ms);
}

TEST(Backoff, never_pauses_longer_than_a_minute) {
  Backoff backoff(1s);
  for (int i = 0; i < 20; ++i) (void)backoff.next();
  EXPECT_EQ(backoff.next(), 60s);
}

TEST(ExchangeTimes, counts_each_exchange_in_the_bucket_of_its_class_that_doubles) {
  ExchangeTimes times;
  times.add(Priority::stop, 0us);
  times.add(Priority::stop, 99us);
  times.add(Priority::stop, 100us);
  times.add(Priority::stop, 199us);
  times.add(Priority::stop, 200us);
  times.add(Priority::poll, 1638399us);
  times.add(Priority::poll, 1638400us);
  times.add(Priority::poll, 1h);
  const auto& stops = times.by_class()[static_cast<std::size_t>(Priority::stop)].counts;
  EXPECT_EQ(stops[0], 2U);
  EXPECT_EQ(stops[1], 2U);
  EXPECT_EQ(stops[2], 1U);
  const auto& polls = times.by_class()[static_cast<std::size_t>(Priority::poll)];
  EXPECT_EQ(polls.counts[14], 1U);
  EXPECT_EQ(polls.counts[15], 2U);
  EXPECT_EQ(polls.total(), 3U);
  EXPECT_EQ(Duration(polls.sum_ns), 1638399us + 1638400us + 1h);
  EXPECT_EQ(times.sum(), Duration(polls.sum_ns) + 598us);
}

TEST(LoadMeter, tells_the_share_of_the_last_whole_second) {
  LoadMeter meter;
  EXPECT_EQ(meter.permille(kStart - 1h), 0);
  meter.set_busy(true, kStart);
  meter.set_busy(false, kStart + 100ms);
  meter.set_busy(true, kStart + 500ms);
  meter.set_busy(false, kStart + 650ms);
  EXPECT_EQ(LoadMeter(meter).permille(kStart + 900ms), 0) << "no second is over yet";
  EXPECT_EQ(meter.permille(kStart + 1s), 250);
  EXPECT_EQ(meter.permille(kStart + 1999ms), 250);
  EXPECT_EQ(meter.permille(kStart + 2s), 0) << "an idle second has passed";
}

TEST(LoadMeter, splits_an_exchange_across_the_turn_of_the_second) {
  LoadMeter meter;
  meter.set_busy(false, kStart);
  meter.set_busy(true, kStart + 900ms);
  EXPECT_EQ(meter.permille(kStart + 1s), 100);
  meter.set_busy(false, kStart + 1200ms);
  EXPECT_EQ(meter.permille(kStart + 1500ms), 100);
  EXPECT_EQ(meter.permille(kStart + 2s), 200);
}

TEST(LoadMeter, is_full_while_one_exchange_lasts_for_seconds) {
  LoadMeter meter;
  meter.set_busy(true, kStart);
  EXPECT_EQ(meter.permille(kStart + 1s), 1000);
  meter.set_busy(false, kStart + 7500ms);
  EXPECT_EQ(meter.permille(kStart + 7900ms), 1000);
  EXPECT_EQ(meter.permille(kStart + 8s), 500);
}

class NoiseWatchTest : public testing::Test {
 protected:
  /// Noise each `pause`, up to then; whether it was babble at any time.
  bool noise_each(Duration pause, Duration until) {
    bool babbled = false;
    for (Duration t = 0ms; t <= until; t += pause) {
      watch.on_noise(kStart + t);
      babbled = babbled || watch.babbles(kStart + t);
    }
    return babbled;
  }
  NoiseWatch watch;
};

TEST_F(NoiseWatchTest, noise_without_a_pause_for_over_100_ms_is_babble_also_with_those_of_a_usb_adapter) {
  EXPECT_FALSE(watch.babbles(kStart) || watch.heard_lately(kStart));
  EXPECT_FALSE(noise_each(10ms, 100ms));
  watch.on_noise(kStart + 101ms);
  EXPECT_TRUE(watch.babbles(kStart + 101ms));
  watch = {};
  EXPECT_TRUE(noise_each(16ms, 112ms));
  watch = {};
  EXPECT_FALSE(noise_each(100ms, 10s)) << "one bad frame for each request";
}

TEST_F(NoiseWatchTest, an_answer_or_silence_ends_it) {
  EXPECT_TRUE(noise_each(10ms, 150ms));
  EXPECT_TRUE(watch.heard_lately(kStart + 170ms));
  EXPECT_FALSE(watch.heard_lately(kStart + 171ms));
  watch.clear();
  EXPECT_FALSE(watch.babbles(kStart + 150ms) || watch.heard_lately(kStart + 150ms));
}

}  // namespace
}  // namespace axisgate::bus
