// Two devices under one number, and the many ways in which one device may look odd without being two.
#include "adapters/canopen/twin_watch.hpp"

#include "gateway/core/random.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::canopen {
namespace {

using namespace std::chrono_literals;
using bus::NodeState;

constexpr Duration kPeriod = 500ms;

class TwinWatchTest : public testing::Test {
 protected:
  bool beat(Duration gap, NodeState state = NodeState::operational) {
    now += gap;
    return watch.on_heartbeat(state, now);
  }
  /// Heartbeats until a twin is seen; 0: it is not, in so many.
  int beats_until_twin(const std::vector<Duration>& gaps, const std::vector<NodeState>& states, int most = 60) {
    for (int i = 0; i < most; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (beat(gaps[at % gaps.size()], states[at % states.size()])) return i + 1;
    }
    return 0;
  }

  Instant now = Instant{} + 1h;
  TwinWatch watch{kPeriod};
};

TEST_F(TwinWatchTest, one_device_of_any_period_is_one) {
  for (const Duration period : {20ms, 100ms, 125ms, 250ms, 400ms, 500ms, 600ms, 1000ms, 5000ms}) {
    watch.forget();
    EXPECT_EQ(beats_until_twin({period}, {NodeState::operational}), 0) << period / 1ms;
  }
}

TEST_F(TwinWatchTest, one_device_whose_heartbeats_jitter_is_one) {
  Random random(7);
  for (int i = 0; i < 5000; ++i) {
    const auto jitter = std::chrono::milliseconds(random.below(101));
    ASSERT_FALSE(beat(kPeriod - 50ms + jitter)) << i;
  }
}

TEST_F(TwinWatchTest, two_devices_are_seen_by_their_rhythm_whatever_the_phase) {
  for (int phase = 1; phase < 10; ++phase) {
    watch.forget();
    const Duration offset = kPeriod * phase / 10;
    if (phase == 5) continue;  // looks like one device of half the period
    EXPECT_GT(beats_until_twin({offset, kPeriod - offset}, {NodeState::operational}), 0) << phase;
  }
}

TEST_F(TwinWatchTest, a_second_device_that_joins_in_the_middle_is_seen) {
  for (int i = 0; i < 10; ++i) ASSERT_FALSE(beat(kPeriod));
  EXPECT_GT(beats_until_twin({kPeriod / 2}, {NodeState::operational}), 0);
}

TEST_F(TwinWatchTest, contradicting_states_in_turn_are_two_devices_with_and_without_a_period) {
  for (const Duration period : {kPeriod, Duration{}}) {
    watch = TwinWatch(period);
    const int beats = beats_until_twin({250ms}, {NodeState::operational, NodeState::pre_operational});
    EXPECT_GT(beats, 2 + TwinWatch::kMaxFlips - 1);
    EXPECT_LE(beats, 3 + TwinWatch::kMaxFlips);
  }
}

TEST_F(TwinWatchTest, states_that_change_and_stay_are_one_device) {
  EXPECT_EQ(beats_until_twin({kPeriod}, {NodeState::pre_operational, NodeState::pre_operational, NodeState::operational,
                                         NodeState::operational}),
            0);
}

TEST_F(TwinWatchTest, states_that_we_command_are_no_contradiction) {
  for (int i = 0; i < 30; ++i) {
    watch.forget();
    ASSERT_FALSE(beat(kPeriod, i % 2 == 0 ? NodeState::operational : NodeState::pre_operational));
  }
}

TEST_F(TwinWatchTest, heartbeats_of_the_old_state_at_their_old_times_after_a_boot_up_are_anothers) {
  for (int i = 0; i < 5; ++i) ASSERT_FALSE(beat(kPeriod));
  watch.on_boot_up(now + 200ms);
  EXPECT_FALSE(beat(kPeriod));
  EXPECT_TRUE(beat(kPeriod));
}

TEST_F(TwinWatchTest, a_device_that_starts_anew_and_is_made_operational_is_one) {
  for (int i = 0; i < 5; ++i) ASSERT_FALSE(beat(kPeriod));
  now += 200ms;
  watch.on_boot_up(now);
  EXPECT_FALSE(beat(kPeriod, NodeState::pre_operational));
  watch.forget();  // NMT start
  EXPECT_EQ(beats_until_twin({kPeriod}, {NodeState::operational}), 0);
}

TEST_F(TwinWatchTest, a_device_that_starts_itself_at_times_of_its_own_is_one) {
  for (int i = 0; i < 5; ++i) ASSERT_FALSE(beat(kPeriod));
  now += 230ms;
  watch.on_boot_up(now);
  EXPECT_EQ(beats_until_twin({kPeriod}, {NodeState::operational}), 0);
}

}  // namespace
}  // namespace axisgate::canopen
