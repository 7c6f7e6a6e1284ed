// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/lawicel_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisgate::can {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::string_view kAttempt = "\r\r\rC\rV\r";       ///< how each begins
constexpr std::string_view kAllWell = "V1\r\r\r";           ///< what brings it to its end
constexpr std::string_view kRefusals = "\a\a\a\a\a\a\a\a";  ///< as many as mean bus-off

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
    hear("\r\r\r\rV1013\r\r\r");
    ASSERT_TRUE(session.up());
    pass(0ms);
    hear("F00\r");
    pass(100ms);
    (void)said();
  }
  void expect_down(std::string_view why) {
    EXPECT_FALSE(session.up());
    EXPECT_THAT(session.why(), HasSubstr(why));
  }
  /// Down; the next attempt comes after so long, and not before.
  void expect_next_attempt_after(Duration pause) {
    (void)said();
    pass(pause - 1ms);
    EXPECT_EQ(said(), "");
    pass(1ms);
    EXPECT_EQ(said(), kAttempt);
  }
  /// The status that it asks for every half second says this.
  void hear_status(std::string_view flags) {
    pass(500ms);
    hear(flags);
  }

  Instant now = Instant{} + 1h;
  LawicelDecoder decoder;
  LawicelSession session{CanDevice{.lawicel = true, .path = "/dev/adapter"}, 500000};
};

TEST_F(LawicelSessionTest, closes_sets_the_rate_and_opens_each_after_the_answer) {
  session.on_port_up(now);
  EXPECT_EQ(said(), kAttempt);
  hear("\a\a\a\at1230\rt1230\r");
  EXPECT_EQ(said(), "") << "a closed channel refuses to be closed; frames of one left open answer nothing";
  hear("V1013\rt1230\r");
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
  for (const std::string_view step : {kAttempt, std::string_view("S6\r"), std::string_view("O\r")}) {
    EXPECT_EQ(said(), step);
    EXPECT_FALSE(session.up());
    pass(300ms);
  }
  EXPECT_TRUE(session.up());
  EXPECT_FALSE(session.answers());
  pass(10s);
  EXPECT_EQ(said(), "F\rF\rF\r") << "three unanswered questions are enough";
  send(0x123);
  EXPECT_EQ(said(), "t1230\r");
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, each_silent_step_costs_its_wait_and_no_more) {
  for (int silent = 0; silent < 3; ++silent) {
    session.on_port_down("cable");
    session.on_port_up(now);
    const Instant begun = now;
    for (int step = 0; step < 3; ++step) {
      if (step == silent) {
        pass(300ms);
      } else {
        hear(step == 0 ? "V1\r" : "\r");
      }
    }
    EXPECT_TRUE(session.up()) << silent;
    EXPECT_EQ(now - begun, 300ms) << silent;
  }
}

TEST_F(LawicelSessionTest, a_refused_rate_or_channel_is_told_and_tried_again_from_the_beginning) {
  session.on_port_up(now);
  hear("V1\r\a");
  expect_down("/dev/adapter: the adapter refuses the bit rate 500000");
  expect_next_attempt_after(1s);
  hear("V1\r\r\a");
  expect_down("refuses to open");
  expect_next_attempt_after(1s);
  hear(kAllWell);
  EXPECT_TRUE(session.up());
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

TEST_F(LawicelSessionTest, an_acknowledgement_lets_the_next_frame_go_at_once_and_an_urgent_one_goes_first) {
  for (const std::string_view acknowledgement : {"\r", "z\r", "Z\r"}) {
    open();
    send(1);
    send(2);
    send(3, true);
    EXPECT_EQ(said(), "t0010\r");
    hear(acknowledgement);
    EXPECT_EQ(said(), "t0030\r");
    hear(acknowledgement);
    EXPECT_EQ(said(), "t0020\r");
    session.on_port_down("");
  }
}

TEST_F(LawicelSessionTest, more_frames_than_the_bound_take_the_link_down) {
  open();
  for (std::size_t i = 0; i <= kMaxUnsentFrames; ++i) send(1);
  EXPECT_TRUE(session.up()) << "one went out, the others wait";
  send(1);
  expect_down("overloaded: 64 frames wait");
}

TEST_F(LawicelSessionTest, a_frame_that_waits_for_too_long_takes_the_link_down) {
  LawicelSession slow(CanDevice{.lawicel = true, .path = "/dev/adapter", .baud = 300}, 500000);
  slow.on_port_up(now);
  for (int i = 0; i < 3; ++i) slow.on_deadline(now += 300ms);
  ASSERT_TRUE(slow.up());
  slow.on_deadline(now += 2s);
  for (int i = 0; i < 4; ++i) slow.send(data_frame(1, {}), false, now);
  EXPECT_GT(slow.due(now), now);
  slow.on_deadline(now + kMaxSendWait);
  EXPECT_FALSE(slow.up());
  EXPECT_THAT(slow.why(), HasSubstr("overloaded"));
}

TEST_F(LawicelSessionTest, frames_refused_in_a_row_mean_bus_off_and_the_channel_is_opened_anew) {
  open();
  for (const std::string_view sign_of_life : {"z\r", "\r", "t1230\r"}) {
    hear(kRefusals.substr(1));
    hear(sign_of_life);
    EXPECT_TRUE(session.up()) << "refusals between acknowledgements or frames are borne";
  }
  hear(kRefusals);
  expect_down("refuses frames");
  EXPECT_EQ(session.trouble().no_ack, 3 * 7 + 8);
  EXPECT_EQ(session.trouble().bus_offs, 1);
  expect_next_attempt_after(1s);
  hear(kAllWell);
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, the_sixth_bus_off_in_a_minute_leaves_the_channel_alone_for_a_minute) {
  open();
  for (int off = 0; off < 5; ++off) {
    hear(kRefusals);
    expect_next_attempt_after(1s);
    hear(kAllWell);
    ASSERT_TRUE(session.up());
    pass(0ms);
    hear("F00\r");
  }
  hear(kRefusals);
  expect_down("more than 5 times in a minute");
  expect_next_attempt_after(60s);
}

TEST_F(LawicelSessionTest, a_port_opened_anew_begins_without_a_record) {
  open();
  for (int off = 0; off < 6; ++off) {
    hear(kRefusals);
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
  pass(2s);
  expect_down("answers no more");
  pass(1s);
  EXPECT_THAT(said(), HasSubstr("C\r")) << "one that answered and falls silent hangs";
}

TEST_F(LawicelSessionTest, an_adapter_without_status_is_not_asked_again_and_no_worse) {
  session.on_port_up(now);
  hear(kAllWell);
  pass(0ms);
  (void)said();
  hear("\a");
  pass(10s);
  EXPECT_EQ(said(), "");
  EXPECT_TRUE(session.up());
  EXPECT_EQ(session.trouble().no_ack, 0);
}

TEST_F(LawicelSessionTest, error_passive_with_errors_and_a_full_queue_is_a_bus_where_nobody_acknowledges) {
  open();
  hear_status("FA2\r");  // bus error, error passive, transmit queue full
  expect_down("nobody acknowledges");
  EXPECT_EQ(session.trouble().error_passive, 1);
  EXPECT_EQ(session.trouble().send_waits, 1);
  send(1);
  EXPECT_THAT(said(), testing::Not(HasSubstr("t0010"))) << "nothing is sent into a dead bus";
  hear_status("FA2\r");
  EXPECT_FALSE(session.up());
  hear("t1230\r");
  EXPECT_TRUE(session.up()) << "somebody is there";
  hear_status("FA2\r");
  EXPECT_FALSE(session.up());
  hear_status("F00\r");
  EXPECT_TRUE(session.up()) << "a clean status ends the trouble";
}

TEST_F(LawicelSessionTest, error_passive_that_lasts_is_told_without_a_full_queue) {
  open();
  hear_status("FA0\r");
  EXPECT_TRUE(session.up());
  pass(500ms);
  EXPECT_FALSE(session.up());
}

TEST_F(LawicelSessionTest, overruns_are_counted) {
  open();
  hear_status("F08\r");
  hear_status("F01\r");
  EXPECT_EQ(session.trouble().lost_in, 2);
  EXPECT_TRUE(session.up());
}

TEST_F(LawicelSessionTest, a_babbling_port_is_told_and_tried_again) {
  open();
  session.on_babble(now);
  expect_down("no Lawicel adapter");
  expect_next_attempt_after(1s);
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

}  // namespace
}  // namespace axisgate::can
