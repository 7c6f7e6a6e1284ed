// What drives show of themselves on Keya's CAN: heartbeats, twins, floods.
#include "adapters/keya/keya_can_signs.hpp"
#include "adapters/can/babble_watch.hpp"
#include "tests/unit/keya/keya_can_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = bus::Notice::Kind;

constexpr std::string_view kBeat = "01 F4 02 58 00 01 11 10";

class KeyaCanSigns : public KeyaCanStage {
 protected:
  void beat(std::uint8_t node = 1) { bring(keya::kHeartbeatId + node, kBeat); }
  [[nodiscard]] std::vector<Kind> heard_of(std::uint8_t node = 1) {
    bus.notices.clear();
    beat(node);
    return bus.kinds();
  }
  [[nodiscard]] auto count(Kind kind) const { return std::ranges::count(bus.kinds(), kind); }
};

TEST_F(KeyaCanSigns, the_first_heartbeat_says_that_the_drive_is_there_and_each_one_what_it_carries) {
  EXPECT_THAT(heard_of(2), ElementsAre(Kind::present, Kind::values));
  EXPECT_EQ(bus.notices[0].node, 2);
  EXPECT_EQ(bus.notices[0].state, bus::NodeState::operational);
  EXPECT_EQ(bus.notices[1].node, 2);
  const bus::ReplyFields expected{{{0x7000, 0, 0}, 2, 500},
                                  {{0x7000, 0, 2}, 2, 600},
                                  {{0x7000, 0, 4}, 2, 1},
                                  {{0x7000, 0, 6}, 1, 0x11},
                                  {{0x7000, 0, 7}, 1, 0x10}};
  EXPECT_EQ(bus.notices[1].fields, expected);
  runtime.advance_by(1s);
  EXPECT_THAT(heard_of(2), ElementsAre(Kind::values));
}

TEST_F(KeyaCanSigns, after_a_silence_the_drive_is_there_again_and_never_gone_before) {
  beat();
  runtime.advance_by(2001ms);
  EXPECT_EQ(count(Kind::gone), 0);
  EXPECT_THAT(heard_of(), ElementsAre(Kind::present, Kind::values));
}

TEST_F(KeyaCanSigns, one_heartbeat_that_is_missed_is_no_news) {
  beat();
  runtime.advance_by(2s);
  EXPECT_THAT(heard_of(), ElementsAre(Kind::values));
}

TEST_F(KeyaCanSigns, after_a_loss_of_the_link_the_drive_is_there_again) {
  beat();
  link->events->on_link_down("pulled");
  link->events->on_link_up();
  EXPECT_THAT(heard_of(), ElementsAre(Kind::present, Kind::values));
}

TEST_F(KeyaCanSigns, a_heartbeat_neither_answers_nor_disturbs_an_exchange) {
  wire->send(read_of(0x2103, 1));
  beat();
  EXPECT_THAT(bus.replies, IsEmpty());
  bring(0x05800001, "60 03 21 01 00 01 00 02");
  EXPECT_EQ(bus.replies.size(), 1u);
}

TEST_F(KeyaCanSigns, a_heartbeat_of_another_length_is_counted_and_says_nothing) {
  bring(keya::kHeartbeatId + 1, "01 F4 02 58 00 01 11");
  EXPECT_THAT(bus.notices, IsEmpty());
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
}

TEST_F(KeyaCanSigns, two_replies_to_one_request_are_two_drives) {
  wire->send(write_of(0x200D, 1, 0));
  for (int i = 0; i < 3; ++i) bring(0x05800001, "60 0D 20 01 00 00 00 00");
  EXPECT_EQ(bus.replies.size(), 1u);
  EXPECT_THAT(bus.kinds(), ElementsAre(Kind::twin)) << "told once in a while";
  EXPECT_EQ(bus.notices[0].node, 1);
  EXPECT_EQ(wire->statistics().late_replies, 2u);
  runtime.advance_by(keya::CanSigns::kTellTwinAgain);
  wire->send(read_of(0x2103, 1));
  bring(0x05800001, "60 03 21 01 00 01 00 02");
  bring(0x05800001, "60 03 21 01 00 03 00 04");
  EXPECT_EQ(count(Kind::twin), 2);
}

TEST_F(KeyaCanSigns, a_late_reply_of_the_one_drive_is_no_twin) {
  wire->send(read_of(0x2103, 1));
  wire->abandon();
  wire->send(read_of(0x2103, 1));
  bring(0x05800001, "60 03 21 01 00 01 00 02");
  bring(0x05800001, "60 03 21 01 00 01 00 02");
  EXPECT_EQ(bus.replies.size(), 1u);
  EXPECT_THAT(bus.notices, IsEmpty());
}

TEST_F(KeyaCanSigns, a_reply_long_after_is_no_twin) {
  wire->send(read_of(0x2103, 1));
  bring(0x05800001, "60 03 21 01 00 01 00 02");
  runtime.advance_by(201ms);
  bring(0x05800001, "60 03 21 01 00 01 00 02");
  EXPECT_THAT(bus.notices, IsEmpty());
}

TEST_F(KeyaCanSigns, heartbeats_that_flood_the_bus_are_thinned_and_named) {
  for (int i = 0; i < 1000; ++i) beat(2);
  EXPECT_EQ(count(Kind::values), can::kMaxSignsPerSecond);
  ASSERT_EQ(count(Kind::babbling), 1);
  const auto told = std::ranges::find(bus.notices, Kind::babbling, &bus::Notice::kind);
  EXPECT_EQ(told->code, 0x0700);
  EXPECT_EQ(told->node, 2);
  EXPECT_THAT(heard_of(1), ElementsAre(Kind::present, Kind::values)) << "others are heard as ever";
}

TEST_F(KeyaCanSigns, replies_that_nobody_asked_for_are_named_and_the_true_one_is_still_taken) {
  wire->send(read_of(0x2103, 1));
  for (int i = 0; i < 500; ++i) bring(0x05800001, "60 12 21 01 00 00 00 00");
  EXPECT_THAT(bus.kinds(), ElementsAre(Kind::babbling));
  EXPECT_EQ(bus.notices[0].code, 0x0580);
  EXPECT_EQ(wire->statistics().late_replies, 500u);
  bring(0x05800001, "60 03 21 01 00 01 00 02");
  EXPECT_EQ(bus.replies.size(), 1u);
}

TEST_F(KeyaCanSigns, replies_that_were_asked_for_come_as_fast_as_we_ask) {
  for (int i = 0; i < 2000; ++i) {
    wire->send(read_of(0x2103, 1));
    bring(0x05800001, "60 03 21 01 00 01 00 02");
  }
  EXPECT_EQ(bus.replies.size(), 2000u);
  EXPECT_THAT(bus.notices, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
