#include "gateway/upstream/modbus_tcp/session.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

class Sessions : public ::testing::Test {
 protected:
  void pass(Duration time) {
    desk.runtime.advance_by(time);
    if (plc.session().next_deadline() <= desk.runtime.now()) plc.session().on_deadline(desk.runtime.now());
  }
  std::string why() { return plc.session().finished() ? plc.session().why_finished() : "open"; }
  Desk desk;
  Line plc{desk};
};

TEST_F(Sessions, AnswerInTheOrderOfTheRequests) {
  desk.port.slow = true;
  EXPECT_EQ(plc.ask("06 00 92 00 01"), "");
  EXPECT_EQ(plc.ask("03 00 64 00 01"), "") << "a read waits for the write before it";
  EXPECT_EQ(plc.ask("06 00 C8 00 01"), "") << "a refusal too";
  desk.port.finish();
  EXPECT_EQ(plc.reply(), "06 00 92 00 01");
  EXPECT_EQ(plc.reply(), "03 02 00 00");
  EXPECT_EQ(plc.reply(), "86 02");
  EXPECT_EQ(plc.reply(), "");
}

TEST_F(Sessions, AReadBehindAWriteShowsWhatTheWriteDid) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  plc.send("03 00 92 00 01");
  desk.axis(1)[Quantity::target_torque].value = 1;
  desk.port.finish();
  EXPECT_EQ(plc.reply(), "06 00 92 00 01");
  EXPECT_EQ(plc.reply(), "03 02 00 01");
}

TEST_F(Sessions, TakeFourRequestsAheadAndNoMore) {
  desk.port.slow = true;
  for (int i = 1; i <= 3; ++i) {
    plc.send("06 00 92" + word(i));
    EXPECT_TRUE(plc.session().wants_input());
  }
  plc.send("06 00 92 00 04");
  EXPECT_FALSE(plc.session().wants_input());
  plc.send("06 00 92 00 05");
  EXPECT_EQ(desk.port.submitted.size(), 4U) << "the fifth is kept";
  desk.port.finish();
  EXPECT_EQ(plc.reply(), "06 00 92 00 01");
  EXPECT_EQ(desk.port.submitted.size(), 5U) << "and carried on";
  for (int i = 2; i <= 5; ++i) {
    desk.port.finish();
    EXPECT_EQ(plc.reply(), "06 00 92 " + word(i));
  }
  EXPECT_TRUE(plc.session().wants_input());
}

TEST_F(Sessions, StartAStopOnArrivalBehindASlowWrite) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  plc.send("06 00 9A 00 03");
  ASSERT_EQ(desk.port.submitted.size(), 2U);
  EXPECT_EQ(desk.port.submitted[1].group.command, Command::quick_stop);
}

TEST_F(Sessions, MaskAValueOnlyWhenTheWritesBeforeHaveEnded) {
  desk.port.slow = true;
  plc.send("06 00 8C 00 0F");
  plc.send("16 00 8C FF EF 00 10");
  plc.send("06 00 92 00 07");
  ASSERT_EQ(desk.port.submitted.size(), 1U) << "what comes after the mask keeps its place";
  desk.axis(1)[Quantity::controlword].value = 0x0F;
  desk.port.finish();
  ASSERT_EQ(desk.port.submitted.size(), 3U);
  EXPECT_EQ(desk.port.submitted[1].group.controlword, 0x1F);
  EXPECT_EQ(desk.port.submitted[2].group.setpoints[0].value, 7);
}

TEST_F(Sessions, DropWhatWaitsBehindAMaskWhenAStopComes) {
  desk.port.slow = true;
  plc.send("06 00 8C 00 0F");
  plc.send("16 00 8C FF EF 00 10");
  plc.send("06 00 92 00 07");
  plc.send("06 00 9A 00 04");
  ASSERT_EQ(desk.port.submitted.size(), 2U);
  EXPECT_EQ(desk.port.submitted[1].group.command, Command::halt);
  desk.port.finish();
  desk.port.finish();
  EXPECT_EQ(desk.port.submitted.size(), 2U) << "nothing starts after the stop";
  EXPECT_EQ(plc.reply(), "06 00 8C 00 0F");
  EXPECT_EQ(plc.reply(), "96 06");
  EXPECT_EQ(plc.reply(), "86 06");
  EXPECT_EQ(plc.reply(), "06 00 9A 00 04");
}

TEST_F(Sessions, StartAMaskThatStopsOnArrival) {
  desk.port.slow = true;
  desk.axis(1)[Quantity::controlword].value = 0x0F;
  plc.send("06 00 92 00 07");
  plc.send("16 00 8C FF FB 00 00");
  ASSERT_EQ(desk.port.submitted.size(), 2U);
  EXPECT_EQ(desk.port.submitted[1].group.controlword, 0x0B);
}

TEST_F(Sessions, AnswerWhatIsGluedToAMalformedFrameAndClose) {
  auto stream = frame(1, 1, bytes("03 00 64 00 01"));
  const auto rest = bytes("00 02 00 99 00 06 01 03 00 64 00 01");
  stream.insert(stream.end(), rest.begin(), rest.end());
  plc.feed(stream);
  EXPECT_EQ(why(), "malformed frame");
  EXPECT_EQ(plc.reply(), "03 02 00 00");
  EXPECT_EQ(plc.reply(), "closed");
  EXPECT_FALSE(plc.session().wants_input());
  EXPECT_EQ(desk.registry.counters.malformed, 1U);
  plc.feed(frame(2, 1, bytes("03 00 64 00 01")));
  EXPECT_EQ(plc.reply(), "closed") << "nothing counts after it";
}

TEST_F(Sessions, WaitForTheWritesBeforeAMalformedFrame) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  plc.feed(bytes("00 02 00 99"));
  EXPECT_FALSE(plc.session().finished());
  desk.port.finish();
  EXPECT_EQ(plc.reply(), "06 00 92 00 01");
  EXPECT_EQ(why(), "malformed frame");
}

TEST_F(Sessions, CloseAConnectionWhoseRequestIsNotWhole5sAfterItsFirstByte) {
  const auto request = frame(1, 1, bytes("03 00 64 00 01"));
  for (std::size_t i = 0; i < 5; ++i) {
    plc.feed({request[i]});
    pass(900ms);
  }
  EXPECT_EQ(why(), "open");
  plc.feed({request[5]});
  pass(499ms);
  EXPECT_EQ(why(), "open");
  pass(1ms);
  EXPECT_EQ(why(), "request not complete in time") << "per request, not per byte";
}

TEST_F(Sessions, CountTheDeadlineOfTheNextRequestFromItsOwnFirstByte) {
  auto stream = frame(1, 1, bytes("03 00 64 00 01"));
  stream.push_back(0);
  plc.feed({stream.begin(), stream.begin() + 4});
  pass(3s);
  plc.feed({stream.begin() + 4, stream.end()});
  EXPECT_EQ(plc.reply(), "03 02 00 00");
  pass(4999ms);
  EXPECT_EQ(why(), "open");
  pass(1ms);
  EXPECT_EQ(why(), "request not complete in time");
}

TEST_F(Sessions, CloseAConnectionThatDoesNotTakeItsReply) {
  plc.send("03 00 64 00 7D");
  EXPECT_FALSE(plc.session().wants_input());
  for (int second = 0; second < 4; ++second) {
    pass(1s);
    plc.session().take_output(1, desk.runtime.now());
  }
  EXPECT_EQ(why(), "open");
  pass(1s);
  EXPECT_EQ(why(), "reply not taken in time") << "a byte a second is not enough";
  EXPECT_TRUE(plc.session().output().empty());
}

TEST_F(Sessions, DoNotCountASlowWriteAgainstTheClient) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  pass(70s);
  EXPECT_EQ(why(), "open");
  EXPECT_EQ(plc.session().next_deadline(), kNever);
  desk.port.finish();
  EXPECT_EQ(plc.session().next_deadline(), desk.runtime.now() + 5s);
  EXPECT_EQ(plc.reply(), "06 00 92 00 01");
}

TEST_F(Sessions, CloseAnIdleConnection) {
  static_cast<void>(plc.read(100));
  pass(59s);
  static_cast<void>(plc.read(100));
  pass(59s);
  EXPECT_EQ(why(), "open");
  pass(1s);
  EXPECT_EQ(why(), "idle");
}

TEST_F(Sessions, StayOpenForEverWithIdleTimeout0) {
  desk.settings.idle_timeout = Duration::zero();
  EXPECT_EQ(plc.session().next_deadline(), kNever);
}

TEST_F(Sessions, LeaveResultsAloneThatComeAfterTheyClosed) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  plc.session().on_closed(desk.runtime.now());
  desk.port.finish();
  EXPECT_TRUE(plc.session().output().empty());
  {
    Line panel(desk, Role::operator_, kPanel);
    panel.send("06 00 92 00 01");
    panel.send("0F 00 64 00 03 01 04");
  }
  desk.port.finish();
  desk.port.finish();
  EXPECT_EQ(desk.port.gone.size(), 2U) << "each client is gone once";
  EXPECT_EQ(desk.registry.counters.unanswered, 3U);
}

TEST_F(Sessions, SubmitNothingMoreForAClientThatHasGone) {
  EXPECT_TRUE(is_done(plc.ask("0F 00 64 00 08 01 00")));
  desk.port.slow = true;
  plc.send("0F 00 64 00 08 01 03");
  EXPECT_EQ(commands(desk), std::vector{Command::fault_reset});
  plc.session().on_closed(desk.runtime.now());
  desk.port.finish();
  EXPECT_TRUE(commands(desk).empty()) << "nobody is there who wants the enable";
}

TEST_F(Sessions, TellTheServerWhenAResultHasMadeOutput) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  EXPECT_EQ(plc.told, 0);
  desk.port.finish();
  EXPECT_EQ(plc.told, 1);
  static_cast<void>(plc.reply());
  static_cast<void>(plc.read(100));
  EXPECT_EQ(plc.told, 1) << "not for what its own call caused";
}

TEST_F(Sessions, AgesInRepliesToSlowWritesAreOfTheReplysTime) {
  desk.port.slow = true;
  plc.send("17 00 77 00 01 00 92 00 01 02 00 07");
  desk.runtime.advance_by(250ms);
  desk.port.finish();
  EXPECT_EQ(plc.reply(), "17 02 " + word(250));
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
