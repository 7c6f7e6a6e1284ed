// SPDX-License-Identifier: Apache-2.0
// The wire as a whole: link, NMT, its own heartbeat and SYNC, what nodes say, floods, counters, the decode log.
#include "adapters/can/babble_watch.hpp"
#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = bus::UnsolicitedEvent::Kind;

using CanopenWireTest = CanopenWireStage;

TEST_F(CanopenWireTest, asks_the_link_for_what_its_nodes_send_and_counts_what_the_link_lost) {
  EXPECT_EQ(link->filters.size(), 8u + 2u * 5u);
  EXPECT_THAT(link->filters, testing::Contains(can::CanFilter{.id = 0x581}));
  EXPECT_THAT(link->filters, testing::Contains(can::CanFilter{.id = 0x482}));
  link->troubles.lost_in = 5;
  link->troubles.bad_bytes = 3;
  EXPECT_EQ(wire->statistics().dropped_bytes, 8u);
}

TEST_F(CanopenWireTest, an_nmt_command_is_sent_before_what_waits_and_ends_ok_in_the_next_turn) {
  wire->send(nmt_of(0x80, 2));
  EXPECT_THAT(link->sent, ElementsAre(frame_of(0x000, "80 02")));
  EXPECT_EQ(link->urgent_sent, link->sent);
  EXPECT_THAT(told, IsEmpty()) << "nothing is told from inside send()";
  runtime.run_due();
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(CanopenWireTest, an_nmt_command_given_up_or_lost_with_the_link_before_its_end_is_not_reported) {
  wire->send(nmt_of(1, 0));
  wire->abandon();
  runtime.advance_by(1s);
  wire->send(nmt_of(1, 1));
  link->events->on_link_down("gone");
  runtime.advance_by(1s);
  EXPECT_THAT(replies, IsEmpty());
}

// --- Own heartbeat, SYNC --------------------------------------------------------------------------------------------

const CanFrame kBootUp = frame_of(0x77F, "00");
const CanFrame kHeartbeat = frame_of(0x77F, "05");

TEST_F(CanopenWireTest, the_heartbeat_begins_with_one_boot_up_and_keeps_its_period_while_the_link_is_up) {
  make({.name = "can0", .own_heartbeat = 100ms, .nodes = {{.node = 1}}});
  runtime.advance_by(1s);
  EXPECT_THAT(link->sent, IsEmpty()) << "not before the link is up";
  link->events->on_link_up();
  runtime.run_due();
  EXPECT_THAT(link->sent, ElementsAre(kBootUp, kHeartbeat));
  runtime.advance_by(1s);
  EXPECT_EQ(link->sent.size(), 2u + 10u);
  link->events->on_link_down("bus-off");
  link->sent.clear();
  runtime.advance_by(1s);
  EXPECT_THAT(link->sent, IsEmpty());
  link->events->on_link_up();
  runtime.run_due();
  EXPECT_THAT(link->sent, ElementsAre(kHeartbeat)) << "a boot-up would tell the drives that their master was reset";
}

TEST_F(CanopenWireTest, a_drive_that_was_told_to_listen_hears_a_heartbeat_before_anything_else) {
  begin({.name = "can0", .own_heartbeat = 100ms, .nodes = {{.node = 1}}});
  runtime.advance_by(30ms);
  clear();
  wire->send(write_of(0x1017, 100, 2));
  bring(0x581, "60 17 10 00 00 00 00 00");
  EXPECT_THAT(link->sent, testing::Not(testing::Contains(kHeartbeat)));
  clear();
  wire->send(write_of(0x1016, 0x007F012C, 4));
  EXPECT_THAT(link->sent, testing::Not(testing::Contains(kHeartbeat))) << "it does not listen yet";
  clear();
  bring(0x581, "60 16 10 00 00 00 00 00");
  EXPECT_THAT(link->sent, ElementsAre(kHeartbeat));
  runtime.advance_by(99ms);
  EXPECT_THAT(link->sent, ElementsAre(kHeartbeat)) << "the period begins anew";
  runtime.advance_by(1ms);
  EXPECT_THAT(link->sent, ElementsAre(kHeartbeat, kHeartbeat));
}

TEST_F(CanopenWireTest, sync_is_sent_in_its_period_and_carries_nothing_and_without_periods_nothing_is_sent_unasked) {
  make({.name = "can0", .sync = 10ms, .nodes = {{.node = 1}}});
  link->events->on_link_up();
  runtime.advance_by(95ms);
  EXPECT_THAT(link->sent, testing::Each(frame_of(0x080, "")));
  EXPECT_EQ(link->sent.size(), 10u);
  make({.name = "can0", .nodes = {{.node = 1, .heartbeat = 100ms}}});
  link->events->on_link_up();
  runtime.advance_by(10s);
  EXPECT_THAT(link->sent, IsEmpty());
}

// --- What nodes say -------------------------------------------------------------------------------------------------

TEST_F(CanopenWireTest, a_guarded_node_is_asked_and_its_silence_told) {
  begin({.name = "can0", .nodes = {{.node = 1, .guard_time = 100ms, .life_factor = 2}}});
  bring(0x701, "05");
  runtime.advance_by(100ms);
  EXPECT_THAT(link->sent, ElementsAre(can::remote_frame(0x701, 1)));
  bring(0x701, "85");
  runtime.advance_by(300ms);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present, Kind::gone));
}

TEST_F(CanopenWireTest, a_call_sends_one_remote_frame_while_the_link_is_up_and_its_answer_is_an_unsolicited_event) {
  bring(0x702, "05");
  clear();
  EXPECT_TRUE(wire->call(2));
  EXPECT_THAT(link->sent, ElementsAre(can::remote_frame(0x702, 1)));
  EXPECT_THAT(told, IsEmpty());
  bring(0x702, "05");
  EXPECT_THAT(kinds(), ElementsAre(Kind::present));
  EXPECT_EQ(unsolicited_events[0].state, bus::NodeState::operational);
  link->events->on_link_down("gone");
  EXPECT_TRUE(wire->call(2));
  EXPECT_EQ(link->sent.size(), 1u);
  told.clear();
  bring(0x702, "7F");
  EXPECT_THAT(told, IsEmpty()) << "frames while the link is down are not taken";
}

TEST_F(CanopenWireTest, process_data_are_told_by_their_map_until_their_node_starts_anew) {
  wire->map_process_data(1, 2, {{{0x6041, 0}, 2}, {{0x6064, 0}, 4}});
  bring(0x281, "37 06 E0 B1 FF FF");
  ASSERT_THAT(kinds(), ElementsAre(Kind::values));
  EXPECT_EQ(unsolicited_events[0].node, 1);
  EXPECT_THAT(unsolicited_events[0].fields,
              ElementsAre(bus::ReplyField{{0x6041, 0}, 2, 0x0637}, bus::ReplyField{{0x6064, 0}, 4, 0xFFFFB1E0}));
  bring(0x701, "00");
  bring(0x281, "37 06 E0 B1 FF FF");
  EXPECT_THAT(kinds(), ElementsAre(Kind::values, Kind::started));
  wire->map_process_data(1, 2, {{{0x6041, 0}, 2}});
  bring(0x281, "37 06");
  EXPECT_EQ(unsolicited_events.back().kind, Kind::values);
}

TEST_F(CanopenWireTest, process_data_without_a_map_or_too_short_give_no_values) {
  bring(0x181, "37 06");
  EXPECT_EQ(wire->statistics().bad_frames, 0u) << "nobody mapped it: that is no fault of the frame";
  wire->map_process_data(1, 1, {{{0x6041, 0}, 2}});
  bring(0x181, "37");
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
  bring(can::remote_frame(0x181, 2));
  wire->map_process_data(1, 1, {});
  bring(0x181, "37 06");
  EXPECT_THAT(unsolicited_events, IsEmpty());
}

TEST_F(CanopenWireTest, two_devices_with_contradicting_heartbeats_are_told_and_a_new_period_is_none) {
  begin({.name = "can0", .nodes = {{.node = 1, .heartbeat = 500ms}}});
  flood(0x701, "05", 10, 500ms);
  wire->send(write_of(0x1017, 100, 2));
  bring(0x581, "60 17 10 00 00 00 00 00");
  flood(0x701, "05", 30, 100ms);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present));
  for (int i = 0; i < 10; ++i) flood(0x701, i % 2 == 0 ? "05" : "7F", 1, 250ms);
  EXPECT_EQ(count(Kind::duplicate_node), 1);
}

TEST_F(CanopenWireTest, frames_of_nobody_are_nobodys) {
  for (const std::uint32_t id : {0x000U, 0x080U, 0x083U, 0x583U, 0x601U, 0x77FU, 0x7E5U}) bring(id, "05 00 00 00");
  CanFrame extended = frame_of(0x581, "4B 41 60 00 37 02 00 00");
  extended.extended = true;
  bring(extended);
  bring(can::remote_frame(0x701, 1));
  EXPECT_THAT(told, IsEmpty());
  EXPECT_EQ(wire->statistics(), bus::Statistics{});
}

/// A loop whose clock may move on while nobody is served.
class StalledLoop final : public Runtime {
 public:
  [[nodiscard]] Instant now() const override { return time; }
  [[nodiscard]] std::unique_ptr<Timer> make_timer(std::function<void()> on_expiry) override {
    callback = std::move(on_expiry);
    return std::make_unique<OneTimer>(*this);
  }
  void turn() {
    if (time < deadline) return;
    deadline = kNever;
    callback();
  }
  Instant time = Instant{} + 1h;
  Instant deadline = kNever;
  std::function<void()> callback;

 private:
  struct OneTimer final : Timer {
    explicit OneTimer(StalledLoop& of) : loop(of) {}
    void expires_at(Instant at) override { loop.deadline = at; }
    StalledLoop& loop;
  };
};

TEST_F(CanopenWireTest, heartbeats_that_waited_behind_a_stall_are_heard_before_anybody_is_gone) {
  StalledLoop loop;
  auto scripted = std::make_unique<ScriptedCanLink>();
  ScriptedCanLink& can = *scripted;
  const auto stalled = canopen::make_canopen_wire({.name = "can0", .nodes = {{.node = 1, .heartbeat = 100ms}}},
                                                  std::move(scripted), loop, log);
  stalled->start(*this);
  can.events->on_link_up();
  can.events->on_frame(frame_of(0x701, "05"), loop.time);
  clear();
  loop.time += 1s;
  loop.turn();  // the timer comes first, a second late
  can.events->on_frame(frame_of(0x701, "05"), loop.time - 50ms);
  loop.turn();
  EXPECT_THAT(unsolicited_events, IsEmpty());
  loop.time = loop.deadline;
  loop.turn();
  EXPECT_THAT(kinds(), ElementsAre(Kind::gone)) << "but a silence is one";
}

// --- Floods ---------------------------------------------------------------------------------------------------------

TEST(BabbleWatchTest, lets_the_limit_through_in_each_second_and_tells_once_in_ten_and_never_of_a_rate_within_it) {
  can::BabbleWatch watch(50);
  Instant now = Instant{} + 1h;
  int told = 0;
  for (int second = 0; second < 20; ++second) {
    int passed = 0;
    for (int i = 0; i < 1000; ++i, now += 1ms) {
      const auto verdict = watch.on_frame(now);
      passed += verdict.pass ? 1 : 0;
      told += verdict.tell ? 1 : 0;
    }
    EXPECT_EQ(passed, 50);
  }
  EXPECT_EQ(told, 2);
  can::BabbleWatch quiet(50);
  for (int i = 0; i < 1000; ++i, now += 21ms) {
    const auto verdict = quiet.on_frame(now);
    ASSERT_TRUE(verdict.pass && !verdict.tell) << i;
  }
}

TEST_F(CanopenWireTest, process_data_at_full_bus_load_are_thinned_and_their_id_named) {
  wire->map_process_data(1, 3, {{{0x6041, 0}, 2}});
  flood(0x381, "37 06", 5000);
  EXPECT_EQ(count(Kind::values), can::kMaxProcessDataPerSecond);
  ASSERT_EQ(count(Kind::babbling), 1);
  EXPECT_EQ(std::ranges::find(unsolicited_events, Kind::babbling, &bus::UnsolicitedEvent::kind)->code, 0x381);
}

TEST_F(CanopenWireTest, heartbeats_and_emergencies_are_thinned_by_themselves) {
  flood(0x702, "05", 200);
  flood(0x082, "10 32 04", 200);
  EXPECT_EQ(count(Kind::babbling), 2);
  EXPECT_EQ(count(Kind::present), 1);
  bring(0x081, "10 32 04");
  EXPECT_EQ(unsolicited_events.back().node, 1) << "other nodes are heard as ever";
  EXPECT_EQ(unsolicited_events.back().kind, Kind::emergency);
}

TEST_F(CanopenWireTest, replies_that_nobody_asked_for_and_frames_that_are_none_are_counted_and_named) {
  wire->send(read_of(0x6041));
  flood(0x581, "4B 42 60 00 37 02 00 00", 500);
  EXPECT_THAT(kinds(), ElementsAre(Kind::babbling));
  EXPECT_EQ(unsolicited_events[0].code, 0x581);
  bring(0x581, "4B 41 60 00 37 02 00 00");
  EXPECT_EQ(replies.size(), 1u) << "the true one is still taken";
  begin({.name = "can0", .nodes = {{.node = 1}}});
  flood(0x581, "E0 00 00 00", 500);
  EXPECT_THAT(kinds(), ElementsAre(Kind::babbling));
  EXPECT_EQ(wire->statistics().bad_frames, 500u);
}

TEST_F(CanopenWireTest, replies_that_were_asked_for_come_as_fast_as_we_ask) {
  for (int i = 0; i < 2000; ++i) {
    wire->send(read_of(0x6041));
    bring(0x581, "4B 41 60 00 37 02 00 00");
  }
  EXPECT_EQ(replies.size(), 2000u);
  EXPECT_THAT(unsolicited_events, IsEmpty());
}

// --- Decode log -----------------------------------------------------------------------------------------------------

TEST_F(CanopenWireTest, every_frame_is_logged_while_decoding_is_on) {
  wire->send(read_of(0x6041));
  EXPECT_THAT(log_lines, IsEmpty());
  wire->set_decode(true);
  bring(0x581, "4B 41 60 00 37 02 00 00");
  wire->send(write_of(0x6040, 6, 2));
  bring(0x081, "30");
  EXPECT_THAT(log_lines, ElementsAre("bus can0: <- 581 4B 41 60 00 37 02 00 00  node 1: SDO value 6041:00 = 0x0237",
                                     "bus can0: -> 601 2B 40 60 00 06 00 00 00  node 1: SDO write 6040:00 = 0x0006",
                                     "bus can0: <- 081 30  node 1: EMCY, no code  (bad)"));
}

}  // namespace
}  // namespace axisgate::test
