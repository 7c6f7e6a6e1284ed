// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/view/top_table.hpp"

#include <gmock/gmock.h>

#include <array>

#include "gateway/commands/top/top_screen.hpp"
#include "gateway/core/words.hpp"
#include "gateway/image/process_image.hpp"

namespace axisgate::commands {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

void put32(AxisReading& axis, std::size_t offset, std::uint32_t value) {
  axis.registers[offset] = static_cast<std::uint16_t>(value >> 16);
  axis.registers[offset + 1] = static_cast<std::uint16_t>(value);
}

AxisReading good_axis(AxisNumber number) {
  AxisReading axis;
  axis.axis = number;
  axis.registers[1] = 1;
  put32(axis, 2, 123456);
  put32(axis, 4, static_cast<std::uint32_t>(-12500));
  axis.registers[6] = static_cast<std::uint16_t>(-5);
  axis.registers[7] = 345;
  axis.registers[18] = 2;
  axis.registers[19] = 12;
  put32(axis, 20, 0xFFFFFFFF);
  put32(axis, 22, 0xFFFFFFFF);
  axis.registers[31] = 2;
  return axis;
}

TopReading reading_of(std::vector<AxisReading> axes) {
  TopReading reading;
  reading.server = "127.0.0.1:1502";
  reading.gateway = {1, 2, 1, 2, 0, 3725, 0, 3, 0, 0, 0x0102, 0x0304};
  reading.axes = std::move(axes);
  return reading;
}

std::vector<std::string> lines_of(const std::vector<TopLine>& table) {
  std::vector<std::string> lines;
  for (const TopLine& line : table) lines.push_back(line.text);
  return lines;
}

std::string axis_line(const AxisReading& axis) { return lines_of(table_lines(reading_of({axis}))).at(2); }

std::vector<std::string> words(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

TEST(TopTable, TellsOfTheGatewayInItsFirstLine) {
  EXPECT_EQ(lines_of(table_lines(reading_of({good_axis(1)})))[0],
            "axisgate 127.0.0.1:1502  running  axes online 2 of 2  up 1:02:05  role engineer  alarms: none");
}

TEST(TopTable, AStoppedAxisThatStandsIsLatched) {
  AxisReading axis = good_axis(1);
  axis.registers[31] = 5;
  put32(axis, 34, bit(AxisAlarm::stop_latched));
  EXPECT_THAT(axis_line(axis), testing::HasSubstr("stopping"));
  put32(axis, 4, 0);
  EXPECT_THAT(axis_line(axis), testing::HasSubstr("  latched  "));
  put32(axis, 34, 0);
  EXPECT_THAT(axis_line(axis), testing::HasSubstr("stopping")) << "halted";
}

TEST(TopTable, ASpeedBesideAStandstillIsMarkedAsThatOfBefore) {
  AxisReading axis = good_axis(1);
  EXPECT_THAT(axis_line(axis), testing::HasSubstr(" -12.500 "));
  axis.registers[31] = 1;
  EXPECT_THAT(axis_line(axis), testing::HasSubstr(" -12.500? "));
  put32(axis, 4, 500);  // it trembles
  EXPECT_THAT(axis_line(axis), testing::HasSubstr(" 0.500 "));
}

TEST(TopTable, WritesFloatsInTurnsAndRpm) {
  AxisReading axis = good_axis(1);
  put32(axis, 2, 0xC1200000);  // -10
  put32(axis, 4, 0x44BB8000);  // 1500
  TopReading reading = reading_of({axis});
  reading.float_numbers = true;
  EXPECT_THAT(lines_of(table_lines(reading)).at(2),
              AllOf(HasSubstr(" -10.0000 "), HasSubstr(" 1500.000 "), HasSubstr(" -0.5 ")));
  put32(reading.axes[0], 2, 0x7FC00000);
  put32(reading.axes[0], 22, 0);
  EXPECT_THAT(lines_of(table_lines(reading)).at(2), AllOf(HasSubstr(" ? "), HasSubstr(" 1500.000? ")));
}

TEST(TopTable, WritesAnAxisInItsUnits) {
  EXPECT_THAT(words(axis_line(good_axis(7))), ElementsAre("7", "online", "discrete", "motion", "profile", "position",
                                                          "123456", "-12.500", "-0.5", "3.45", "12", "none", "-"));
}

TEST(TopTable, PutsEveryNumberUnderItsColumn) {
  const auto lines = lines_of(table_lines(reading_of({good_axis(1)})));
  for (const auto& [column, value] : {std::pair{"position  ", "123456  "},
                                      {"velocity rpm  ", "-12.500  "},
                                      {"torque %  ", "-0.5  "},
                                      {"current A  ", "3.45  "},
                                      {"age ms  ", "12  "}}) {
    // The first column named position is of the mode; the header has it once.
    EXPECT_EQ(lines[1].find(column) + std::string(column).size(), lines[2].find(value) + std::string(value).size())
        << column;
  }
}

TEST(TopTable, MarksValuesThatAreNotGoodNow) {
  AxisReading axis = good_axis(1);
  put32(axis, 22, 0);
  axis.registers[18] = 4;
  EXPECT_THAT(words(axis_line(axis)), ElementsAre("1", "offline", "discrete", "motion", "profile", "position?",
                                                  "123456?", "-12.500?", "-0.5?", "3.45?", "12", "none", "-"));
}

TEST(TopTable, ShowsAQuestionMarkWhereThereNeverWasAValueAndADashWhereTheDriveHasNone) {
  AxisReading axis = good_axis(1);
  put32(axis, 2, 0x80000000);
  axis.registers[1] = 0x8000;
  put32(axis, 20, 0xFFFFFFFF & ~bit(Quantity::torque_actual));
  const auto line = words(axis_line(axis));
  EXPECT_EQ(line[4], "?") << "mode";
  EXPECT_EQ(line[5], "?") << "position";
  EXPECT_EQ(line[7], "-") << "torque";
}

TEST(TopTable, KeepsTheSignOfNumbersBelowOne) {
  AxisReading axis = good_axis(1);
  put32(axis, 4, static_cast<std::uint32_t>(-7));
  EXPECT_THAT(axis_line(axis), HasSubstr("  -0.007  "));
}

TEST(TopTable, NamesAlarmsErrorsAndOwnModes) {
  AxisReading axis = good_axis(1);
  axis.registers[1] = static_cast<std::uint16_t>(-3);
  axis.registers[10] = 0x3210;
  put32(axis, 12, 0x40);
  put32(axis, 34, bit(AxisAlarm::not_homed) | bit(AxisAlarm::stop_latched) | 1U << 31);
  const std::string line = axis_line(axis);
  EXPECT_THAT(line, HasSubstr("own -3"));
  EXPECT_THAT(line, HasSubstr("0x3210 overvoltage (0x40)"));
  EXPECT_THAT(line, EndsWith("not_homed, stop_latched, bit 31"));
}

TEST(TopTable, SaysOfAFaultWhoseCauseIsNotReadThatItIsNotKnown) {
  AxisReading axis = good_axis(1);
  axis.registers[10] = 0xFFFF;
  put32(axis, 12, 0xFFFFFFFF);
  put32(axis, 22, ~(bit(Quantity::error_code) | bit(Quantity::vendor_error)));
  EXPECT_THAT(axis_line(axis), HasSubstr("  ?  ")) << "no fault: nothing was read yet";
  axis.registers[31] = static_cast<std::uint16_t>(AxisState::error_stop);
  EXPECT_THAT(axis_line(axis), HasSubstr("  not known yet  "));
}

TEST(TopTable, SaysThatAValueIsOlderThanTheRegisterCanTell) {
  AxisReading axis = good_axis(1);
  axis.registers[19] = 0xFFFF;
  EXPECT_THAT(axis_line(axis), HasSubstr(">65 s"));
}

TEST(TopTable, NamesTheGatewaysAlarmsAndState) {
  TopReading reading = reading_of({});
  reading.gateway[2] = static_cast<std::uint16_t>(GatewayState::degraded);
  reading.gateway[6] =
      1U << static_cast<unsigned>(GatewayAlarm::bus_down) | 1U << static_cast<unsigned>(GatewayAlarm::bus_overloaded);
  const auto lines = lines_of(table_lines(reading));
  EXPECT_THAT(lines[0], HasSubstr("degraded"));
  EXPECT_THAT(lines[0], EndsWith("alarms: bus down, bus overloaded"));
  EXPECT_EQ(lines[2], "no axes");
}

TEST(TopTable, ReadsBothWordOrders) {
  TopReading reading = reading_of({good_axis(1)});
  const std::string high_first = text_of(table_lines(reading));
  std::swap(reading.gateway[4], reading.gateway[5]);
  std::swap(reading.gateway[10], reading.gateway[11]);
  for (const std::size_t pair : {2U, 4U, 8U, 12U, 20U, 22U, 34U}) {
    std::swap(reading.axes[0].registers[pair], reading.axes[0].registers[pair + 1]);
  }
  EXPECT_EQ(word_order(reading.gateway), WordOrder::low_first);
  EXPECT_EQ(text_of(table_lines(reading)), high_first);
  reading.gateway[10] = 0;
  EXPECT_EQ(word_order(reading.gateway), WordOrder::unknown);
}

TEST(TopTable, FitsIntoEightyColumnsWithEveryNumberWhole) {
  AxisReading axis = good_axis(499);
  axis.name = "lift";
  axis.units_per_rev = Rational(10000);
  put32(axis, 2, 0x80000001);
  put32(axis, 4, 0x80000001);
  axis.registers[6] = 0x8001;
  axis.registers[7] = 0x8001;
  axis.registers[18] = 4;
  axis.registers[10] = 0x8130;
  put32(axis, 12, 0xFFFF);
  put32(axis, 22, 0);
  put32(axis, 34, (1U << kAxisAlarmCount) - 1);
  TopReading reading = reading_of({axis});
  reading.server = "a-rather-long-name.of-a-gateway.example.org:1502";
  reading.gateway[6] = 0x1FFF;
  const std::vector<TopLine> lines = table_lines(reading, kNarrow);
  for (const TopLine& line : lines) EXPECT_LE(line.text.size(), kNarrow) << line.text;
  const std::string table = text_of(lines);
  for (const char* whole :
       {" 499  lift  offline    discrete motion    -2147483647?   -2147483.647?\n",
        "-214748.365? turns, profile position?, torque -3276.7? %, -327.67? A, age\n      12 ms, error 0x8130 no "
        "contact"})
    EXPECT_THAT(table, HasSubstr(whole));
  for (const Word& word : axisgate::words())
    if (word.kind == WordKind::axis_alarm && word.number < kAxisAlarmCount) {
      EXPECT_THAT(table, HasSubstr(std::string(word.name)));
    }
}

TEST(TopTable, ShowsAPositionInTurnsWhereTheConfigurationIsGiven) {
  AxisReading axis = good_axis(1);
  axis.units_per_rev = Rational(60000, 37);
  TopReading reading = reading_of({axis, good_axis(2)});
  const auto lines = lines_of(table_lines(reading));
  EXPECT_THAT(lines[1], HasSubstr("position       turns  velocity rpm"));
  EXPECT_THAT(lines[2], HasSubstr("  123456      76.131       -12.500"));
  EXPECT_THAT(lines[3], HasSubstr("  123456                   -12.500")) << "an axis that is not in it";
  put32(reading.axes[0], 22, 0);
  EXPECT_THAT(lines_of(table_lines(reading))[2], HasSubstr(" 76.131? "));
  reading.axes[0].registers[2] = 0x8000;
  reading.axes[0].registers[3] = 0;
  EXPECT_THAT(lines_of(table_lines(reading))[2], HasSubstr("           ?           ?  "));
  reading.float_numbers = true;
  EXPECT_THAT(lines_of(table_lines(reading))[1], Not(HasSubstr("turns"))) << "as the register is";
}

TEST(TopTable, ANameThatLeavesNoRoomStandsInTheLineBelow) {
  AxisReading axis = good_axis(1);
  axis.name = "a-name-of-fifteen-and-more";
  const auto lines = lines_of(table_lines(reading_of({axis}), kNarrow));
  EXPECT_THAT(lines, testing::Contains(HasSubstr("      a-name-of-fifteen-and-more: profile position, ")));
  for (const std::string& line : lines) EXPECT_LE(line.size(), kNarrow) << line;
}

TEST(TopTable, SaysBelowWhichCommandExplainsWhatIsColoured) {
  TopReading reading = reading_of({good_axis(1), good_axis(2)});
  EXPECT_THAT(lines_below(reading, {}, kNarrow, true), SizeIs(0)) << "nothing is";
  reading.gateway[6] = 1U << static_cast<unsigned>(GatewayAlarm::bus_down);
  EXPECT_THAT(text_of(lines_below(reading, {}, kNarrow, true)), EndsWith("axisgate explain \"bus down\"\n"));
  put32(reading.axes[1], 34, bit(AxisAlarm::no_comm_watchdog) | bit(AxisAlarm::not_homed));
  EXPECT_EQ(text_of(lines_below(reading, {}, kNarrow, true)),
            "\nyellow warns, red has failed; more: axisgate explain no_comm_watchdog\n");
  EXPECT_EQ(text_of(lines_below(reading, {}, kNarrow, false)), "\nwhat it means: axisgate explain no_comm_watchdog\n");
  reading.axes[1].registers[10] = 0x3210;
  EXPECT_THAT(text_of(lines_below(reading, {}, kNarrow, true)), EndsWith("axisgate explain 0x3210\n"));
}

TEST(TopTable, ShowsNotesBelowAndBreaksThemBetweenWords) {
  const std::array<std::string, 2> notes{"short", "one two three"};
  EXPECT_EQ(text_of(lines_below(reading_of({}), notes, 8, true)), "\nshort\none two\n  three\n");
}

TEST(TopTable, StaysOneLineAnAxisWhereThereIsRoom) {
  AxisReading axis = good_axis(1);
  axis.name = "lift";
  const std::vector<TopLine> table = table_lines(reading_of({axis}), 200);
  EXPECT_THAT(lines_of(table), SizeIs(3));
  EXPECT_THAT(words(lines_of(table)[1])[1], "name");
  EXPECT_THAT(words(lines_of(table)[2])[1], "lift");
  EXPECT_THAT(lines_of(table_lines(reading_of({axis}), kNarrow)), SizeIs(5)) << "the first line takes two";
}

TEST(TopScreen, ColoursLinesThatAskForAttentionWithoutCuttingTheirColour) {
  AxisReading failed = good_axis(2);
  failed.registers[31] = 6;
  AxisReading uncertain = good_axis(3);
  uncertain.registers[18] = 3;
  const std::vector<TopLine> table = table_lines(reading_of({good_axis(1), failed, uncertain}));
  const std::string frame = terminal_frame(table, 60, 50, true);
  EXPECT_THAT(frame, HasSubstr("\x1b[31m   2  online     error stop"));
  EXPECT_THAT(frame, HasSubstr("\x1b[33m   3  suspect"));
  EXPECT_THAT(frame, HasSubstr("\r\n   1  online"));
  EXPECT_THAT(terminal_frame(table, 60, 50), Not(HasSubstr("\x1b[31m")));
}

TEST(TopScreen, ColoursAnAxisWithAlarmsInBothLayoutsAndNoOther) {
  AxisReading alarmed = good_axis(2);
  put32(alarmed, 34, bit(AxisAlarm::not_homed));
  AxisReading newer = good_axis(3);
  put32(newer, 34, 1U << 31);  // of a gateway that knows more alarms
  const TopReading reading = reading_of({good_axis(1), alarmed, newer});
  std::vector<Attention> wide;
  for (const TopLine& line : table_lines(reading)) wide.push_back(line.asks);
  using enum Attention;
  EXPECT_THAT(wide, ElementsAre(none, none, none, look, look));
  const std::string frame = terminal_frame(table_lines(reading), 200, 50, true);
  EXPECT_THAT(frame, AllOf(HasSubstr("  \x1b[33mnot_homed\x1b[0m"), HasSubstr("\r\n   2  online")))
      << "its alarms alone: the axis does what it should";
  EXPECT_THAT(terminal_frame(table_lines(reading), 60, 50, true), Not(HasSubstr("\x1b[33m")));
  std::vector<std::string> narrow;
  for (const TopLine& line : table_lines(reading, kNarrow))
    if (line.asks == look) narrow.push_back(line.text);
  EXPECT_THAT(narrow, ElementsAre(EndsWith("alarms: not_homed"), EndsWith("alarms: bit 31")));
}

TEST(TopScreen, AFrameIsCutToTheWindowAndWipesWhatWasThereBefore) {
  const std::string frame = terminal_frame(std::array<TopLine, 3>{{{"abcdef"}, {"x"}, {"third"}}}, 4, 2);
  EXPECT_EQ(frame, "\x1b[Habcd\x1b[K\r\nx\x1b[K\x1b[J");
}

}  // namespace
}  // namespace axisgate::commands
