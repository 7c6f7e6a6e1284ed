// SPDX-License-Identifier: Apache-2.0
// Replies that come too late, over wire, link, libmodbus and a pty: three reads of one register each, the first one's
// answer late. The wire by itself keeps apart what was heard before a request from what was heard after it; a late
// answer of the right unit, function and length that comes after the next request cannot be told from that one's, and
// is why a drive that was late gets a resynchronisation read before anything it says counts. And a line that babbles,
// over the same road.
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "tests/unit/modbus_rtu/libmodbus_link_stage.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class LateReplies : public LibmodbusLinkStage, private bus::WireEvents {
 protected:
  void SetUp() override {
    wire = std::make_unique<modbus_rtu::RtuWire>("lift", std::vector{kinco_node(1), kinco_node(2)},
                                                 modbus_rtu::LineSpeed{}, make_link(pty.device()), runtime, log);
    wire->start(*this);
    ASSERT_TRUE(await([this] { return up; }));
  }
  void on_wire_up() override {
    up = true;
    ++ups;
  }
  void on_wire_down(std::string_view) override { up = false; }
  void on_reply(const bus::ExchangeResult& result) override { replies.push_back(result); }

  void ask(const bus::Exchange& exchange) {
    wire->send(exchange);
    request_at(pty, 8);
  }
  void ask(std::uint16_t at, std::uint8_t size = 2) { ask(read_of(at, size)); }
  void ask_and_give_up(const bus::Exchange& exchange) {
    ask(exchange);
    wire->abandon();
  }
  void ask_and_give_up(std::uint16_t at) { ask_and_give_up(read_of(at)); }
  [[nodiscard]] bool heard_late(std::uint32_t count) {
    return await([&] { return wire->statistics().late_replies == count; });
  }
  [[nodiscard]] bool answered(std::size_t count) {
    return await([&] { return replies.size() == count; });
  }

  Pty pty;
  bool up = false;
  int ups = 0;
  std::vector<bus::ExchangeResult> replies;
  std::unique_ptr<modbus_rtu::RtuWire> wire;
};

constexpr const char* kHundred = "01 03 02 00 64";
constexpr const char* kTwoHundred = "01 03 02 00 C8";
constexpr const char* kThreeHundred = "01 03 02 01 2C";

TEST_F(LateReplies, before_the_next_request_are_counted_and_the_next_answers_are_right) {
  ask_and_give_up(100);
  answer(pty, kHundred);
  ASSERT_TRUE(heard_late(1));
  ask(200);
  answer(pty, kTwoHundred);
  ASSERT_TRUE(answered(1));
  ask(300);
  answer(pty, kThreeHundred);
  ASSERT_TRUE(answered(2));
  EXPECT_THAT(replies, ElementsAre(value_of(200, 2, 200), value_of(300, 2, 300)));
}

TEST_F(LateReplies, after_the_next_request_are_taken_for_its_answer_by_a_wire_alone) {
  ask_and_give_up(100);
  ask(200);
  answer(pty, kHundred);
  ASSERT_TRUE(answered(1));
  EXPECT_THAT(replies, ElementsAre(value_of(200, 2, 100))) << "unit, function and length fit";
  answer(pty, kTwoHundred);
  ASSERT_TRUE(heard_late(1)) << "and the true answer is then nobody's";
}

TEST_F(LateReplies, of_another_length_than_the_next_request_asks_for_do_not_answer_it) {
  // What a resynchronisation read does.
  ask_and_give_up(100);
  ask(200, 4);
  answer(pty, kHundred);
  ASSERT_TRUE(heard_late(1));
  EXPECT_THAT(replies, IsEmpty());
  answer(pty, "01 03 04 00 C8 00 00");
  ASSERT_TRUE(answered(1));
  EXPECT_THAT(replies, ElementsAre(value_of(200, 4, 200)));
}

TEST_F(LateReplies, of_several_lost_requests_all_come_and_all_are_counted) {
  for (const int at : {100, 200, 300}) ask_and_give_up(static_cast<std::uint16_t>(at));
  ask(400, 4);
  for (const char* late : {kHundred, kTwoHundred, kThreeHundred}) answer(pty, late);
  answer(pty, "01 03 04 01 90 00 00");
  ASSERT_TRUE(answered(1));
  EXPECT_THAT(replies, ElementsAre(value_of(400, 4, 400)));
  EXPECT_EQ(wire->statistics().late_replies, 3u);
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
}

TEST_F(LateReplies, of_another_drive_do_not_answer_this_one) {
  ask_and_give_up(read_of(100, 2, 2));
  ask(100);
  answer(pty, "02 03 02 FF FF");
  answer(pty, kHundred);
  ASSERT_TRUE(answered(1));
  EXPECT_THAT(replies, ElementsAre(value_of(100, 2, 100)));
  EXPECT_EQ(wire->statistics().late_replies, 1u);
}

TEST_F(LateReplies, to_a_write_do_not_acknowledge_another) {
  ask(100);  // on a line without echo, as one read shows
  answer(pty, kHundred);
  ASSERT_TRUE(answered(1));
  replies.clear();
  ask_and_give_up(write_of(0x3100, 0x2F, 2));
  ask(write_of(0x3100, 0x3F, 2));
  answer(pty, "01 06 31 00 00 2F");
  ASSERT_TRUE(heard_late(1));
  EXPECT_THAT(replies, IsEmpty());
  answer(pty, "01 06 31 00 00 3F");
  ASSERT_TRUE(answered(1));
}

TEST_F(LateReplies, of_before_a_loss_of_the_line_answer_nothing_after_it) {
  ask(100);
  pty.hang_up();
  ASSERT_TRUE(await([this] { return !up; }));
  EXPECT_THAT(replies, IsEmpty());
}

TEST_F(LateReplies, a_line_that_babbles_is_opened_anew_and_serves_when_it_is_quiet) {
  const ByteRow babble(16, 0x55);
  ASSERT_TRUE(await([&] {
    static_cast<void>(::write(pty.master(), babble.data(), babble.size()));
    runtime.advance_by(1ms);
    return ups == 2;
  }));
  EXPECT_GE(wire->statistics().reconnects, 1u);
  EXPECT_GT(wire->statistics().dropped_bytes, 0u);
  ASSERT_TRUE(await([this] {
    // What is left of the babble may still open the line anew, and it may be down meanwhile.
    runtime.advance_by(10ms);
    if (up && replies.empty()) {
      wire->abandon();
      wire->send(read_of(100));
      static_cast<void>(pty.read());
      answer(pty, kHundred);
    }
    return !replies.empty();
  }));
  EXPECT_THAT(replies, ElementsAre(value_of(100, 2, 100)));
}

}  // namespace
}  // namespace axisgate::test
