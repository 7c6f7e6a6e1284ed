// SPDX-License-Identifier: Apache-2.0
// What nodes show of themselves: presence and state, emergencies and storms of them, two devices under one number and
// the many ways in which one device may look odd without being two.
#include "adapters/canopen/duplicate_node_watch.hpp"
#include "adapters/canopen/emergency.hpp"
#include "adapters/canopen/node_watch.hpp"
#include "gateway/core/random.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::canopen {
namespace {

using namespace std::chrono_literals;
using bus::NodeState;
using UnsolicitedKind = bus::UnsolicitedEvent::Kind;
using testing::ElementsAre;
using testing::IsEmpty;

class NodeWatchTest : public testing::Test {
 protected:
  void watch_with(NodeWatch::Settings settings) {
    watch = NodeWatch(settings);
    watch.link_up(runtime.now());
    due();
  }
  /// A frame of error control, as it is on the wire; what was told of it.
  std::vector<std::pair<UnsolicitedKind, NodeState>> hear(Byte byte) {
    const auto told = watch.on_error_control(*decode_error_control(std::array{byte}), runtime.now());
    ignored = !told;
    std::vector<std::pair<UnsolicitedKind, NodeState>> all;
    if (told) {
      for (const bus::UnsolicitedEvent& unsolicited : *told) all.emplace_back(unsolicited.kind, unsolicited.state);
    }
    return all;
  }
  NodeWatch::Due due() { return watch.on_deadline(runtime.now()); }
  NodeWatch::Due after(Duration time) {
    runtime.advance_by(time);
    return due();
  }

  test::ManualRuntime runtime;
  NodeWatch watch{{}};
  bool ignored = false;
};

TEST_F(NodeWatchTest, a_node_whose_id_is_flooded_is_not_missed_for_what_was_not_looked_at) {
  watch_with({.node = 3, .heartbeat = 500ms});
  hear(0x05);
  for (int i = 0; i < 20; ++i) {
    watch.on_flood(runtime.now());
    EXPECT_FALSE(after(100ms).gone);
  }
  EXPECT_TRUE(after(1s).gone) << "silence is silence again";
}

TEST_F(NodeWatchTest, the_first_heartbeat_every_change_of_state_and_each_one_that_is_not_operational_are_told) {
  watch_with({.node = 3, .heartbeat = 500ms});
  const std::pair<Byte, NodeState> heard[] = {{0x7F, NodeState::pre_operational}, {0x7F, NodeState::pre_operational},
                                              {0x05, NodeState::operational},     {0x04, NodeState::stopped},
                                              {0x04, NodeState::stopped},         {0x05, NodeState::operational},
                                              {0x02, NodeState::unknown}};  // a state it passes through
  for (const auto& [byte, state] : heard)
    EXPECT_THAT(hear(byte), ElementsAre(std::pair(UnsolicitedKind::present, state)));
  hear(0x05);
  EXPECT_THAT(hear(0x05), IsEmpty());
}

TEST_F(NodeWatchTest, nothing_is_missed_without_a_period_or_before_the_first_heartbeat) {
  for (const Duration period : {500ms, 0ms}) {
    watch_with({.node = 3, .heartbeat = period});
    if (period == 0ms) {
      EXPECT_EQ(hear(0x05).size(), 1u);
    }
    EXPECT_EQ(watch.next_deadline(), kNever);
    EXPECT_FALSE(after(1h).gone);
  }
}

TEST_F(NodeWatchTest, a_heartbeat_is_overdue_after_one_and_a_half_periods_and_the_grace) {
  watch_with({.node = 3, .heartbeat = 500ms});
  for (int i = 0; i < 5; ++i) {
    hear(0x05);
    EXPECT_EQ(watch.next_deadline(), runtime.now() + 850ms) << "each one moves it";
    EXPECT_FALSE(after(849ms).gone);
  }
  EXPECT_TRUE(after(1ms).gone);
  EXPECT_FALSE(after(1h).gone) << "told once";
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(UnsolicitedKind::present, NodeState::operational))) << "and back again";
}

TEST_F(NodeWatchTest, a_boot_up_is_told_and_ends_the_watch_until_the_next_heartbeat) {
  watch_with({.node = 3, .heartbeat = 500ms});
  hear(0x05);
  EXPECT_THAT(hear(0x00), ElementsAre(std::pair(UnsolicitedKind::started, NodeState::pre_operational)));
  EXPECT_EQ(watch.next_deadline(), kNever) << "its heartbeat may be off now";
  EXPECT_THAT(hear(0x7F), ElementsAre(std::pair(UnsolicitedKind::present, NodeState::pre_operational)));
  EXPECT_EQ(watch.next_deadline(), runtime.now() + 850ms);
}

TEST_F(NodeWatchTest, a_call_makes_the_next_sign_of_life_news) {
  watch_with({.node = 3, .heartbeat = 500ms});
  hear(0x05);
  watch.call();
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(UnsolicitedKind::present, NodeState::operational)));
  EXPECT_THAT(hear(0x05), IsEmpty());
}

TEST_F(NodeWatchTest, a_lost_link_forgets_everything) {
  watch_with({.node = 3, .heartbeat = 500ms, .guard_time = 100ms});
  hear(0x05);
  watch.link_down();
  EXPECT_EQ(watch.next_deadline(), kNever);
  watch.link_up(runtime.now());
  EXPECT_EQ(hear(0x05).size(), 1u);
}

// --- Node guarding --------------------------------------------------------------------------------------------------

class NodeGuarding : public NodeWatchTest {
 protected:
  NodeGuarding() { watch_with({.node = 3, .guard_time = 200ms, .life_factor = 3}); }
};

TEST_F(NodeGuarding, a_guarding_frame_is_due_at_once_and_in_every_guard_time) {
  NodeWatch fresh({.node = 3, .guard_time = 200ms});
  fresh.link_up(runtime.now());
  EXPECT_TRUE(fresh.on_deadline(runtime.now()).guard);
  EXPECT_FALSE(after(199ms).guard);
  EXPECT_TRUE(after(1ms).guard);
  EXPECT_TRUE(after(200ms).guard);
}

TEST_F(NodeGuarding, answers_that_toggle_keep_the_node_present) {
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(UnsolicitedKind::present, NodeState::operational)));
  Byte answer = 0x05;
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(after(200ms).gone);
    answer ^= 0x80;
    EXPECT_THAT(hear(answer), IsEmpty());
    EXPECT_FALSE(ignored);
  }
}

TEST_F(NodeGuarding, answers_may_begin_with_either_toggle) {
  EXPECT_EQ(hear(0x85).size(), 1u) << "somebody else guarded it before us";
  after(200ms);
  hear(0x05);
  EXPECT_FALSE(ignored);
}

TEST_F(NodeGuarding, an_answer_that_does_not_toggle_is_none_and_one_that_got_lost_costs_one_more_and_no_node) {
  hear(0x05);
  after(200ms);
  after(200ms);  // 85 was lost on its way
  hear(0x05);
  EXPECT_TRUE(ignored);
  EXPECT_FALSE(after(200ms).gone);
  hear(0x85);
  EXPECT_FALSE(ignored);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(after(200ms).gone) << i;
    hear(0x85);
    EXPECT_TRUE(ignored) << i;
  }
  EXPECT_TRUE(after(200ms).gone);
}

TEST_F(NodeGuarding, as_many_misses_as_the_life_factor_and_a_node_that_ever_answered_is_gone_once) {
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(after(200ms).gone) << "it never answered";
  hear(0x05);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(after(200ms).gone);
  EXPECT_TRUE(after(200ms).gone) << "three frames without an answer";
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(after(200ms).gone);
  EXPECT_EQ(hear(0x05).size(), 1u);
}

TEST_F(NodeGuarding, after_a_boot_up_the_first_answer_has_toggle_0) {
  hear(0x05);
  hear(0x00);
  hear(0x7F);
  EXPECT_FALSE(ignored);
  hear(0xFF);
  EXPECT_FALSE(ignored);
}

TEST_F(NodeGuarding, a_stall_brings_one_frame_and_no_burst) {
  EXPECT_TRUE(after(10s).guard);
  EXPECT_EQ(watch.next_deadline(), runtime.now() + 200ms);
}

// --- EMCY ------------------------------------------------------------------------------------------------------------

using test::from_hex;

TEST(EmergencyFrame, has_code_register_and_five_bytes_of_the_maker_and_may_be_short_but_for_its_code) {
  const auto heard = decode_emergency(5, from_hex("30 81 10 01 02 03 04 05"));
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->node, 5);
  EXPECT_EQ(heard->code, 0x8130);
  EXPECT_EQ(heard->error_register, 0x10);
  EXPECT_THAT(heard->vendor, testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(decode_emergency(1, from_hex("30 81"))->code, 0x8130);
  EXPECT_EQ(decode_emergency(1, from_hex("30 81 10"))->error_register, 0x10);
  EXPECT_THAT(decode_emergency(1, from_hex("30 81 10 AA"))->vendor, testing::ElementsAre(0xAA, 0, 0, 0, 0));
  EXPECT_FALSE(decode_emergency(1, from_hex("30")));
  EXPECT_FALSE(decode_emergency(1, {}));
}

class EmergencyStorm : public testing::Test {
 protected:
  std::optional<bus::UnsolicitedEvent> pass(std::uint16_t code) {
    bus::UnsolicitedEvent unsolicited{.kind = bus::UnsolicitedEvent::Kind::emergency, .node = 1};
    unsolicited.code = code;
    return limit.pass(unsolicited, now);
  }
  Instant now = Instant{} + 1h;
  EmergencyLimit limit;
};

TEST_F(EmergencyStorm, the_first_ones_pass_and_the_last_one_comes_with_the_number_of_the_rest) {
  for (int i = 0; i < EmergencyLimit::kMaxEmergencies; ++i) {
    const auto told = pass(0x3210);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->repeats, 0u);
  }
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(pass(0x3210));
  EXPECT_FALSE(pass(0x4310));
  EXPECT_FALSE(limit.take_held(now));
  now += 1s;
  EXPECT_EQ(limit.next_deadline(), now);
  const auto last = limit.take_held(now);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->code, 0x4310) << "what it said last";
  EXPECT_EQ(last->repeats, 9u);
  EXPECT_FALSE(limit.take_held(now));
  EXPECT_EQ(limit.next_deadline(), kNever);
}

TEST_F(EmergencyStorm, error_reset_always_passes_and_counts_what_did_not_pass_before) {
  for (int i = 0; i < 20; ++i) static_cast<void>(pass(0x3210));
  const auto reset = pass(0x0000);
  ASSERT_TRUE(reset);
  EXPECT_EQ(reset->repeats, 20u - EmergencyLimit::kMaxEmergencies);
  EXPECT_EQ(limit.next_deadline(), kNever) << "the error is over: what it was last is no news any more";
}

TEST_F(EmergencyStorm, slow_ones_all_pass_and_of_fast_ones_a_few_each_second_and_none_is_lost_count_of) {
  for (int i = 0; i < 50; ++i) {
    now += 300ms;
    EXPECT_TRUE(pass(0x3210)) << i;
  }
  limit = {};
  std::uint32_t told = 0, repeats = 0;
  const auto count = [&](const std::optional<bus::UnsolicitedEvent>& unsolicited) {
    told += unsolicited ? 1U : 0U;
    repeats += unsolicited ? unsolicited->repeats : 0U;
  };
  for (int i = 0; i < 10'000; ++i) {
    now += 1ms;
    count(limit.take_held(now));
    count(pass(0x3210));
  }
  count(limit.take_held(now + 1s));
  EXPECT_LE(told, 11U * EmergencyLimit::kMaxEmergencies);
  EXPECT_EQ(told + repeats, 10'000u);
}

// --- Two devices, one number -----------------------------------------------------------------------------------------

constexpr Duration kPeriod = 500ms;

class DuplicateNodeWatchTest : public testing::Test {
 protected:
  bool beat(Duration gap, NodeState state = NodeState::operational) {
    now += gap;
    return watch.on_heartbeat(state, now);
  }
  /// Heartbeats until a duplicate node-ID is seen; 0: it is not, in so many.
  int beats_until_duplicate(const std::vector<Duration>& gaps, const std::vector<NodeState>& states, int most = 60) {
    for (int i = 0; i < most; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (beat(gaps[at % gaps.size()], states[at % states.size()])) return i + 1;
    }
    return 0;
  }

  Instant now = Instant{} + 1h;
  DuplicateNodeWatch watch{kPeriod};
};

TEST_F(DuplicateNodeWatchTest, one_device_of_any_period_is_one) {
  for (const Duration period : {20ms, 100ms, 125ms, 250ms, 400ms, 500ms, 600ms, 1000ms, 5000ms}) {
    watch.forget();
    EXPECT_EQ(beats_until_duplicate({period}, {NodeState::operational}), 0) << period / 1ms;
  }
}

TEST_F(DuplicateNodeWatchTest, one_device_whose_heartbeats_jitter_is_one) {
  Random random(7);
  for (int i = 0; i < 5000; ++i) {
    const auto jitter = std::chrono::milliseconds(random.below(101));
    ASSERT_FALSE(beat(kPeriod - 50ms + jitter)) << i;
  }
}

TEST_F(DuplicateNodeWatchTest, two_devices_are_seen_by_their_rhythm_whatever_the_phase) {
  for (int phase = 1; phase < 10; ++phase) {
    watch.forget();
    const Duration offset = kPeriod * phase / 10;
    if (phase == 5) continue;  // looks like one device of half the period
    EXPECT_GT(beats_until_duplicate({offset, kPeriod - offset}, {NodeState::operational}), 0) << phase;
  }
}

TEST_F(DuplicateNodeWatchTest, a_second_device_that_joins_in_the_middle_is_seen) {
  for (int i = 0; i < 10; ++i) ASSERT_FALSE(beat(kPeriod));
  EXPECT_GT(beats_until_duplicate({kPeriod / 2}, {NodeState::operational}), 0);
}

TEST_F(DuplicateNodeWatchTest, contradicting_states_in_turn_are_two_devices_with_and_without_a_period) {
  for (const Duration period : {kPeriod, Duration{}}) {
    watch = DuplicateNodeWatch(period);
    const int beats = beats_until_duplicate({250ms}, {NodeState::operational, NodeState::pre_operational});
    EXPECT_GT(beats, 2 + DuplicateNodeWatch::kMaxFlips - 1);
    EXPECT_LE(beats, 3 + DuplicateNodeWatch::kMaxFlips);
  }
}

TEST_F(DuplicateNodeWatchTest, states_that_change_and_stay_are_one_device) {
  EXPECT_EQ(beats_until_duplicate({kPeriod}, {NodeState::pre_operational, NodeState::pre_operational,
                                              NodeState::operational, NodeState::operational}),
            0);
}

TEST_F(DuplicateNodeWatchTest, states_that_we_command_are_no_contradiction) {
  for (int i = 0; i < 30; ++i) {
    watch.forget();
    ASSERT_FALSE(beat(kPeriod, i % 2 == 0 ? NodeState::operational : NodeState::pre_operational));
  }
}

TEST_F(DuplicateNodeWatchTest, heartbeats_of_the_old_state_at_their_old_times_after_a_boot_up_are_anothers) {
  for (int i = 0; i < 5; ++i) ASSERT_FALSE(beat(kPeriod));
  watch.on_boot_up(now + 200ms);
  EXPECT_FALSE(beat(kPeriod));
  EXPECT_TRUE(beat(kPeriod));
}

TEST_F(DuplicateNodeWatchTest, a_device_that_starts_anew_is_one_whether_it_or_we_make_it_operational) {
  for (const bool by_itself : {true, false}) {
    for (int i = 0; i < 5; ++i) ASSERT_FALSE(beat(kPeriod));
    now += 230ms;
    watch.on_boot_up(now);
    if (!by_itself) {
      EXPECT_FALSE(beat(kPeriod, NodeState::pre_operational));
      watch.forget();  // NMT start
    }
    EXPECT_EQ(beats_until_duplicate({kPeriod}, {NodeState::operational}), 0);
  }
}

}  // namespace
}  // namespace axisgate::canopen
