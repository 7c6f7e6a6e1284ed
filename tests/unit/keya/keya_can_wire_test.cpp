// SPDX-License-Identifier: Apache-2.0
// Exchanges on Keya's CAN. What the wire shares with others is in tests/unit/bus/wire_rules_test.cpp.
#include "tests/unit/keya/keya_frames.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using KeyaCanWireTest = KeyaCanStage;

constexpr std::string_view kEncoder = "60 04 21 02 00 00 27 10";

/// On the bus, though not by Keya's rules.
can::CanFrame standard(std::string_view hex) {
  can::CanFrame frame = extended(0x001, hex);
  frame.extended = false;
  return frame;
}

TEST_F(KeyaCanWireTest, asks_the_link_for_replies_and_heartbeats_of_its_nodes_alone) {
  const auto passes = [this](const can::CanFrame& frame) {
    return std::ranges::any_of(link->filters, [&](const can::CanFilter& f) { return f.passes(frame); });
  };
  for (const std::uint32_t id : {0x05800001u, 0x05800002u, 0x07000001u, 0x07000002u}) {
    EXPECT_TRUE(passes(extended(id, "00"))) << id;
  }
  for (const std::uint32_t id : {0x05800003u, 0x06000001u, 0x07000003u, 0x01800001u}) {
    EXPECT_FALSE(passes(extended(id, "00"))) << id;
  }
  EXPECT_FALSE(passes(standard("00")));
}

TEST_F(KeyaCanWireTest, one_query_brings_fields_of_any_width_big_endian_from_their_byte) {
  wire->send(pair_of(0x2103, 1));
  EXPECT_THAT(link->sent, ElementsAre(extended(0x06000001, "40 03 21 01 00 00 00 00")));
  bring(kReply1, "60 03 21 01 01 F5 FE 0E");
  bus::Exchange temperatures = read_of(0x210F, 1, 0, 2);
  temperatures.more.push_back({{0x210F, 1, 2}, 1});
  temperatures.more.push_back({{0x210F, 1, 3}, 1});
  wire->send(temperatures);
  bring(kReply1, "60 0F 21 01 00 22 19 1A");
  bus::ExchangeResult degrees = value_of(0x210F, 2, 34, 1);
  degrees.fields.push_back({{0x210F, 1, 2}, 1, 0x19});
  degrees.fields.push_back({{0x210F, 1, 3}, 1, 0x1A});
  wire->send(read_of(0x2104, 3));
  bring(kReply1, "60 04 21 03 FF FE 79 60");
  EXPECT_THAT(replies, ElementsAre(pair_value(0x2103, 1, 501, 0xFE0E), degrees, value_of(0x2104, 4, 0xFFFE7960, 3)))
      << "no width: all four bytes";
}

TEST_F(KeyaCanWireTest, an_acknowledgement_may_leave_out_the_motor_but_not_name_the_other) {
  wire->send(write_of(0x2000, 2, -10000));
  EXPECT_THAT(link->sent, ElementsAre(extended(0x06000001, "23 00 20 02 FF FF D8 F0")));
  bring(kReply1, "60 00 20 01 00 00 00 00");
  EXPECT_THAT(replies, IsEmpty()) << "that is motor A's";
  bring(kReply1, "60 00 20 02 00 00 00 00");
  wire->send(write_of(0x200D, 2, 0));
  bring(kReply1, "60 0D 20 00 00 00 00 00");
  EXPECT_THAT(replies, ElementsAre(bus::ExchangeResult{}, bus::ExchangeResult{}));
}

TEST_F(KeyaCanWireTest, replies_of_another_sub_index_or_node_are_counted_as_late_and_frames_of_another_form_as_bad) {
  wire->send(read_of(0x2104, 2));
  bring(kReply1, "60 04 21 03 00 00 27 10");
  bring(kReply1, "60 04 21 00 00 00 27 10");
  bring(0x05800002, kEncoder);
  EXPECT_EQ(wire->statistics().late_replies, 3u);
  bring(standard(kEncoder));
  bring(0x01800001, kEncoder);
  bring(0x05800003, kEncoder);
  EXPECT_EQ(wire->statistics().bad_frames, 0u) << "what others say is not ours to judge";
  for (const char* hex : {"60 04 21 02 00 00 27", "43 04 21 02 00 00 27 10", "40 04 21 02 00 00 00 00"}) {
    bring(kReply1, hex);
  }
  can::CanFrame remote = extended(kReply1, kEncoder);
  remote.remote = true;
  bring(remote);
  EXPECT_EQ(wire->statistics().bad_frames, 4u);
  EXPECT_THAT(replies, IsEmpty());
  bring(kReply1, kEncoder);
  EXPECT_EQ(replies.size(), 1u);
}

TEST_F(KeyaCanWireTest, what_the_protocol_cannot_say_is_refused_and_not_sent) {
  bus::Exchange of_two_bytes = write_of(0x2000, 1, 5);
  of_two_bytes.size = 2;
  bus::Exchange of_two_fields = write_of(0x2000, 1, 5);
  of_two_fields.more.push_back({{0x2000, 2}, 4, 5});
  expect_refusals({{of_two_bytes, keya::kWrongLength},
                   {of_two_fields, keya::kWrongLength},
                   {write_of(0x2000, 0, 5), keya::kNoSubIndex},
                   {write_of(0x2000, 3, 5), keya::kNoSubIndex},
                   {write_of(0x2103, 1, 5), keya::kReadOnly},
                   {read_of(0x2000, 1), keya::kWriteOnly},
                   {read_of(0x2103, 1, 3, 2), keya::kWrongLength},
                   {read_of(0x2103, 1, 0, 3), keya::kWrongLength}});
  EXPECT_THAT(link->sent, IsEmpty());
}

TEST_F(KeyaCanWireTest, a_refusal_is_not_told_after_abandon_a_loss_of_the_link_or_its_end) {
  wire->send(read_of(0x2000, 1));
  wire->abandon();
  runtime.run_due();
  wire->send(read_of(0x2000, 1));
  link->events->on_link_down("gone");
  runtime.run_due();
  link->events->on_link_up();
  wire->send(read_of(0x2000, 1));
  wire.reset();
  runtime.run_due();
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(KeyaCanWireTest, decodes_every_frame_into_the_log_when_asked) {
  wire->send(read_of(0x2103, 1));
  wire->abandon();
  EXPECT_THAT(log_lines, IsEmpty());
  wire->set_decode(true);
  wire->send(write_of(0x2000, 1, -500));
  bring(kReply1, "60 03 21 01 01 F5 FE 0E");
  bring(kReply1, "60 00 20 01 00 00 00 00");
  bring(0x07000001, "01 F4 02 58 00 01 11 10");
  EXPECT_THAT(log_lines,
              ElementsAre("bus can1: -> 06000001 23 00 20 01 FF FF FE 0C  speed of motor A = -500",
                          "bus can1: <- 05800001 60 03 21 01 01 F5 FE 0E  speed: A 501, B -498  (late)",
                          "bus can1: <- 05800001 60 00 20 01 00 00 00 00  acknowledged: speed of motor A",
                          "bus can1: <- 07000001 01 F4 02 58 00 01 11 10  heartbeat: angle A 500, B 600, faults A "
                          "0x0001, state 0x1110"));
}

}  // namespace
}  // namespace axisgate::test
