// Presence and state of a node, step by step.
#include "adapters/canopen/node_watch.hpp"

#include "tests/unit/canopen/canopen_frames.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::canopen {
namespace {

using namespace std::chrono_literals;
using bus::NodeState;
using Kind = bus::Notice::Kind;
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
  std::vector<std::pair<Kind, NodeState>> hear(Byte byte) {
    const auto told = watch.on_error_control(*decode_error_control(std::array{byte}), runtime.now());
    ignored = !told;
    std::vector<std::pair<Kind, NodeState>> all;
    if (told) {
      for (const bus::Notice& notice : *told) all.emplace_back(notice.kind, notice.state);
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

TEST_F(NodeWatchTest, each_heartbeat_of_a_node_that_is_not_operational_is_told) {
  watch_with({.node = 3, .heartbeat = 500ms});
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(hear(0x7F), ElementsAre(std::pair(Kind::present, NodeState::pre_operational)));
  }
  for (int i = 0; i < 3; ++i) EXPECT_THAT(hear(0x04), ElementsAre(std::pair(Kind::present, NodeState::stopped)));
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(Kind::present, NodeState::operational)));
  EXPECT_THAT(hear(0x05), IsEmpty());
}

TEST_F(NodeWatchTest, the_first_heartbeat_and_every_change_of_state_are_told) {
  watch_with({.node = 3, .heartbeat = 500ms});
  EXPECT_THAT(hear(0x7F), ElementsAre(std::pair(Kind::present, NodeState::pre_operational)));
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(Kind::present, NodeState::operational)));
  EXPECT_THAT(hear(0x05), IsEmpty());
  EXPECT_THAT(hear(0x04), ElementsAre(std::pair(Kind::present, NodeState::stopped)));
  EXPECT_THAT(hear(0x02), ElementsAre(std::pair(Kind::present, NodeState::unknown))) << "a state it passes through";
}

TEST_F(NodeWatchTest, nothing_is_missed_before_the_first_heartbeat) {
  watch_with({.node = 3, .heartbeat = 500ms});
  EXPECT_EQ(watch.next_deadline(), kNever);
  EXPECT_FALSE(after(1h).gone);
}

TEST_F(NodeWatchTest, a_heartbeat_is_overdue_after_one_and_a_half_periods_and_the_grace) {
  watch_with({.node = 3, .heartbeat = 500ms});
  hear(0x05);
  EXPECT_EQ(watch.next_deadline(), runtime.now() + 850ms);
  EXPECT_FALSE(after(849ms).gone);
  EXPECT_TRUE(after(1ms).gone);
  EXPECT_FALSE(after(1h).gone) << "told once";
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(Kind::present, NodeState::operational))) << "and back again";
}

TEST_F(NodeWatchTest, each_heartbeat_moves_the_deadline) {
  watch_with({.node = 3, .heartbeat = 100ms});
  for (int i = 0; i < 20; ++i) {
    hear(0x05);
    EXPECT_FALSE(after(200ms).gone);
  }
}

TEST_F(NodeWatchTest, a_boot_up_is_told_and_ends_the_watch_until_the_next_heartbeat) {
  watch_with({.node = 3, .heartbeat = 500ms});
  hear(0x05);
  EXPECT_THAT(hear(0x00), ElementsAre(std::pair(Kind::started, NodeState::pre_operational)));
  EXPECT_EQ(watch.next_deadline(), kNever) << "its heartbeat may be off now";
  EXPECT_THAT(hear(0x7F), ElementsAre(std::pair(Kind::present, NodeState::pre_operational)));
  EXPECT_EQ(watch.next_deadline(), runtime.now() + 850ms);
}

TEST_F(NodeWatchTest, a_node_without_a_period_is_told_of_and_never_missed) {
  watch_with({.node = 3});
  EXPECT_EQ(hear(0x05).size(), 1u);
  EXPECT_FALSE(after(1h).gone);
}

TEST_F(NodeWatchTest, a_call_makes_the_next_sign_of_life_news) {
  watch_with({.node = 3, .heartbeat = 500ms});
  hear(0x05);
  watch.call();
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(Kind::present, NodeState::operational)));
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
  EXPECT_THAT(hear(0x05), ElementsAre(std::pair(Kind::present, NodeState::operational)));
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

TEST_F(NodeGuarding, an_answer_that_does_not_toggle_is_none) {
  hear(0x05);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(after(200ms).gone) << i;
    hear(0x05);
    EXPECT_TRUE(ignored) << i;
  }
  EXPECT_TRUE(after(200ms).gone);
}

TEST_F(NodeGuarding, one_answer_that_got_lost_costs_one_more_and_no_node) {
  hear(0x05);
  after(200ms);
  after(200ms);  // 85 was lost on its way
  hear(0x05);
  EXPECT_TRUE(ignored);
  EXPECT_FALSE(after(200ms).gone);
  hear(0x85);
  EXPECT_FALSE(ignored);
}

TEST_F(NodeGuarding, as_many_misses_as_the_life_factor_and_it_is_gone_once) {
  hear(0x05);
  EXPECT_FALSE(after(200ms).gone);
  EXPECT_FALSE(after(200ms).gone);
  EXPECT_FALSE(after(200ms).gone);
  EXPECT_TRUE(after(200ms).gone) << "three frames without an answer";
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(after(200ms).gone);
  EXPECT_EQ(hear(0x05).size(), 1u);
}

TEST_F(NodeGuarding, a_node_that_never_answered_is_not_gone) {
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(after(200ms).gone);
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

}  // namespace
}  // namespace axisgate::canopen
