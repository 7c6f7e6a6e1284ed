// SPDX-License-Identifier: Apache-2.0
// SDO servers of small stacks: answers without a size, short objects in segments, aborts that name no object, answers
// that name another one. And nodes that nobody has configured.
#include "tests/unit/canopen/sdo_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = bus::UnsolicitedEvent::Kind;

class SmallStack : public CanopenWireStage {
 protected:
  /// What a read comes to with this answer.
  bus::ExchangeResult answer_of(const bus::Exchange& asked, std::string_view reply) {
    clear();
    wire->send(asked);
    bring(0x581, reply);
    if (replies.empty()) {
      wire->abandon();
      return {.code = Errc::timed_out};
    }
    return replies.back();
  }
  [[nodiscard]] std::size_t lines_with(std::string_view words) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        log_lines, [&](const std::string& line) { return line.find(words) != std::string::npos; }));
  }
};

// --- No size ---------------------------------------------------------------------------------------------------------

TEST_F(SmallStack, an_answer_that_does_not_say_its_size_has_the_one_that_was_asked_for) {
  EXPECT_EQ(answer_of(read_of(0x6041, 0, 2), "42 41 60 00 50 02 00 00"), value_of(0x6041, 2, 0x0250));
  EXPECT_EQ(answer_of(read_of(0x6041, 0, 2), "42 41 60 00 50 02 AB CD"), value_of(0x6041, 2, 0x0250))
      << "what stands above it is nobody's";
  EXPECT_EQ(answer_of(read_of(0x6061, 0, 1), "42 61 60 00 FF 02 AB CD"), value_of(0x6061, 1, 0xFF));
  EXPECT_EQ(answer_of(read_of(0x6064, 0, 4), "42 64 60 00 E0 B1 FF FF"), value_of(0x6064, 4, 0xFFFFB1E0));
  EXPECT_EQ(answer_of(read_of(0x6041, 0, 2), "42 41 60 00 50 02"), value_of(0x6041, 2, 0x0250)) << "a short frame";
  EXPECT_EQ(answer_of(read_of(0x6041, 0, 2), "4A 41 60 00 50 02 00 00"), value_of(0x6041, 2, 0x0250))
      << "the bits of a size that is not said";
}

TEST_F(SmallStack, nor_was_one_asked_for_it_has_four_bytes) {
  EXPECT_EQ(answer_of(read_of(0x2000), "42 00 20 00 50 02 00 00"), value_of(0x2000, 4, 0x0250));
  EXPECT_EQ(answer_of(read_of(0x2000, 0, 4), "42 00 20 00 50 02"), bus::ExchangeResult{.code = Errc::timed_out})
      << "two bytes are no four";
}

// --- Short objects in segments ---------------------------------------------------------------------------------------

TEST_F(SmallStack, a_short_object_in_a_segment_is_one_exchange) {
  for (const char* begins : {"41 41 60 00 02 00 00 00", "40 41 60 00 00 00 00 00"}) {
    clear();
    wire->send(read_of(0x6041, 0, 2));
    bring(0x581, begins);
    EXPECT_THAT(link->sent,
                ElementsAre(frame_of(0x601, "40 41 60 00 00 00 00 00"), frame_of(0x601, "60 00 00 00 00 00 00 00")));
    EXPECT_THAT(replies, IsEmpty());
    bring(0x581, "0B 50 02 00 00 00 00 00");
    EXPECT_THAT(replies, ElementsAre(value_of(0x6041, 2, 0x0250))) << begins;
  }
}

TEST_F(SmallStack, one_that_turns_out_to_be_longer_is_refused_and_ended) {
  for (const char* segment : {"04 4C 44 32 2D 43 00 00", "00 4C 44 32 2D 43 41 4E", "0C 50 00 00 00 00 00 00"}) {
    clear();
    wire->send(read_of(0x1008, 0, 4));
    bring(0x581, "40 08 10 00 00 00 00 00");
    bring(0x581, segment);
    EXPECT_EQ(link->sent.back(), frame_of(0x601, "80 08 10 00 22 00 00 08")) << segment;
    EXPECT_THAT(replies, ElementsAre(refusal_of(0x06070010, true)));
  }
}

// --- Aborts that name nothing ----------------------------------------------------------------------------------------

TEST_F(SmallStack, an_abort_that_names_no_object_is_that_of_the_one_open_request) {
  EXPECT_EQ(answer_of(read_of(0x6079), "80 00 00 00 00 00 02 06"), refusal_of(0x06020000));
  EXPECT_EQ(answer_of(write_of(0x6060, 9, 1), "80 00 00 00 10 00 06 06"), refusal_of(0x06060010, true));
  EXPECT_EQ(wire->statistics().late_replies, 0u);
}

TEST_F(SmallStack, where_a_late_answer_is_awaited_it_may_be_that_one) {
  wire->send(read_of(0x6079));
  wire->abandon();
  wire->send(read_of(0x6041, 0, 2));
  bring(0x581, "80 00 00 00 00 00 02 06");
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  bring(0x581, "4B 41 60 00 50 02 00 00");
  EXPECT_EQ(replies.size(), 1u);
  // A server answers in order: what it has not answered by now it never will.
  EXPECT_EQ(answer_of(read_of(0x6079), "80 00 00 00 00 00 02 06"), refusal_of(0x06020000));
}

TEST_F(SmallStack, the_answer_to_the_same_object_again_proves_nothing_of_that) {
  wire->send(read_of(0x6041, 0, 2));
  wire->abandon();
  EXPECT_EQ(answer_of(read_of(0x6041, 0, 2), "4B 41 60 00 50 02 00 00").code, Errc::ok);
  EXPECT_EQ(answer_of(read_of(0x6079), "80 00 00 00 00 00 02 06").code, Errc::timed_out);
}

TEST_F(SmallStack, nor_is_it_taken_behind_an_abort_of_ours_which_it_may_answer) {
  wire->send(long_read_of(0x1008));
  bring(0x581, "41 08 10 00 0B 00 00 00");
  clear();
  wire->send(read_of(0x6079));
  ASSERT_EQ(link->sent.size(), 2u) << "the long read is ended first";
  bring(0x581, "80 00 00 00 22 00 00 08");
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(SmallStack, nor_behind_a_boot_up_that_has_crossed_the_request) {
  wire->send(read_of(0x6041));
  bring(0x701, "00");
  wire->abandon();
  EXPECT_EQ(answer_of(read_of(0x6079), "80 00 00 00 00 00 02 06").code, Errc::timed_out);
}

// --- Another object's answer -----------------------------------------------------------------------------------------

TEST_F(SmallStack, an_answer_of_another_object_is_counted_and_told_by_both) {
  EXPECT_EQ(answer_of(read_of(0x6041, 0, 2), "4B 40 60 00 50 02 00 00").code, Errc::timed_out);
  EXPECT_EQ(wire->statistics().late_replies, 1u);
  EXPECT_THAT(log_lines, ElementsAre(AllOf(HasSubstr("node 1"), HasSubstr("6041:00"), HasSubstr("6040:00"))));
}

TEST_F(SmallStack, it_is_told_once_a_minute_with_how_often) {
  for (int i = 0; i < 10; ++i, runtime.advance_by(1s))
    static_cast<void>(answer_of(read_of(0x6041, 0, 2), "4B 40 60 00 50 02 00 00"));
  EXPECT_EQ(lines_with("6040:00"), 1u);
  runtime.advance_by(1min);
  static_cast<void>(answer_of(read_of(0x6041, 0, 2), "4B 40 60 00 50 02 00 00"));
  EXPECT_EQ(lines_with("6040:00"), 2u);
  EXPECT_THAT(log_lines.back(), HasSubstr("9 more"));
}

TEST_F(SmallStack, it_is_not_told_of_a_late_answer_nor_of_another_masters_beside_our_own) {
  wire->send(read_of(0x6064, 0, 4));
  wire->abandon();
  static_cast<void>(answer_of(read_of(0x6041, 0, 2), "43 64 60 00 50 02 00 00"));  // given up, late
  wire->send(read_of(0x6041, 0, 2));
  bring(0x581, "4B 40 60 00 50 02 00 00");
  bring(0x581, "4B 41 60 00 50 02 00 00");
  EXPECT_EQ(replies.back(), value_of(0x6041, 2, 0x0250));
  EXPECT_THAT(log_lines, IsEmpty());
}

// --- Nodes that nobody has configured --------------------------------------------------------------------------------

TEST_F(SmallStack, a_node_that_is_heard_and_that_no_drive_has_is_named_once) {
  bring(0x705, "05");
  bring(0x705, "05");
  bring(0x706, "00");
  bring(0x087, "30 81 10 01 02 03 04 05");
  bring(0x701, "05");
  EXPECT_EQ(lines_with("node 5 is heard on this bus"), 1u);
  EXPECT_EQ(lines_with("node 6 is heard on this bus"), 1u);
  EXPECT_EQ(lines_with("node 7 is heard on this bus"), 1u);
  EXPECT_EQ(log_lines.size(), 3u);
  link->events->on_link_down("unplugged");
  link->events->on_link_up();
  bring(0x705, "05");
  EXPECT_EQ(lines_with("node 5 is heard on this bus"), 1u);
}

TEST_F(SmallStack, what_only_looks_like_a_node_is_none) {
  bring(0x705, "");       // no error control
  bring(0x705, "05 00");  // neither
  bring(0x705, "20");     // no state
  bring(0x087, "01 02");  // no EMCY
  bring(0x587, "4B 41 60 00 00 00 00 00");
  bring(can::CanFrame{.id = 0x705, .remote = true, .size = 1});
  EXPECT_THAT(log_lines, IsEmpty());
}

TEST_F(SmallStack, of_all_numbers_each_is_named_once) {
  for (int round = 0; round < 3; ++round)
    for (std::uint32_t node = 3; node <= 127; ++node) bring(0x700 + node, "05");
  EXPECT_EQ(log_lines.size(), 125u);
}

}  // namespace
}  // namespace axisgate::test
