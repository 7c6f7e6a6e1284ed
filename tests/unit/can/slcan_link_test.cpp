// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/link/slcan_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/can/can_diary.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

/// The serial line, moved by the test alone.
class FakePort final : public bus::ByteLink {
 public:
  explicit FakePort(FakePort** self) { *self = this; }
  void start(bus::ByteLinkEvents& events) override { link = &events; }
  void send(Bytes bytes) override { sent.append(bytes.begin(), bytes.end()); }
  void reopen(std::string_view /*why*/) override { ++reopened; }
  void say(std::string_view text) { link->on_bytes(Bytes(reinterpret_cast<const Byte*>(text.data()), text.size())); }
  std::string take_sent() { return std::exchange(sent, {}); }

  bus::ByteLinkEvents* link = nullptr;
  std::string sent;
  int reopened = 0;
};

class SlcanLinkTest : public testing::Test {
 protected:
  SlcanLinkTest() {
    link = std::make_unique<can::SlcanLink>("lift", can::CanDevice{.lawicel = true, .path = "/dev/adapter"}, 250000,
                                            std::make_unique<FakePort>(&port), runtime, log);
  }
  /// The port is up, the channel is not yet open.
  void begin(std::vector<can::CanFilter> filters = kEverything) {
    link->start(diary, std::move(filters));
    port->link->on_link_up();
  }
  void start(std::vector<can::CanFilter> filters = kEverything) {
    begin(std::move(filters));
    port->say("\aV2\r\r\r");
    runtime.run_due();
    port->say("F00\r");
    (void)port->take_sent();
    runtime.advance_by(10ms);
  }

  ManualRuntime runtime;
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel level, std::string_view, std::string_view message) {
    log_lines.push_back(fmt::format("{}: {}", text(level), message));
  }};
  CanDiary diary;
  FakePort* port = nullptr;
  std::unique_ptr<can::SlcanLink> link;
};

TEST_F(SlcanLinkTest, comes_up_once_the_channel_is_open) {
  begin();
  EXPECT_EQ(port->take_sent(), "\r\r\rC\rV\r");
  port->say("t1230\r\aV2\r\r");
  EXPECT_TRUE(diary.told.empty());
  EXPECT_TRUE(diary.frames.empty()) << "frames before the channel is open are nobody's";
  EXPECT_EQ(port->take_sent(), "S5\rO\r");
  port->say("\r");
  EXPECT_THAT(diary.told, ElementsAre("up"));
  EXPECT_THAT(log_lines, ElementsAre("info: /dev/adapter: Lawicel adapter V2, channel open"));
}

TEST_F(SlcanLinkTest, an_adapter_that_never_answers_is_said_to_tell_no_errors) {
  begin();
  runtime.advance_by(1s);
  EXPECT_THAT(diary.told, ElementsAre("up"));
  EXPECT_THAT(log_lines, ElementsAre(HasSubstr("acknowledges nothing")));
}

TEST_F(SlcanLinkTest, frames_are_handed_over_in_order_at_any_split_of_their_bytes) {
  start();
  const std::string bytes = "t1231AA\rT000001232BBCC\rr7031\rt583004D2\r";
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    diary.frames.clear();
    port->say(bytes.substr(0, cut));
    port->say(bytes.substr(cut));
    ASSERT_EQ(diary.frames.size(), 4) << cut;
    EXPECT_EQ(diary.frames[0], frame_of(0x123, 0xAA));
    EXPECT_TRUE(diary.frames[1].extended);
    EXPECT_TRUE(diary.frames[2].remote);
    EXPECT_EQ(diary.frames[3].id, 0x583);
  }
  EXPECT_EQ(diary.instants.back(), runtime.now());
}

TEST_F(SlcanLinkTest, only_what_a_filter_passes_is_handed_over) {
  start({{.id = 0x583}});
  port->say("t1230\rt5830\rT000005830\r");
  ASSERT_EQ(diary.frames.size(), 1);
  EXPECT_EQ(diary.frames[0].id, 0x583);
}

TEST_F(SlcanLinkTest, one_turn_hands_over_no_more_than_its_bound_and_the_next_the_rest) {
  start();
  std::string many;
  for (int i = 0; i < 150; ++i) many += "t1230\r";
  port->say(many);
  EXPECT_EQ(diary.frames.size(), can::kMaxFramesPerTurn);
  port->say("t4560\r");
  EXPECT_LE(diary.frames.size(), 2 * can::kMaxFramesPerTurn);
  runtime.run_due();
  ASSERT_EQ(diary.frames.size(), 151);
  EXPECT_EQ(diary.frames.back().id, 0x456);
}

TEST_F(SlcanLinkTest, more_bytes_than_the_backlog_holds_are_counted_as_lost) {
  start();
  port->say(std::string(can::SlcanLink::kMaxBacklog - 6, '\r') + "t1230\r");
  std::string many;
  for (int i = 0; i < 3000; ++i) many += "t1230\r";
  port->say(many.substr(0, can::SlcanLink::kMaxBacklog));
  port->say(many.substr(0, can::SlcanLink::kMaxBacklog));
  EXPECT_EQ(link->trouble().lost_in, 1);
  runtime.run_due();
  EXPECT_TRUE(diary.up());
}

TEST_F(SlcanLinkTest, send_calls_nobody_back_when_the_queue_is_full) {
  start();
  for (std::size_t i = 0; i < can::kMaxUnsentFrames + 10; ++i) link->send(frame_of(1), false);
  EXPECT_TRUE(diary.up());
  runtime.run_due();
  EXPECT_THAT(diary.told.back(), HasSubstr("down: /dev/adapter: the bus is overloaded"));
  runtime.advance_by(1s);
  port->say("V2\r\r\r");
  EXPECT_TRUE(diary.up());
  EXPECT_EQ(link->trouble().reconnects, 1);
}

TEST_F(SlcanLinkTest, the_loss_of_the_port_is_told_once_with_its_reason_and_the_way_back) {
  start();
  port->say("t12");
  port->link->on_link_down("/dev/adapter: hung up");
  runtime.advance_by(10s);
  EXPECT_THAT(diary.told, ElementsAre("up", "down: /dev/adapter: hung up"));
  port->link->on_link_up();
  port->say("V2\r\r\r");
  EXPECT_THAT(diary.told, ElementsAre("up", "down: /dev/adapter: hung up", "up"));
  EXPECT_EQ(link->trouble().reconnects, 1);
  port->say("30\r");
  EXPECT_TRUE(diary.frames.empty()) << "half a frame before the loss and half after it are none";
}

TEST_F(SlcanLinkTest, an_adapter_that_refuses_is_logged_once_not_each_second) {
  begin();
  for (int i = 0; i < 5; ++i) {
    port->say("V2\r\a");
    runtime.advance_by(1s);
  }
  EXPECT_TRUE(diary.told.empty()) << "it was never up";
  EXPECT_THAT(log_lines,
              ElementsAre("warning: /dev/adapter: the adapter refuses the bit rate 250000; trying again each "
                          "second"));
}

TEST_F(SlcanLinkTest, bytes_of_no_line_are_counted_and_without_end_take_the_link_down) {
  start();
  port->say("\xFF\xFEhello\rt1230\r");
  EXPECT_EQ(link->trouble().bad_bytes, 8);
  EXPECT_EQ(diary.frames.size(), 1);
  for (int i = 0; i < 12 && diary.up(); ++i) {
    port->say("\xFF\xFE\xFD");
    runtime.advance_by(10ms);
  }
  EXPECT_THAT(diary.told.back(), HasSubstr("what no Lawicel adapter sends"));
}

TEST_F(SlcanLinkTest, noise_with_frames_in_between_is_borne) {
  start();
  for (int i = 0; i < 100; ++i) {
    port->say("\xFF\xFE\xFDt1230\r");
    runtime.advance_by(5ms);
    if (i % 50 == 0) port->say("F00\r");
  }
  EXPECT_TRUE(diary.up());
}

TEST_F(SlcanLinkTest, whom_it_tells_may_destroy_it) {
  start();
  diary.on_received = [this] { link.reset(); };
  port->say("t1230\rt1230\r");
  EXPECT_EQ(diary.frames.size(), 1);
  EXPECT_EQ(link, nullptr);
}

}  // namespace
}  // namespace axisgate::test
