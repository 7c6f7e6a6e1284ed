// Function 43/13 as a client meets it: objects of up to four bytes, and every way in which a request can end.
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

constexpr const char* kReadName = "2B 0D 00 00 01 10 08 00 00 00 00 00";
constexpr const char* kReadStatus = "2B 0D 00 00 01 60 41 00 00 00 00 00";
constexpr const char* kWriteTarget = "2B 0D 01 00 01 60 7A 00 00 00 00 04 10 27 00 00";

GroupResult number(std::uint32_t data, std::uint8_t size) { return {{}, data, size}; }
GroupResult text_of(const std::string& text) {
  GroupResult result;
  result.object_bytes = std::make_shared<const std::vector<Byte>>(text.begin(), text.end());
  return result;
}
GroupResult refused(std::uint32_t abort_code, std::uint32_t own_code) {
  GroupResult result{{Errc::refused_by_drive, own_code}};
  result.abort_code = abort_code;
  return result;
}

class ObjectsByFunction4313 : public ::testing::Test {
 protected:
  const ObjectRequest& last() { return desk.port.submitted.back().group.object.value(); }
  std::string ask_with(const GroupResult& result, const std::string& pdu) {
    desk.port.at_once = {result};
    return plc.ask(pdu);
  }
  Desk desk;
  Line plc{desk};
};

TEST_F(ObjectsByFunction4313, AreReadAsTheContractShows) {
  EXPECT_EQ(ask_with(text_of("axisdrive"), kReadName),
            "2B 0D 00 00 01 10 08 00 00 00 00 09 61 78 69 73 64 72 69 76 65");
  EXPECT_EQ(desk.port.submitted.back().axis, 1);
  EXPECT_FALSE(last().write);
  EXPECT_EQ(last().index, 0x1008);
  EXPECT_EQ(last().subindex, 0);
  EXPECT_EQ(last().size, 0) << "all there are";
  EXPECT_EQ(last().count, 0);
  EXPECT_EQ(ask_with(text_of("axisdrive"), "2B 0D 02 00 50 01 10 08 00 00 00 00 09"),
            "2B 0D 02 00 50 01 10 08 00 00 00 00 09 61 78 69 73 64 72 69 76 65");
  EXPECT_EQ(last().count, 9) << "a Modbus RTU drive has to know how many registers";
}

TEST_F(ObjectsByFunction4313, CarryNumbersLeastSignificantByteFirst) {
  EXPECT_EQ(ask_with(number(0x12, 1), kReadStatus), "2B 0D 00 00 01 60 41 00 00 00 00 01 12");
  EXPECT_EQ(ask_with(number(0x0637, 2), kReadStatus), "2B 0D 00 00 01 60 41 00 00 00 00 02 37 06");
  EXPECT_EQ(ask_with(number(0x123456, 3), kReadStatus), "2B 0D 00 00 01 60 41 00 00 00 00 03 56 34 12");
  EXPECT_EQ(ask_with(number(0xDEADBEEF, 4), kReadStatus), "2B 0D 00 00 01 60 41 00 00 00 00 04 EF BE AD DE");
  EXPECT_EQ(ask_with(text_of(""), kReadStatus), "2B 0D 00 00 01 60 41 00 00 00 00 00") << "an empty one";
}

TEST_F(ObjectsByFunction4313, AreWrittenAsNumbersWhereTheyAreOfTheirSize) {
  EXPECT_EQ(plc.ask(kWriteTarget), "2B 0D 01 00 01 60 7A 00 00 00 00 00");
  EXPECT_TRUE(last().write);
  EXPECT_EQ(last().index, 0x607A);
  EXPECT_EQ(last().size, 4);
  EXPECT_EQ(last().data, 10000U);
  EXPECT_EQ(last().bytes, nullptr);
  EXPECT_EQ(plc.ask("2B 0D 01 00 01 60 40 00 00 00 00 02 0F 01"), "2B 0D 01 00 01 60 40 00 00 00 00 00");
  EXPECT_EQ(last().size, 2);
  EXPECT_EQ(last().data, 0x010FU);
  EXPECT_EQ(plc.ask("2B 0D 01 00 01 60 60 00 00 00 00 01 FD"), "2B 0D 01 00 01 60 60 00 00 00 00 00");
  EXPECT_EQ(last().size, 1);
  EXPECT_EQ(last().data, 0xFDU);
}

TEST_F(ObjectsByFunction4313, AreWrittenAsBytesWhereTheyAreOfAnother) {
  EXPECT_EQ(plc.ask("2B 0D 01 00 01 20 00 07 00 00 00 03 01 02 03"), "2B 0D 01 00 01 20 00 07 00 00 00 00");
  EXPECT_EQ(last().size, 0);
  EXPECT_EQ(last().subindex, 7);
  ASSERT_NE(last().bytes, nullptr);
  EXPECT_EQ(hex_text(*last().bytes), "01 02 03");
}

TEST_F(ObjectsByFunction4313, RepeatCounterNetworkAndEncoding) {
  EXPECT_EQ(ask_with(number(7, 1), "2B 0D 26 00 99 00 50 01 60 41 00 00 00 00 00"),
            "2B 0D 26 00 99 00 50 01 60 41 00 00 00 00 01 07");
  EXPECT_EQ(plc.ask("2B 0D 21 00 98 01 60 60 00 00 00 00 01 03"), "2B 0D 21 00 98 01 60 60 00 00 00 00 00");
}

TEST_F(ObjectsByFunction4313, GiveTheDriveTheTimeOfAWrite) {
  static_cast<void>(plc.ask(kReadStatus));
  const Group& group = desk.port.submitted.back().group;
  EXPECT_EQ(group.start_by, desk.runtime.now() + desk.settings.start_deadline);
  EXPECT_EQ(group.answer_by, desk.runtime.now() + desk.settings.reply_deadline);
  EXPECT_EQ(group.role, Role::engineer);
  EXPECT_NE(group.client, 0U);
}

TEST_F(ObjectsByFunction4313, TheDrivesRefusalIsTheExtendedException) {
  EXPECT_EQ(ask_with(refused(0x06020000, 0x06020000), kReadName), "AB FF 00 06 0D CE 06 02 00 00");
  EXPECT_EQ(ask_with(refused(0x06010002, 0x06010002), kWriteTarget), "AB FF 00 06 0D CE 06 01 00 02");
  EXPECT_EQ(ask_with(refused(0, 3), kReadName), "AB FF 00 06 0D CE 08 00 00 00") << "without a reason: general error";
}

TEST_F(ObjectsByFunction4313, WhatADriveOfAnotherProtocolSaidIsInCommandDetail) {
  EXPECT_EQ(ask_with(refused(0x08000000, 2), kReadName), "AB FF 00 06 0D CE 08 00 00 00");
  EXPECT_EQ(plc.read(125, 3), "00 03 00 00 00 02");
  Line panel(desk, Role::viewer, kPanel);
  EXPECT_EQ(panel.read(125, 3), "00 00 00 00 00 00") << "and nobody else's";
}

TEST_F(ObjectsByFunction4313, ResultsAreOtherwiseNotTheCommands) {
  EXPECT_TRUE(is_done(plc.write(146, 1)));
  EXPECT_EQ(plc.read(125), "00 02");
  EXPECT_EQ(ask_with({{Errc::timed_out, 0}}, kReadName), "AB 0B");
  EXPECT_EQ(plc.read(125), "00 02");
  desk.port.slow = true;
  plc.send("06 00 92 00 02");
  desk.port.at_once = {refused(0x08000000, 2)};
  plc.send(kReadName);
  Line other(desk, Role::viewer, kPanel);
  desk.port.finish();
  EXPECT_TRUE(is_done(plc.reply()));
  EXPECT_EQ(plc.reply(), "AB FF 00 06 0D CE 08 00 00 00");
  EXPECT_EQ(plc.read(125, 3), "00 02 00 00 00 00") << "a command under way keeps its registers";
}

/// Design 3.3's outcome table: with a refusal by the drive as the one end that has a form of its own.
TEST_F(ObjectsByFunction4313, OtherEndsArePlainExceptionsAtOnceAndLater) {
  for (int code = 1; code < kErrcCount; ++code) {
    const auto errc = static_cast<Errc>(code);
    if (errc == Errc::refused_by_drive) continue;
    for (const char* pdu : {kReadName, kWriteTarget}) {
      SCOPED_TRACE(std::string(text(errc)) + ": " + pdu);
      const std::string expected = "AB 0" + std::string(1, "0123456789AB"[static_cast<int>(modbus_exception(errc))]);
      desk.port.slow = false;
      EXPECT_EQ(ask_with({{errc, 5}}, pdu), expected);
      desk.port.slow = true;
      EXPECT_EQ(plc.ask(pdu), "");
      desk.port.finish({errc, 5});
      EXPECT_EQ(plc.reply(), expected);
    }
  }
  EXPECT_EQ(modbus_exception(Errc::offline), ModbusException::gateway_path_unavailable);
  EXPECT_EQ(modbus_exception(Errc::timed_out), ModbusException::gateway_target_failed);
}

TEST_F(ObjectsByFunction4313, OfAnUnknownAxisAre0x0A) {
  EXPECT_EQ(plc.ask("2B 0D 00 00 03 10 08 00 00 00 00 00"), "AB 0A");
  EXPECT_EQ(plc.ask("2B 0D 00 00 00 10 08 00 00 00 00 00"), "AB 0A") << "the flat map has no axis of its own";
  EXPECT_EQ(plc.ask("2B 0D 04 00 01 01 10 08 00 00 00 00 00"), "AB 0A") << "257";
  EXPECT_EQ(plc.ask("2B 0D 05 00 FF FF 10 08 00 00 00 00 01 07"), "AB 0A");
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST_F(ObjectsByFunction4313, TheNetworkIdIsTheHighByteOfTheAxisNumber) {
  for (const AxisNumber axis : {AxisNumber{256}, AxisNumber{301}, AxisNumber{499}}) {
    desk.image.add_axis(axis, "far", 0).link_state = LinkState::online;
    const std::string node = word(axis);
    EXPECT_EQ(ask_with(number(1, 1), "2B 0D 04 00 " + node + " 60 41 00 00 00 00 00"),
              "2B 0D 04 00 " + node + " 60 41 00 00 00 00 01 01");
    EXPECT_EQ(desk.port.submitted.back().axis, axis);
  }
  EXPECT_EQ(ask_with(number(1, 1), "2B 0D 04 00 00 05 60 41 00 00 00 00 00"),
            "2B 0D 04 00 00 05 60 41 00 00 00 00 01 01");
  EXPECT_EQ(desk.port.submitted.back().axis, 5);
}

TEST_F(ObjectsByFunction4313, InTheUnitOfAnAxisAreOfNodeNOr0) {
  desk.settings.per_axis_units = true;
  const std::string rest = " 60 41 00 00 00 00 00";
  for (const std::string node : {"05", "00"}) {
    desk.port.at_once = {number(1, 1)};
    EXPECT_EQ(plc.ask("2B 0D 00 00 " + node + rest, 5), "2B 0D 00 00 " + node + " 60 41 00 00 00 00 01 01");
    EXPECT_EQ(desk.port.submitted.back().axis, 5);
  }
  static_cast<void>(desk.port.taken());
  EXPECT_EQ(plc.ask("2B 0D 00 00 01" + rest, 5), "AB 0A") << "another axis";
  EXPECT_EQ(plc.ask("2B 0D 04 00 01 00" + rest, 5), "AB 0A") << "256";
  EXPECT_EQ(plc.ask("2B 0D 00 00 05" + rest, 3), "AB 0A") << "no such unit";
  EXPECT_TRUE(desk.port.submitted.empty());
  EXPECT_TRUE(is_done(plc.ask("2B 0D 00 00 05" + rest, 255))) << "the flat map";
  EXPECT_EQ(plc.ask("2B 0D 00 00 00" + rest, 255), "AB 0A");
}

TEST_F(ObjectsByFunction4313, WhatDoesNotHoldTogetherIs0x03) {
  EXPECT_EQ(plc.ask("2B 0D 80 00 01 10 08 00 00 00 00 00"), "AB 03") << "the extend flag in a read";
  EXPECT_EQ(plc.ask("2B 0D 40 00 00 01 10 08 00 00 00 00 00"), "AB 03") << "a two-byte control in a read";
  EXPECT_EQ(plc.ask("2B 0D 00 00 01 10 08 00 00 00 00"), "AB 03");
  EXPECT_EQ(plc.ask("2B 0D 01 00 01 10 08 00 00 00 00 02 01"), "AB 03");
  EXPECT_TRUE(desk.port.submitted.empty());
}

TEST_F(ObjectsByFunction4313, AlwaysWaitForTheDriveAlsoWhereWritesArePosted) {
  desk.settings.posted_writes = true;
  desk.port.slow = true;
  EXPECT_EQ(plc.ask(kWriteTarget), "");
  desk.port.finish_with(refused(0x06090030, 0x06090030));
  EXPECT_EQ(plc.reply(), "AB FF 00 06 0D CE 06 09 00 30");
  EXPECT_EQ(plc.ask(kReadStatus), "");
  desk.port.finish({}, 7, 1);
  EXPECT_EQ(plc.reply(), "2B 0D 00 00 01 60 41 00 00 00 00 01 07");
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
