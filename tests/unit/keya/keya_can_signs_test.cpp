// SPDX-License-Identifier: Apache-2.0
// What drives show of themselves on Keya's CAN: heartbeats, duplicate node-IDs, floods.
#include "adapters/keya/keya_can_signs.hpp"
#include "adapters/can/babble_watch.hpp"
#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = bus::UnsolicitedEvent::Kind;

constexpr std::string_view kBeat = "01 F4 02 58 00 01 11 10";
constexpr std::string_view kSpeed = "60 03 21 01 00 01 00 02";

class KeyaCanSigns : public KeyaCanStage {
 protected:
  [[nodiscard]] std::vector<Kind> heard_of(std::uint8_t node = 1) {
    unsolicited_events.clear();
    bring(keya::kHeartbeatId + node, kBeat);
    return kinds();
  }
  /// A request for the speed, and so many answers to it.
  void ask_and_hear(int answers = 1) {
    wire->send(read_of(0x2103, 1));
    for (int i = 0; i < answers; ++i) bring(kReply1, kSpeed);
  }
};

TEST_F(KeyaCanSigns, the_first_heartbeat_says_that_the_drive_is_there_and_each_one_what_it_carries) {
  EXPECT_THAT(heard_of(2), ElementsAre(Kind::present, Kind::values));
  EXPECT_EQ(unsolicited_events[0].node, 2);
  EXPECT_EQ(unsolicited_events[0].state, bus::NodeState::operational);
  EXPECT_EQ(unsolicited_events[1].node, 2);
  const bus::ReplyFields expected{{{0x7000, 0, 0}, 2, 500},
                                  {{0x7000, 0, 2}, 2, 600},
                                  {{0x7000, 0, 4}, 2, 1},
                                  {{0x7000, 0, 6}, 1, 0x11},
                                  {{0x7000, 0, 7}, 1, 0x10}};
  EXPECT_EQ(unsolicited_events[1].fields, expected);
  runtime.advance_by(2s);
  EXPECT_THAT(heard_of(2), ElementsAre(Kind::values)) << "one that is missed is no news";
}

TEST_F(KeyaCanSigns, after_a_silence_or_a_loss_of_the_link_the_drive_is_there_again_and_never_gone_before) {
  EXPECT_EQ(heard_of().size(), 2u);
  runtime.advance_by(2001ms);
  EXPECT_EQ(unsolicited_events.size(), 2u);
  EXPECT_THAT(heard_of(), ElementsAre(Kind::present, Kind::values));
  link->events->on_link_down("pulled");
  link->events->on_link_up();
  EXPECT_THAT(heard_of(), ElementsAre(Kind::present, Kind::values));
}

TEST_F(KeyaCanSigns, a_heartbeat_of_another_length_is_counted_and_says_nothing) {
  bring(keya::kHeartbeatId + 1, "01 F4 02 58 00 01 11");
  EXPECT_THAT(unsolicited_events, IsEmpty());
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
}

TEST_F(KeyaCanSigns, two_replies_to_one_request_are_two_drives) {
  ask_and_hear(3);
  EXPECT_EQ(replies.size(), 1u);
  EXPECT_THAT(kinds(), ElementsAre(Kind::duplicate_node)) << "told once in a while";
  EXPECT_EQ(unsolicited_events[0].node, 1);
  EXPECT_EQ(wire->statistics().late_replies, 2u);
  runtime.advance_by(keya::CanSigns::kTellDuplicateNodeAgain);
  ask_and_hear(2);
  EXPECT_THAT(kinds(), ElementsAre(Kind::duplicate_node, Kind::duplicate_node));
}

TEST_F(KeyaCanSigns, a_reply_that_was_given_up_and_one_long_after_are_no_duplicate_node_ids) {
  wire->send(read_of(0x2103, 1));
  wire->abandon();
  ask_and_hear(2);
  EXPECT_EQ(replies.size(), 1u);
  ask_and_hear();
  runtime.advance_by(201ms);
  bring(kReply1, kSpeed);
  EXPECT_THAT(unsolicited_events, IsEmpty());
}

TEST_F(KeyaCanSigns, heartbeats_that_flood_the_bus_are_thinned_and_named) {
  for (int i = 0; i < 1000; ++i) bring(keya::kHeartbeatId + 2, kBeat);
  EXPECT_EQ(std::ranges::count(kinds(), Kind::values), can::kMaxSignsPerSecond);
  ASSERT_EQ(std::ranges::count(kinds(), Kind::babbling), 1);
  const auto told_of = std::ranges::find(unsolicited_events, Kind::babbling, &bus::UnsolicitedEvent::kind);
  EXPECT_EQ(told_of->code, 0x0700);
  EXPECT_EQ(told_of->node, 2);
  EXPECT_THAT(heard_of(1), ElementsAre(Kind::present, Kind::values)) << "others are heard as ever";
}

TEST_F(KeyaCanSigns, replies_that_nobody_asked_for_are_named_and_the_true_one_is_still_taken) {
  wire->send(read_of(0x2103, 1));
  for (int i = 0; i < 500; ++i) bring(kReply1, "60 12 21 01 00 00 00 00");
  EXPECT_THAT(kinds(), ElementsAre(Kind::babbling));
  EXPECT_EQ(unsolicited_events[0].code, 0x0580);
  EXPECT_EQ(wire->statistics().late_replies, 500u);
  bring(kReply1, kSpeed);
  EXPECT_EQ(replies.size(), 1u);
}

}  // namespace
}  // namespace axisgate::test
