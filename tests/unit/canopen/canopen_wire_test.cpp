// The wire as a whole: link, NMT, its own heartbeat and SYNC, counters, the decode log.
#include "tests/unit/canopen/canopen_wire_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = bus::Notice::Kind;

using CanopenWireTest = CanopenWireStage;

TEST_F(CanopenWireTest, asks_the_link_for_what_its_nodes_send) {
  EXPECT_EQ(link->filters.size(), 2u * 7u);
  EXPECT_THAT(link->filters, testing::Contains(can::CanFilter{.id = 0x581}));
  EXPECT_THAT(link->filters, testing::Contains(can::CanFilter{.id = 0x702}));
}

TEST_F(CanopenWireTest, reports_the_link_in_turn_and_counts_its_returns) {
  link->events->on_link_down("can0 is down: ip link set can0 up");
  link->events->on_link_down("can0 is still down");
  link->events->on_link_up();
  EXPECT_THAT(told, ElementsAre("down: can0 is down: ip link set can0 up", "up"));
  EXPECT_EQ(wire->statistics().reconnects, 1u);
}

TEST_F(CanopenWireTest, frames_that_the_link_lost_are_counted) {
  link->troubles.lost_in = 5;
  link->troubles.bad_bytes = 3;
  EXPECT_EQ(wire->statistics().dropped_bytes, 8u);
}

// --- NMT ------------------------------------------------------------------------------------------------------------

TEST_F(CanopenWireTest, an_nmt_command_is_sent_before_what_waits_and_ends_ok_in_the_next_turn) {
  wire->send(nmt_of(0x80, 2));
  EXPECT_THAT(link->sent, ElementsAre(frame_of(0x000, "80 02")));
  EXPECT_EQ(link->urgent_sent, link->sent);
  EXPECT_THAT(told, IsEmpty()) << "nothing is told from inside send()";
  runtime.run_due();
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(CanopenWireTest, an_nmt_command_given_up_before_its_end_is_not_reported) {
  wire->send(nmt_of(1, 0));
  wire->abandon();
  runtime.advance_by(1s);
  EXPECT_THAT(told, IsEmpty());
}

TEST_F(CanopenWireTest, a_link_lost_in_the_same_turn_ends_it_for_the_bus) {
  wire->send(nmt_of(1, 1));
  link->events->on_link_down("gone");
  runtime.advance_by(1s);
  EXPECT_THAT(replies, IsEmpty());
}

// --- Own heartbeat, SYNC
// ----------------------------------------------------------------------------------------------

const CanFrame kBootUp = frame_of(0x77F, "00");
const CanFrame kHeartbeat = frame_of(0x77F, "05");

class OwnFrames : public CanopenWireStage {
 protected:
  /// Not yet up.
  void made(canopen::CanopenSettings settings) {
    wire.reset();
    auto scripted = std::make_unique<ScriptedCanLink>();
    link = scripted.get();
    wire = canopen::make_canopen_wire(std::move(settings), std::move(scripted), runtime, log);
    wire->start(*this);
  }
};

TEST_F(OwnFrames, the_heartbeat_begins_with_a_boot_up_and_keeps_its_period) {
  made({.name = "can0", .own_heartbeat = 100ms, .nodes = {{.node = 1}}});
  runtime.advance_by(1s);
  EXPECT_THAT(link->sent, IsEmpty()) << "not before the link is up";
  link->events->on_link_up();
  runtime.run_due();
  EXPECT_THAT(link->sent, ElementsAre(kBootUp, kHeartbeat));
  runtime.advance_by(1s);
  EXPECT_EQ(link->sent.size(), 2u + 10u);
}

TEST_F(OwnFrames, after_a_link_loss_the_heartbeat_goes_on_without_a_boot_up) {
  made({.name = "can0", .own_heartbeat = 100ms, .nodes = {{.node = 1}}});
  link->events->on_link_up();
  runtime.run_due();
  link->events->on_link_down("bus-off");
  link->sent.clear();
  runtime.advance_by(1s);
  EXPECT_THAT(link->sent, IsEmpty());
  link->events->on_link_up();
  runtime.run_due();
  EXPECT_THAT(link->sent, ElementsAre(kHeartbeat)) << "a boot-up would tell the drives that their master was reset";
}

TEST_F(OwnFrames, sync_is_sent_in_its_period_and_carries_nothing) {
  made({.name = "can0", .sync = 10ms, .nodes = {{.node = 1}}});
  link->events->on_link_up();
  runtime.advance_by(95ms);
  EXPECT_THAT(link->sent, testing::Each(frame_of(0x080, "")));
  EXPECT_EQ(link->sent.size(), 10u);
}

TEST_F(OwnFrames, without_periods_nothing_is_sent_unasked) {
  made({.name = "can0", .nodes = {{.node = 1, .heartbeat = 100ms}}});
  link->events->on_link_up();
  runtime.advance_by(10s);
  EXPECT_THAT(link->sent, IsEmpty());
}

// --- What nodes say
// ---------------------------------------------------------------------------------------------------

TEST_F(CanopenWireTest, presence_restart_and_absence_are_told) {
  begin({.name = "can0", .nodes = {{.node = 1, .heartbeat = 100ms}}});
  bring(0x701, "05");
  runtime.advance_by(249ms);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present));
  runtime.advance_by(1ms);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present, Kind::gone));
  bring(0x701, "00");
  EXPECT_EQ(notices.back().kind, Kind::started);
}

TEST_F(CanopenWireTest, a_guarded_node_is_asked_and_its_silence_told) {
  begin({.name = "can0", .nodes = {{.node = 1, .guard_time = 100ms, .life_factor = 2}}});
  bring(0x701, "05");
  runtime.advance_by(100ms);
  EXPECT_THAT(link->sent, ElementsAre(can::remote_frame(0x701, 1)));
  bring(0x701, "85");
  runtime.advance_by(300ms);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present, Kind::gone));
}

TEST_F(CanopenWireTest, a_call_sends_one_remote_frame_and_its_answer_is_a_notice) {
  bring(0x702, "05");
  clear();
  EXPECT_TRUE(wire->call(2));
  EXPECT_THAT(link->sent, ElementsAre(can::remote_frame(0x702, 1)));
  EXPECT_THAT(told, IsEmpty());
  bring(0x702, "05");
  EXPECT_THAT(kinds(), ElementsAre(Kind::present));
  EXPECT_EQ(notices[0].state, bus::NodeState::operational);
}

TEST_F(CanopenWireTest, calling_while_the_link_is_down_sends_nothing) {
  link->events->on_link_down("gone");
  EXPECT_TRUE(wire->call(2));
  EXPECT_THAT(link->sent, IsEmpty());
}

TEST_F(CanopenWireTest, process_data_are_told_by_their_map) {
  wire->map_process_data(1, 2, {{{0x6041, 0}, 2}, {{0x6064, 0}, 4}});
  bring(0x281, "37 06 E0 B1 FF FF");
  ASSERT_THAT(kinds(), ElementsAre(Kind::values));
  EXPECT_EQ(notices[0].node, 1);
  EXPECT_THAT(notices[0].fields,
              ElementsAre(bus::ReplyField{{0x6041, 0}, 2, 0x0637}, bus::ReplyField{{0x6064, 0}, 4, 0xFFFFB1E0}));
}

TEST_F(CanopenWireTest, process_data_of_a_node_that_has_started_anew_are_dropped_until_they_are_mapped_again) {
  wire->map_process_data(1, 1, {{{0x6041, 0}, 2}});
  bring(0x701, "00");
  bring(0x181, "37 06");
  EXPECT_THAT(kinds(), ElementsAre(Kind::started));
  wire->map_process_data(1, 1, {{{0x6041, 0}, 2}});
  bring(0x181, "37 06");
  EXPECT_EQ(notices.back().kind, Kind::values);
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
  EXPECT_THAT(notices, IsEmpty());
}

TEST_F(CanopenWireTest, an_emergency_storm_is_told_in_few_notices) {
  for (int i = 0; i < 40; ++i) bring(0x081, "10 32 04 00 00 00 00 00");
  EXPECT_EQ(notices.size(), 4u);
  runtime.advance_by(1s);
  ASSERT_EQ(notices.size(), 5u);
  EXPECT_EQ(notices.back().repeats, 35u);
}

TEST_F(CanopenWireTest, two_devices_with_contradicting_heartbeats_are_told) {
  begin({.name = "can0", .nodes = {{.node = 1, .heartbeat = 500ms}}});
  for (int i = 0; i < 5; ++i) {
    bring(0x701, "05");
    runtime.advance_by(250ms);
    bring(0x701, "7F");
    runtime.advance_by(250ms);
  }
  EXPECT_EQ(std::ranges::count(kinds(), Kind::twin), 1);
}

TEST_F(CanopenWireTest, a_new_heartbeat_period_is_no_second_device) {
  begin({.name = "can0", .nodes = {{.node = 1, .heartbeat = 500ms}}});
  const auto beats = [&](int count, Duration gap) {
    for (int i = 0; i < count; ++i) {
      bring(0x701, "05");
      runtime.advance_by(gap);
    }
  };
  beats(10, 500ms);
  wire->send(write_of(0x1017, 100, 2));
  bring(0x581, "60 17 10 00 00 00 00 00");
  beats(30, 100ms);
  EXPECT_THAT(kinds(), ElementsAre(Kind::present));
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

TEST_F(CanopenWireTest, frames_while_the_link_is_down_are_not_taken) {
  link->events->on_link_down("gone");
  told.clear();
  bring(0x701, "05");
  EXPECT_THAT(told, IsEmpty());
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
  ScriptedCanLink& bus = *scripted;
  const auto stalled = canopen::make_canopen_wire({.name = "can0", .nodes = {{.node = 1, .heartbeat = 100ms}}},
                                                  std::move(scripted), loop, log);
  stalled->start(*this);
  bus.events->on_link_up();
  bus.events->on_frame(frame_of(0x701, "05"), loop.time);
  clear();
  loop.time += 1s;
  loop.turn();  // the timer comes first, a second late
  bus.events->on_frame(frame_of(0x701, "05"), loop.time - 50ms);
  loop.turn();
  EXPECT_THAT(notices, IsEmpty());
  loop.time = loop.deadline;
  loop.turn();
  EXPECT_THAT(kinds(), ElementsAre(Kind::gone)) << "but a silence is one";
}

// --- Decode log
// -------------------------------------------------------------------------------------------------------

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
