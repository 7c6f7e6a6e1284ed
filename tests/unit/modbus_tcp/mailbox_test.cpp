#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

class MailboxOfObjects : public ::testing::Test {
 protected:
  MailboxOfObjects() { desk.port.slow = true; }
  const std::optional<ObjectRequest>& last() { return desk.port.submitted.back().group.object; }
  Desk desk;
  Line plc{desk};
};

TEST_F(MailboxOfObjects, ReadsAnObjectAndTellsWhenItIsDone) {
  EXPECT_EQ(plc.read(186), "00 00") << "idle";
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 60 64 00 00 00 04"))) << "returns at once";
  ASSERT_TRUE(last().has_value());
  EXPECT_FALSE(last()->write);
  EXPECT_EQ(last()->index, 0x6064);
  EXPECT_EQ(last()->subindex, 0);
  EXPECT_EQ(last()->size, 4);
  EXPECT_EQ(plc.read(186), "00 01") << "busy";
  desk.port.finish({}, 0xDEADBEEF, 4);
  EXPECT_EQ(plc.read(184, 5), "DE AD BE EF 00 02 00 00 00 00");
}

TEST_F(MailboxOfObjects, WritesAnObject) {
  EXPECT_TRUE(is_done(plc.write_block(180, "00 02 60 FF 00 00 00 04 12 34 56 78")));
  EXPECT_TRUE(last()->write);
  EXPECT_EQ(last()->data, 0x12345678U);
  desk.port.finish();
  EXPECT_EQ(plc.read(184, 3), "12 34 56 78 00 02") << "the data stays";
}

TEST_F(MailboxOfObjects, MayBeFilledRowByRow) {
  EXPECT_TRUE(is_done(plc.write(181, 0x2010)));
  EXPECT_TRUE(is_done(plc.write(182, 0x0A)));
  EXPECT_TRUE(is_done(plc.write(183, 2)));
  for (const auto& each : desk.port.taken()) EXPECT_TRUE(asks_nothing(each.group));
  EXPECT_EQ(plc.write(180, 1), "06 00 B4 00 01");
  EXPECT_EQ(last()->index, 0x2010);
  EXPECT_EQ(last()->subindex, 0x0A);
  EXPECT_EQ(plc.read(180, 4), "00 01 20 10 00 0A 00 02");
}

TEST_F(MailboxOfObjects, FailsWithTheDrivesCode) {
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 60 64 00 00 00 04")));
  desk.port.finish({Errc::refused_by_drive, 0x06020000});
  EXPECT_EQ(plc.read(186, 4), "00 03 00 00 06 02 00 00");
}

TEST_F(MailboxOfObjects, FailsWithTheExceptionWhereTheDriveGaveNoCode) {
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 60 64 00 00 00 04")));
  desk.port.finish({Errc::timed_out, 0});
  EXPECT_EQ(plc.read(186, 4), "00 03 00 00 00 00 00 0B");
}

TEST_F(MailboxOfObjects, FailsWithTheAbortCodeWhereTheDriveHasNoCodeOfItsOwn) {
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 60 64 00 00 00 04")));
  GroupResult refused{{Errc::refused_by_drive, 0}};
  refused.abort_code = 0x08000000;
  desk.port.finish_with(refused);
  EXPECT_EQ(plc.read(186, 4), "00 03 00 00 08 00 00 00");
}

TEST_F(MailboxOfObjects, HasNoRoomForAnObjectOfMoreThanFourBytes) {
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 10 08 00 00 00 04 00 00 00 07")));
  GroupResult text;
  text.object_bytes = std::make_shared<const std::vector<Byte>>(9, Byte{'x'});
  desk.port.finish_with(text);
  EXPECT_EQ(plc.read(184, 6), "00 00 00 07 00 03 00 00 06 07 00 10") << "length of service parameter too high";
}

TEST_F(MailboxOfObjects, IsToldAtOnceWhatIsKnownAtOnce) {
  desk.port.at_once = {{{Errc::offline, 0}, 0, 0}};
  EXPECT_EQ(plc.write_block(180, "00 01 60 64 00 00 00 04"), "90 0A");
  EXPECT_EQ(plc.read(186, 4), "00 03 00 00 00 00 00 0A");
}

TEST_F(MailboxOfObjects, ASecondRequestWhileBusyIs0x06) {
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 60 64 00 00 00 04")));
  EXPECT_EQ(plc.write(180, 1), "86 06");
  EXPECT_EQ(desk.port.submitted.size(), 1U);
  Line panel(desk, Role::viewer, kPanel);
  EXPECT_TRUE(is_done(panel.write_block(180, "00 01 60 64 00 00 00 04"))) << "each client has its own";
  desk.port.finish();
  EXPECT_TRUE(is_done(plc.write(180, 1)));
}

TEST_F(MailboxOfObjects, TakesSizes1And2And4AndSubindexesOfOneByte) {
  EXPECT_EQ(plc.write_block(180, "00 01 60 64 00 00 00 03"), "90 03");
  EXPECT_EQ(plc.write_block(180, "00 01 60 64 00 00 00 00"), "90 03");
  EXPECT_EQ(plc.write_block(180, "00 01 60 64 01 00 00 02"), "90 03");
  EXPECT_EQ(plc.write(180, 3), "86 03");
  EXPECT_EQ(plc.read(180, 4), "00 00 00 00 00 00 00 00") << "a refused request changes nothing";
  EXPECT_TRUE(desk.port.submitted.empty());
  EXPECT_TRUE(is_done(plc.write(180, 0))) << "0 asks for nothing";
  EXPECT_TRUE(asks_nothing(desk.port.submitted.back().group));
}

TEST_F(MailboxOfObjects, ComesAfterTheOtherWritesOfItsRequest) {
  // 78 set_position_value, 80..83
  EXPECT_EQ(plc.write_block(178, "00 00 00 07 00 01 60 64 00 00 00 04"), "");
  ASSERT_EQ(desk.port.submitted.size(), 1U);
  EXPECT_EQ(desk.port.submitted[0].group.set_position_value, 7);
  desk.port.finish();
  EXPECT_TRUE(is_done(plc.reply())) << "the object itself is not waited for";
  ASSERT_EQ(desk.port.submitted.size(), 2U);
  EXPECT_TRUE(last().has_value());
}

TEST_F(MailboxOfObjects, EndsWithTheRequestThatFailedBeforeItsTurn) {
  EXPECT_EQ(plc.write_block(178, "00 00 00 07 00 01 60 64 00 00 00 04"), "");
  desk.port.finish({Errc::offline, 0});
  EXPECT_EQ(plc.reply(), "90 0A");
  EXPECT_EQ(desk.port.submitted.size(), 1U);
  EXPECT_EQ(plc.read(186), "00 03");
}

TEST_F(MailboxOfObjects, ResultsAreNotTheCommands) {
  desk.axis(1).latest = {CommandResult::done, 0, 3};
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 60 64 00 00 00 04")));
  desk.port.finish({Errc::refused_by_drive, 1});
  EXPECT_EQ(plc.read(125), "00 00") << "its own, of which there is none yet";
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
