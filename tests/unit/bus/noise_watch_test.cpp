#include "adapters/bus/noise_watch.hpp"

#include <gtest/gtest.h>

namespace axisgate::bus {
namespace {

using namespace std::chrono_literals;

constexpr Instant kStart = Instant{} + 1h;

TEST(NoiseWatch, hears_nothing_at_first) {
  EXPECT_FALSE(NoiseWatch().babbles(kStart));
  EXPECT_FALSE(NoiseWatch().heard_lately(kStart));
}

TEST(NoiseWatch, noise_without_a_pause_for_over_100_ms_is_babble) {
  NoiseWatch watch;
  for (Duration t = 0ms; t <= 100ms; t += 10ms) {
    watch.on_noise(kStart + t);
    EXPECT_FALSE(watch.babbles(kStart + t));
  }
  watch.on_noise(kStart + 101ms);
  EXPECT_TRUE(watch.babbles(kStart + 101ms));
}

TEST(NoiseWatch, one_bad_frame_for_each_request_is_no_babble) {
  NoiseWatch watch;
  for (Duration t = 0ms; t <= 10s; t += 100ms) {
    watch.on_noise(kStart + t);
    EXPECT_FALSE(watch.babbles(kStart + t));
  }
}

TEST(NoiseWatch, the_pauses_of_a_usb_adapter_do_not_hide_babble) {
  NoiseWatch watch;
  for (Duration t = 0ms; t <= 112ms; t += 16ms) watch.on_noise(kStart + t);
  EXPECT_TRUE(watch.babbles(kStart + 112ms));
}

TEST(NoiseWatch, an_answer_clears_it) {
  NoiseWatch watch;
  for (Duration t = 0ms; t <= 150ms; t += 10ms) watch.on_noise(kStart + t);
  watch.clear();
  EXPECT_FALSE(watch.babbles(kStart + 150ms));
  EXPECT_FALSE(watch.heard_lately(kStart + 150ms));
}

TEST(NoiseWatch, silence_ends_it) {
  NoiseWatch watch;
  for (Duration t = 0ms; t <= 150ms; t += 10ms) watch.on_noise(kStart + t);
  EXPECT_TRUE(watch.heard_lately(kStart + 170ms));
  EXPECT_FALSE(watch.heard_lately(kStart + 171ms));
}

}  // namespace
}  // namespace axisgate::bus
