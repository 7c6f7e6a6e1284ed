// Function 43/13 among the other requests of its connection: what is under way together, and in which order it ends.
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

constexpr const char* kReadName = "2B 0D 00 00 01 10 08 00 00 00 00 00";
constexpr const char* kReadStatus = "2B 0D 00 00 01 60 41 00 00 00 00 00";
constexpr const char* kWriteTarget = "2B 0D 01 00 01 60 7A 00 00 00 00 04 10 27 00 00";

GroupResult refused(std::uint32_t abort_code, std::uint32_t own_code) {
  GroupResult result{{Errc::refused_by_drive, own_code}};
  result.abort_code = abort_code;
  return result;
}

class PipelinedFunction4313 : public ::testing::Test {
 protected:
  PipelinedFunction4313() { desk.port.slow = true; }
  Desk desk;
  Line plc{desk};
};

TEST_F(PipelinedFunction4313, FourOfThemAreUnderWayAtOnceAndAnsweredInOrder) {
  for (int i = 1; i <= 4; ++i) plc.send("2B 0D 00 00 01 20 00" + hex_text(std::vector{Byte(i)}) + "00 00 00 00");
  EXPECT_EQ(desk.port.submitted.size(), 4U) << "none is refused because another is under way";
  EXPECT_FALSE(plc.session().wants_input());
  // The port ends them in an order of its own.
  std::swap(desk.port.waiting[0], desk.port.waiting[3]);
  desk.port.finish({}, 4, 1);
  desk.port.finish({}, 2, 1);
  desk.port.finish({}, 3, 1);
  EXPECT_EQ(plc.reply(), "") << "the first is still asked";
  desk.port.finish({}, 1, 1);
  for (int i = 1; i <= 4; ++i) {
    const std::string sub = hex_text(std::vector{Byte(i)});
    EXPECT_EQ(plc.reply(), "2B 0D 00 00 01 20 00 " + sub + " 00 00 00 01 " + sub);
  }
}

TEST_F(PipelinedFunction4313, DoNotMindAMailboxThatIsBusy) {
  EXPECT_TRUE(is_done(plc.write_block(180, "00 01 60 64 00 00 00 04")));
  EXPECT_EQ(plc.ask(kReadStatus), "");
  EXPECT_EQ(desk.port.submitted.size(), 2U);
  EXPECT_EQ(plc.write(180, 1), "") << "answered behind it";
  desk.port.finish();
  desk.port.finish({}, 7, 1);
  EXPECT_EQ(plc.reply(), "2B 0D 00 00 01 60 41 00 00 00 00 01 07");
  EXPECT_EQ(plc.reply(), "86 06") << "the mailbox was busy when it came";
}

TEST_F(PipelinedFunction4313, LetAStopPass) {
  plc.send(kReadName);
  plc.send("06 00 9A 00 03");
  EXPECT_EQ(commands(desk), std::vector{Command::quick_stop});
}

TEST_F(PipelinedFunction4313, KeepTheirPlaceBehindAMaskThatHasToWait) {
  plc.send("06 00 8C 00 0F");
  plc.send("16 00 8C FF EF 00 10");
  plc.send(kWriteTarget);
  plc.send(kReadStatus);
  EXPECT_EQ(desk.port.submitted.size(), 1U);
  desk.port.finish();
  EXPECT_EQ(desk.port.submitted.size(), 4U);
  EXPECT_TRUE(desk.port.submitted[2].group.object->write);
}

TEST_F(PipelinedFunction4313, AWriteThatWaitsIsDroppedByAStop) {
  plc.send("06 00 8C 00 0F");
  plc.send("16 00 8C FF EF 00 10");
  plc.send("2B 0D 01 00 01 60 40 00 00 00 00 02 0F 00");
  plc.send("06 00 9A 00 04");
  desk.port.finish();
  desk.port.finish();
  EXPECT_EQ(desk.port.submitted.size(), 2U) << "nothing starts after the stop";
  EXPECT_EQ(plc.reply(), "06 00 8C 00 0F");
  EXPECT_EQ(plc.reply(), "96 06");
  EXPECT_EQ(plc.reply(), "AB 06");
  EXPECT_EQ(plc.reply(), "06 00 9A 00 04");
}

TEST_F(PipelinedFunction4313, AReadThatWaitsIsNotDroppedByAStop) {
  plc.send("06 00 8C 00 0F");
  plc.send("16 00 8C FF EF 00 10");
  plc.send(kReadStatus);
  plc.send("06 00 9A 00 04");
  desk.port.finish();
  desk.port.finish();
  desk.port.finish({}, 7, 1);
  for (const char* expected : {"06 00 8C 00 0F", "96 06", "2B 0D 00 00 01 60 41 00 00 00 00 01 07", "06 00 9A 00 04"}) {
    EXPECT_EQ(plc.reply(), expected);
  }
}

TEST_F(PipelinedFunction4313, AreNotWaitedForByAMaskWhereTheyRead) {
  plc.send(kReadStatus);
  plc.send("16 00 8C FF EF 00 10");
  EXPECT_EQ(desk.port.submitted.size(), 2U);
  Line other(desk, Role::engineer, kPanel);
  other.send(kWriteTarget);
  other.send("16 00 8C FF EF 00 10");
  EXPECT_EQ(desk.port.submitted.size(), 3U) << "a write of the controlword's object might change what is masked";
}

TEST_F(PipelinedFunction4313, ReachNobodyAfterTheirClientHasGone) {
  {
    Line panel(desk, Role::engineer, kPanel);
    panel.send(kReadName);
    panel.send(kWriteTarget);
  }
  desk.port.finish({}, 7, 1);
  desk.port.finish_with(refused(0x06020000, 0x06020000));
  EXPECT_EQ(desk.registry.counters.unanswered, 2U);
}

TEST_F(PipelinedFunction4313, ARefusalOutlivesTheConnectionOfAClientByAddress) {
  desk.settings.client_is_address = true;
  {
    Line tool(desk, Role::engineer, kPanel);
    tool.send(kWriteTarget);
    tool.session().on_closed(desk.runtime.now());
  }
  desk.port.finish_with(refused(0x08000000, 3));
  Line again(desk, Role::engineer, kPanel);
  EXPECT_EQ(again.read(125, 3), "00 03 00 00 00 03");
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
