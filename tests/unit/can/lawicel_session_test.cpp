#include "adapters/can/lawicel_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisgate::can {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class LawicelSessionTest : public testing::Test {
 protected:
  void hear(std::string_view bytes) {
    for (const char byte : bytes) {
      if (const auto line = decoder.push(static_cast<Byte>(byte))) session.on_line(*line, now);
    }
  }
  /// Each deadline up to then, in order.
  void pass(Duration time) {
    const Instant end = now + time;
    while (session.due(now) <= end) {
      now = std::max(now, session.due(now));
      session.on_deadline(now);
    }
    now = end;
  }
  std::string said() { return session.take_output(); }
  void send(std::uint32_t id, bool urgent = false) { session.send(data_frame(id, {}), urgent, now); }
  /// Up, with an adapter that answers everything.
  void open() {
    session.on_port_up(now);
    hear("\r\r\r\rV1013\r");
    hear("\r");
    hear("\r");
    ASSERT_TRUE(session.up());
    pass(0ms);
    hear("F00\r");
    pass(100ms);
    (void)said();
  }

  Instant now = Instant{} + 1h;
  LawicelDecoder decoder;
  LawicelSession session{CanDevice{.lawicel = true, .path = "/dev/adapter"}, 500000};
};

TEST_F(LawicelSessionTest, closes_sets_the_rate_and_opens_each_after_the_answer) {
  session.on_port_up(now);
  EXPECT_EQ(said(), "\r\r\rC\rV\r");
  hear("\a\a\a\a");
  EXPECT_EQ(said(), "") << "a closed channel refuses to be closed";
  hear("V1013\r");
  EXPECT_EQ(said(), "S6\r");
  hear("\r");
  EXPECT_EQ(said(), "O\r");
  EXPECT_FALSE(session.up());
  hear("\r");
  EXPECT_TRUE(session.up());
  EXPECT_EQ(session.version(), "1013");
  EXPECT_TRUE(session.answers());
}

TEST_F(LawicelSessionTest, an_adapter_that_never_answers_works) {
  session.on_port_up(now);
  (void)said();
  pass(300ms);
  EXPECT_EQ(said(), "S6\r");
  pass(300ms);
  EXPECT_EQ(said(), "O\r");
  pass(300ms);
  EXPECT_TRUE(session.up());
  EXPECT_FALSE(session.answers());
  pass(10s);
  EXPECT_EQ(said(), "F\rF\rF\r") << "three unanswered questions are enough";
  send(0x123);
  EXPECT_EQ(said(), "t1230\r");
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, each_silent_step_costs_its_wait_and_no_more) {
  for (const char silent : {'V', 'S', 'O'}) {
    session.on_port_down("cable");
    session.on_port_up(now);
    const Instant begun = now;
    const auto answer_or_wait = [&](char step, std::string_view answer) {
      if (step == silent) {
        pass(300ms);
      } else {
        hear(answer);
      }
    };
    answer_or_wait('V', "V1\r");
    answer_or_wait('S', "\r");
    answer_or_wait('O', "\r");
    EXPECT_TRUE(session.up()) << silent;
    EXPECT_EQ(now - begun, 300ms) << silent;
  }
}

TEST_F(LawicelSessionTest, a_refused_rate_is_told_and_tried_again_from_the_beginning) {
  session.on_port_up(now);
  hear("V1\r\a");
  EXPECT_FALSE(session.up());
  EXPECT_THAT(session.why(), HasSubstr("/dev/adapter: the adapter refuses the bit rate 500000"));
  (void)said();
  pass(999ms);
  EXPECT_EQ(said(), "");
  pass(1ms);
  EXPECT_EQ(said(), "\r\r\rC\rV\r");
  hear("V1\r\r\r");
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, a_channel_that_is_refused_is_told_and_tried_again) {
  session.on_port_up(now);
  hear("V1\r\r\a");
  EXPECT_THAT(session.why(), HasSubstr("refuses to open"));
  (void)said();
  pass(1s);
  EXPECT_EQ(said(), "\r\r\rC\rV\r");
}

TEST_F(LawicelSessionTest, frames_of_a_channel_that_was_left_open_answer_nothing) {
  session.on_port_up(now);
  (void)said();
  hear("t1230\rt1230\r");
  EXPECT_EQ(said(), "");
  hear("V1\rt1230\r");
  EXPECT_EQ(said(), "S6\r");
}

TEST_F(LawicelSessionTest, frames_go_out_one_after_another_at_the_pace_of_the_port) {
  open();
  for (const std::uint32_t id : {1U, 2U, 3U}) send(id);
  EXPECT_EQ(said(), "t0010\r");
  const Duration one = Duration(6 * 10 * 1'000'000'000LL / 115200);
  pass(one - 1us);
  EXPECT_EQ(said(), "");
  pass(1us);
  EXPECT_EQ(said(), "t0020\r");
  pass(one);
  EXPECT_EQ(said(), "t0030\r");
}

TEST_F(LawicelSessionTest, an_acknowledgement_lets_the_next_frame_go_at_once) {
  for (const std::string_view acknowledgement : {"\r", "z\r", "Z\r"}) {
    open();
    send(1);
    send(2);
    EXPECT_EQ(said(), "t0010\r");
    hear(acknowledgement);
    EXPECT_EQ(said(), "t0020\r");
    session.on_port_down("");
  }
}

TEST_F(LawicelSessionTest, an_urgent_frame_goes_before_what_waits) {
  open();
  send(1);
  send(2);
  send(3, true);
  hear("z\rz\r");
  EXPECT_EQ(said(), "t0010\rt0030\rt0020\r");
}

TEST_F(LawicelSessionTest, more_frames_than_the_bound_take_the_link_down) {
  open();
  for (std::size_t i = 0; i <= kMaxUnsentFrames; ++i) send(1);
  EXPECT_TRUE(session.up()) << "one went out, the others wait";
  send(1);
  EXPECT_FALSE(session.up());
  EXPECT_THAT(session.why(), HasSubstr("overloaded: 64 frames wait"));
}

TEST_F(LawicelSessionTest, a_frame_that_waits_for_too_long_takes_the_link_down) {
  LawicelSession slow(CanDevice{.lawicel = true, .path = "/dev/adapter", .baud = 300}, 500000);
  slow.on_port_up(now);
  for (int i = 0; i < 3; ++i) slow.on_deadline(now += 300ms);
  ASSERT_TRUE(slow.up());
  slow.on_deadline(now += 2s);
  for (int i = 0; i < 4; ++i) slow.send(data_frame(1, {}), false, now);
  EXPECT_EQ(slow.due(now) > now, true);
  slow.on_deadline(now + kMaxSendWait);
  EXPECT_FALSE(slow.up());
  EXPECT_THAT(slow.why(), HasSubstr("overloaded"));
}

TEST_F(LawicelSessionTest, frames_refused_in_a_row_mean_bus_off_and_the_channel_is_opened_anew) {
  open();
  for (int i = 1; i <= 8; ++i) {
    EXPECT_TRUE(session.up());
    hear("\a");
  }
  EXPECT_FALSE(session.up());
  EXPECT_THAT(session.why(), HasSubstr("refuses frames"));
  EXPECT_EQ(session.trouble().no_ack, 8);
  EXPECT_EQ(session.trouble().bus_offs, 1);
  (void)said();
  pass(1s);
  EXPECT_EQ(said(), "\r\r\rC\rV\r");
  hear("V1\r\r\r");
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, refusals_between_acknowledgements_or_frames_are_borne) {
  open();
  for (const std::string_view sign_of_life : {"z\r", "\r", "t1230\r"}) {
    for (int i = 0; i < 7; ++i) hear("\a");
    hear(sign_of_life);
  }
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, the_sixth_bus_off_in_a_minute_leaves_the_channel_alone_for_a_minute) {
  open();
  for (int off = 0; off < 6; ++off) {
    hear("\a\a\a\a\a\a\a\a");
    ASSERT_FALSE(session.up());
    (void)said();
    if (off == 5) break;
    pass(1s);
    hear("V1\r\r\r");
    ASSERT_TRUE(session.up());
    pass(0ms);
    hear("F00\r");
  }
  EXPECT_THAT(session.why(), HasSubstr("more than 5 times in a minute"));
  pass(59s);
  EXPECT_EQ(said(), "");
  pass(1s);
  EXPECT_EQ(said(), "\r\r\rC\rV\r");
}

TEST_F(LawicelSessionTest, a_port_opened_anew_begins_without_a_record) {
  open();
  for (int off = 0; off < 6; ++off) {
    hear("\a\a\a\a\a\a\a\a");
    session.on_port_down("cable");
    open();
  }
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, the_status_is_asked_for_twice_a_second_where_it_is_answered) {
  open();
  for (int i = 0; i < 10; ++i) {
    pass(500ms);
    EXPECT_EQ(said(), "F\r");
    hear("F00\r");
  }
  EXPECT_TRUE(session.up());
  EXPECT_EQ(session.trouble(), CanTrouble{});
}

TEST_F(LawicelSessionTest, an_adapter_without_status_is_not_asked_again_and_no_worse) {
  session.on_port_up(now);
  hear("V1\r\r\r");
  pass(0ms);
  (void)said();
  hear("\a");
  pass(10s);
  EXPECT_EQ(said(), "");
  EXPECT_TRUE(session.up());
  EXPECT_EQ(session.trouble().no_ack, 0);
}

TEST_F(LawicelSessionTest, an_adapter_that_answered_and_falls_silent_hangs) {
  open();
  pass(2s);
  EXPECT_FALSE(session.up());
  EXPECT_THAT(session.why(), HasSubstr("answers no more"));
  pass(1s);
  EXPECT_THAT(said(), HasSubstr("C\r"));
}

TEST_F(LawicelSessionTest, error_passive_with_errors_and_a_full_queue_is_a_bus_where_nobody_acknowledges) {
  open();
  pass(500ms);
  hear("FA2\r");  // bus error, error passive, transmit queue full
  EXPECT_FALSE(session.up());
  EXPECT_THAT(session.why(), HasSubstr("nobody acknowledges"));
  EXPECT_EQ(session.trouble().error_passive, 1);
  EXPECT_EQ(session.trouble().send_waits, 1);
  send(1);
  EXPECT_THAT(said(), testing::Not(HasSubstr("t0010"))) << "nothing is sent into a dead bus";
  pass(500ms);
  hear("FA2\r");
  EXPECT_FALSE(session.up());
  hear("t1230\r");
  EXPECT_TRUE(session.up()) << "somebody is there";
}

TEST_F(LawicelSessionTest, a_clean_status_ends_the_trouble) {
  open();
  pass(500ms);
  hear("FA2\r");
  pass(500ms);
  hear("F00\r");
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, error_passive_that_lasts_is_told_without_a_full_queue) {
  open();
  pass(500ms);
  hear("FA0\r");
  EXPECT_TRUE(session.up());
  pass(500ms);
  EXPECT_FALSE(session.up());
}

TEST_F(LawicelSessionTest, overruns_are_counted) {
  open();
  pass(500ms);
  hear("F08\r");
  pass(500ms);
  hear("F01\r");
  EXPECT_EQ(session.trouble().lost_in, 2);
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, a_babbling_port_is_told_and_tried_again) {
  open();
  session.on_babble(now);
  EXPECT_FALSE(session.up());
  EXPECT_THAT(session.why(), HasSubstr("no Lawicel adapter"));
  pass(1s);
  EXPECT_THAT(said(), HasSubstr("C\r"));
}

TEST_F(LawicelSessionTest, a_lost_port_is_silent_and_waits_for_nothing) {
  open();
  send(1);
  send(2);
  session.on_port_down("/dev/adapter: hung up");
  EXPECT_FALSE(session.up());
  EXPECT_EQ(session.why(), "/dev/adapter: hung up");
  EXPECT_EQ(said(), "");
  EXPECT_EQ(session.due(now), kNever);
  open();
  pass(100ms);
  EXPECT_EQ(said(), "") << "what waited before the loss is not sent after it";
}

TEST_F(LawicelSessionTest, each_rate_has_its_command) {
  LawicelSession slow(CanDevice{.lawicel = true, .path = "x"}, 125000);
  slow.on_port_up(now);
  (void)slow.take_output();
  slow.on_deadline(now + 300ms);
  EXPECT_EQ(slow.take_output(), "S4\r");
}

}  // namespace
}  // namespace axisgate::can
