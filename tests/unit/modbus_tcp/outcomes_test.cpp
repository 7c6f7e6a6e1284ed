#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

/// A row of the outcome table of design 3.3: how a write ended, what the client is answered and what register 25 says.
struct Row {
  Errc code;
  int exception;
  int result;
};
constexpr Row kRows[] = {
    {Errc::ok, 0, 2},
    {Errc::not_supported, 0x02, 0},
    {Errc::bad_value, 0x03, 0},
    {Errc::refused_by_drive, 0x04, 3},
    {Errc::state_unsuitable, 0x04, 9},
    {Errc::queue_full, 0x06, 0},
    {Errc::superseded, 0x06, 5},
    {Errc::dropped_by_stop, 0x06, 6},
    {Errc::never_started, 0x06, 6},
    {Errc::still_in_setup, 0x06, 6},
    {Errc::identity_mismatch, 0x06, 6},
    {Errc::not_owner, 0x06, 7},
    {Errc::offline, 0x0A, 6},
    {Errc::timed_out, 0x0B, 4},
    {Errc::link_lost, 0x0B, 4},
    {Errc::role_forbidden, 0x01, 0},
};

TEST(Outcomes, AreAnsweredAsTheTableSaysAtOnceAndLater) {
  for (const Row& row : kRows) {
    for (const bool slow : {false, true}) {
      SCOPED_TRACE(std::string(text(row.code)) + (slow ? ", later" : ", at once"));
      Desk desk;
      Line plc(desk);
      const GroupResult result{{row.code, 0x08000022}, 0, 0};
      desk.port.slow = slow;
      if (!slow) desk.port.at_once = {result};
      std::string reply = plc.write(146, 1);
      if (slow) {
        EXPECT_EQ(reply, "");
        EXPECT_EQ(plc.read(0), "") << "replies stay in order";
        desk.port.finish(result.outcome);
        reply = plc.reply();
        static_cast<void>(plc.reply());
      }
      if (row.exception == 0) {
        EXPECT_EQ(reply, "06 00 92 00 01");
      } else {
        EXPECT_TRUE(is_exception(reply, row.exception)) << reply;
      }
      EXPECT_EQ(plc.read(125, 3), word(row.result) + " 08 00 00 22");
    }
  }
}

TEST(Outcomes, OfRequestsRefusedByTheTableAreNoResult) {
  Desk desk;
  Line plc(desk);
  EXPECT_TRUE(is_done(plc.write(146, 1)));
  EXPECT_EQ(plc.read(125), "00 02");
  EXPECT_EQ(plc.write(154, 99), "86 03");
  EXPECT_EQ(plc.read(125), "00 00") << "an older result must not be taken for this write's";
  EXPECT_TRUE(is_done(plc.write(146, 1)));
  EXPECT_EQ(plc.write(143, 1), "86 02");
  EXPECT_EQ(plc.read(125), "00 00");
}

class PostedWrites : public ::testing::Test {
 protected:
  PostedWrites() {
    desk.settings.posted_writes = true;
    desk.port.slow = true;
  }
  Desk desk;
  Line plc{desk};
};

TEST_F(PostedWrites, AreAnsweredAfterTheChecksAndTellTheRestInRegisters) {
  static_cast<void>(plc.write_block(154, "00 00 00 06"));
  EXPECT_TRUE(is_done(plc.write_block(154, "00 01 00 07")));
  EXPECT_EQ(plc.read(125), "00 01") << "pending";
  EXPECT_EQ(plc.read(130), "00 07");
  desk.port.finish({Errc::refused_by_drive, 0x06090030});
  EXPECT_EQ(plc.read(125, 3), "00 03 06 09 00 30");
}

TEST_F(PostedWrites, AreRefusedByRangeRoleOwnerAndQueueChecks) {
  for (const Errc code :
       {Errc::bad_value, Errc::not_supported, Errc::role_forbidden, Errc::queue_full, Errc::not_owner}) {
    desk.port.at_once = {{{code, 0}, 0, 0}};
    EXPECT_TRUE(is_exception(plc.write(146, 1), static_cast<int>(modbus_exception(code)))) << text(code);
  }
  EXPECT_EQ(plc.write(143, 1), "86 02");
}

TEST_F(PostedWrites, NeverFailForALink) {
  desk.port.at_once = {{{Errc::offline, 0}, 0, 0}};
  EXPECT_EQ(plc.ask("17 00 66 00 02 00 92 00 01 02 00 07"), "17 04 00 00 00 00");
  EXPECT_EQ(plc.read(125), "00 06");
}

TEST_F(PostedWrites, ReadAtOnceInFunction23) {
  EXPECT_EQ(plc.ask("17 00 66 00 02 00 92 00 01 02 00 07"), "17 04 00 00 00 00");
  EXPECT_EQ(desk.port.waiting.size(), 1U);
}

TEST_F(PostedWrites, GoOnWhenTheirClientHasGone) {
  desk.settings.client_is_address = true;
  {
    Line tool(desk, Role::operator_, kPanel);
    EXPECT_TRUE(is_done(tool.write(146, 1)));
    tool.session().on_closed(desk.runtime.now());
  }
  desk.port.finish();
  Line again(desk, Role::operator_, kPanel);
  EXPECT_EQ(again.read(125), "00 02");
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
