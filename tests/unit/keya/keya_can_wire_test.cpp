// Exchanges on Keya's CAN: one reply each, none that belongs to another.
#include "adapters/keya/keya_fields.hpp"
#include "tests/unit/keya/keya_can_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using KeyaCanWireTest = KeyaCanStage;

constexpr std::uint32_t kReply1 = 0x05800001;
constexpr std::uint32_t kReply2 = 0x05800002;

TEST_F(KeyaCanWireTest, asks_the_link_for_replies_and_heartbeats_of_its_nodes_alone) {
  const auto passes = [this](std::uint32_t id) {
    return std::ranges::any_of(link->filters, [&](const can::CanFilter& f) { return f.passes(extended(id, "00")); });
  };
  for (const std::uint32_t id : {0x05800001u, 0x05800002u, 0x07000001u, 0x07000002u}) EXPECT_TRUE(passes(id)) << id;
  for (const std::uint32_t id : {0x05800003u, 0x06000001u, 0x07000003u, 0x01800001u}) EXPECT_FALSE(passes(id)) << id;
  can::CanFrame standard = extended(0x001, "00");
  standard.extended = false;
  EXPECT_FALSE(std::ranges::any_of(link->filters, [&](const can::CanFilter& f) { return f.passes(standard); }));
}

TEST_F(KeyaCanWireTest, one_query_brings_the_fields_of_both_motors) {
  wire->send(pair_of(0x2103, 1));
  EXPECT_THAT(link->sent, ElementsAre(extended(0x06000001, "40 03 21 01 00 00 00 00")));
  bring(kReply1, "60 03 21 01 01 F5 FE 0E");
  EXPECT_THAT(bus.replies, ElementsAre(pair_value(0x2103, 1, 501, 0xFE0E)));
}

TEST_F(KeyaCanWireTest, fields_of_any_width_are_cut_big_endian_from_their_byte) {
  bus::Exchange temperatures = read_of(0x210F, 1, 0, 2);
  temperatures.more.push_back({{0x210F, 1, 2}, 1});
  temperatures.more.push_back({{0x210F, 1, 3}, 1});
  wire->send(temperatures);
  bring(kReply1, "60 0F 21 01 00 22 19 1A");
  bus::ExchangeResult expected = value_of(0x210F, 1, 2, 34);
  expected.fields.push_back({{0x210F, 1, 2}, 1, 0x19});
  expected.fields.push_back({{0x210F, 1, 3}, 1, 0x1A});
  EXPECT_THAT(bus.replies, ElementsAre(expected));
}

TEST_F(KeyaCanWireTest, a_read_of_no_width_brings_all_four_bytes) {
  wire->send(read_of(0x2104, 3));
  bring(kReply1, "60 04 21 03 FF FE 79 60");
  EXPECT_THAT(bus.replies, ElementsAre(value_of(0x2104, 3, 4, 0xFFFE7960)));
}

TEST_F(KeyaCanWireTest, a_command_goes_out_big_endian_and_is_acknowledged) {
  wire->send(write_of(0x2000, 2, -10000));
  EXPECT_THAT(link->sent, ElementsAre(extended(0x06000001, "23 00 20 02 FF FF D8 F0")));
  bring(kReply1, "60 00 20 02 00 00 00 00");
  EXPECT_THAT(bus.replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(KeyaCanWireTest, an_acknowledgement_may_leave_out_the_motor_but_not_name_the_other) {
  wire->send(write_of(0x200D, 2, 0));
  bring(kReply1, "60 0D 20 01 00 00 00 00");
  EXPECT_THAT(bus.replies, IsEmpty()) << "that is motor A's";
  bring(kReply1, "60 0D 20 00 00 00 00 00");
  EXPECT_THAT(bus.replies, ElementsAre(bus::ExchangeResult{}));
}

TEST_F(KeyaCanWireTest, an_acknowledgement_does_not_answer_a_read_nor_a_value_a_write) {
  wire->send(read_of(0x2100, 1));
  bring(kReply1, "60 00 20 01 00 00 00 00");
  EXPECT_THAT(bus.replies, IsEmpty()) << "speed of motor A, acknowledged: only the index's high byte differs";
  bring(kReply1, "60 00 21 01 00 03 00 04");
  EXPECT_EQ(bus.replies.size(), 1u);
  wire->send(write_of(0x2000, 1, 5));
  bring(kReply1, "60 00 21 01 00 03 00 04");
  EXPECT_EQ(bus.replies.size(), 1u);
  bring(kReply1, "60 00 20 01 00 00 00 00");
  EXPECT_EQ(bus.replies.size(), 2u);
}

TEST_F(KeyaCanWireTest, a_value_of_another_sub_index_is_not_the_one_asked_for) {
  wire->send(read_of(0x2104, 2));
  bring(kReply1, "60 04 21 03 00 00 27 10");
  bring(kReply1, "60 04 21 00 00 00 27 10");
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 2u);
}

TEST_F(KeyaCanWireTest, a_reply_of_another_node_is_counted_and_not_taken) {
  wire->send(read_of(0x2104, 2));
  bring(kReply2, "60 04 21 02 00 00 27 10");
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(KeyaCanWireTest, frames_of_another_form_are_never_taken) {
  wire->send(read_of(0x2104, 2));
  can::CanFrame standard = extended(0x001, "60 04 21 02 00 00 27 10");
  standard.extended = false;
  bring(standard);
  bring(0x01800001, "60 04 21 02 00 00 27 10");
  bring(0x05800003, "60 04 21 02 00 00 27 10");
  EXPECT_EQ(wire->statistics().bad_frames, 0u) << "what others say is not ours to judge";
  bring(kReply1, "60 04 21 02 00 00 27");
  bring(kReply1, "43 04 21 02 00 00 27 10");
  bring(kReply1, "40 04 21 02 00 00 00 00");
  can::CanFrame remote = extended(kReply1, "60 04 21 02 00 00 27 10");
  remote.remote = true;
  bring(remote);
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().bad_frames, 4u);
  bring(kReply1, "60 04 21 02 00 00 27 10");
  EXPECT_EQ(bus.replies.size(), 1u);
}

TEST_F(KeyaCanWireTest, a_reply_after_abandon_is_counted_and_answers_nothing_else) {
  wire->send(read_of(0x2103, 1));
  wire->abandon();
  wire->send(read_of(0x2112, 1));
  bring(kReply1, "60 03 21 01 01 F5 FE 0E");
  EXPECT_THAT(bus.replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  bring(kReply1, "60 12 21 01 08 11 00 11");
  EXPECT_THAT(bus.replies, ElementsAre(value_of(0x2112, 1, 4, 0x08110011)));
}

TEST_F(KeyaCanWireTest, what_the_protocol_cannot_say_is_refused_and_not_sent) {
  bus::Exchange of_two_bytes = write_of(0x2000, 1, 5);
  of_two_bytes.size = 2;
  bus::Exchange of_two_fields = write_of(0x2000, 1, 5);
  of_two_fields.more.push_back({{0x2000, 2}, 4, 5});
  const std::vector<std::pair<bus::Exchange, std::uint32_t>> cases{
      {of_two_bytes, keya::kWrongLength},
      {of_two_fields, keya::kWrongLength},
      {write_of(0x2000, 0, 5), keya::kNoSubIndex},
      {write_of(0x2000, 3, 5), keya::kNoSubIndex},
      {write_of(0x2103, 1, 5), keya::kReadOnly},
      {read_of(0x2000, 1), keya::kWriteOnly},
      {read_of(0x2103, 1, 3, 2), keya::kWrongLength},
      {read_of(0x2103, 1, 0, 3), keya::kWrongLength},
  };
  for (const auto& [exchange, code] : cases) {
    bus.replies.clear();
    wire->send(exchange);
    EXPECT_THAT(bus.replies, IsEmpty()) << "never from inside send()";
    runtime.run_due();
    EXPECT_THAT(bus.replies, ElementsAre(refusal_with(code)));
  }
  EXPECT_THAT(link->sent, IsEmpty());
}

TEST_F(KeyaCanWireTest, a_refusal_is_not_told_after_abandon_or_a_loss_of_the_link) {
  wire->send(read_of(0x2000, 1));
  wire->abandon();
  runtime.run_due();
  wire->send(read_of(0x2000, 1));
  link->events->on_link_down("gone");
  runtime.run_due();
  EXPECT_THAT(bus.replies, IsEmpty());
}

TEST_F(KeyaCanWireTest, a_lost_link_takes_the_awaited_answer_along) {
  wire->send(read_of(0x2103, 1));
  link->events->on_link_down("can1: bus-off");
  bring(kReply1, "60 03 21 01 01 F5 FE 0E");
  link->events->on_link_up();
  bring(kReply1, "60 03 21 01 01 F5 FE 0E");
  EXPECT_THAT(bus.told, ElementsAre("down: can1: bus-off", "up"));
  EXPECT_EQ(wire->statistics().reconnects, 1u);
}

TEST_F(KeyaCanWireTest, the_next_request_may_go_out_from_inside_a_reply) {
  wire->send(write_of(0x200D, 1, 0));
  bus.then_send = [this] {
    bus.then_send = nullptr;
    wire->send(write_of(0x200D, 2, 0));
  };
  bring(kReply1, "60 0D 20 01 00 00 00 00");
  bring(kReply1, "60 0D 20 02 00 00 00 00");
  EXPECT_EQ(bus.replies.size(), 2u);
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

TEST_F(KeyaCanWireTest, destroyed_with_an_exchange_outstanding_it_calls_nobody) {
  wire->send(read_of(0x2000, 1));
  wire.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(bus.told, IsEmpty());
}

}  // namespace
}  // namespace axisgate::test
