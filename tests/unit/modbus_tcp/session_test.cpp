// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/session/session.hpp"

#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

class Sessions : public AtTheDesk {
 protected:
  void pass(Duration time) {
    desk.runtime.advance_by(time);
    if (plc.session().next_deadline() <= desk.runtime.now()) plc.session().on_deadline(desk.runtime.now());
  }
  std::string why() { return plc.session().finished() ? std::string(text(plc.session().why_finished())) : "open"; }
};

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

TEST_F(Sessions, CountRequestsHowTheyEndedAndHowLongTheyTook) {
  const RequestFigures& figures = desk.registry.figures;
  plc.feed(frame(1, 1, bytes("03 00 64 00 01")));
  EXPECT_EQ(plc.reply(), "03 02 00 00");
  plc.feed(frame(2, 1, bytes("03 FF FF 00 01")));
  EXPECT_EQ(plc.reply(), "83 02");
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  desk.runtime.advance_by(30ms);
  EXPECT_EQ(figures.requests, 3U);
  EXPECT_EQ(figures.took.total(), 2U);
  EXPECT_EQ(figures.took.sum_ns, 0U) << "what is read is answered at once";
  desk.port.finish();
  EXPECT_EQ(figures.took.total(), 3U);
  EXPECT_EQ(figures.took.sum_ns, 30'000'000U);
  EXPECT_EQ(figures.exceptions[2], 1U);
  plc.feed(frame(3, 1, bytes("08 00 0A 00 00")));  // it clears the counters of function 8
  EXPECT_GE(figures.requests, 3U);
}

// A gateway or a panel that is set to "RTU over TCP".
TEST_F(Sessions, NameAClientThatSendsRtuFrames) {
  for (const char* request : {"01 03 00 64 00 02 85 D4", "01 03 00 00 00 02 C4 0B", "01 06 00 92 00 07 69 E5",
                              "01 10 00 8E 00 02 04 00 00 00 07 3B 81"}) {
    Line line(desk);
    line.feed(bytes(request));
    EXPECT_EQ(desk.logged(), "192.168.1.7:50000 sends Modbus RTU frames over TCP: set it to Modbus TCP") << request;
    line.feed(bytes(request));
    EXPECT_EQ(desk.logged(), "-") << "once";
  }
  Line first(desk), other(desk), spoilt(desk);
  first.feed(frame(0x0103, 1, bytes("03 00 64 00 01")));
  other.feed(bytes("00 02 00 99 00 06 01 03"));
  auto without_its_crc = bytes("01 03 00 64 00 02 85 D4");
  without_its_crc.back() ^= 1;
  spoilt.feed(without_its_crc);
  EXPECT_EQ(desk.logged(), "-");
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
  pass(59s);
  EXPECT_EQ(why(), "open") << "idle since the reply was taken";
  pass(1s);
  EXPECT_EQ(why(), "idle");
}

TEST_F(Sessions, CountTheDeadlineOfRepliesFromTheFirstThatIsNotTaken) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  plc.send("06 00 92 00 02");
  desk.port.finish();
  pass(4s);
  desk.port.finish();
  pass(1s);
  EXPECT_EQ(why(), "reply not taken in time");
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

}  // namespace
}  // namespace axisgate::modbus_tcp::test
