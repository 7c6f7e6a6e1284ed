// SPDX-License-Identifier: Apache-2.0
// The table of `axisgate topics`: in words, at any width.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "gateway/core/shown_words.hpp"
#include "gateway/core/words.hpp"
#include "gateway/upstream/dds_process/topics_table.hpp"

namespace axisgate::dds {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint32_t kAllGood = 0x3FFF;
constexpr std::int64_t kNow = 1'700'000'000'250'000'000;

axisgate::AxisState faulted() {
  axisgate::AxisState axis;
  axis.axis(12);
  axis.name("turntable");
  axis.stamp().sec(1'700'000'000);
  axis.mode(1);
  axis.position(-1.5);
  axis.error_code(0x3210);
  axis.vendor_error(8);
  axis.axis_state(6);
  axis.alarms(1U << 0 | 1U << 5 | 1U << 30);
  axis.link_state(2);
  axis.supported(kAllGood);
  axis.valid(kAllGood);
  return axis;
}

std::string table_of(const axisgate::AxisState& axis, std::size_t columns) {
  return topics_table({{AxisKey(axis.gateway().to_string(), axis.axis()), axis}}, kNow, columns);
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
    longest = std::max(longest, text.find('\n', at) - at);
  return longest;
}

/// Breaks of lines as blanks, and one for many.
std::string flat(const std::string& text) {
  std::string out;
  for (const char c : text)
    if ((c != ' ' && c != '\n') || (!out.empty() && out.back() != ' ')) out += c == '\n' ? ' ' : c;
  return out;
}

TEST(TopicsTable, HasWordsWhereTopHasThemAtEveryWidth) {
  for (const std::size_t columns : {0U, 80U, 120U, 200U}) {
    const std::string text = table_of(faulted(), columns);
    EXPECT_LE(columns == 0 ? 0 : longest_line(text), columns) << text;
    for (const std::string& word :
         {std::string("turntable"), std::string(name_of(WordKind::link_state, 2)),
          std::string(name_of(WordKind::axis_state, 6)), std::string(name_of(WordKind::mode, 1)), std::string("-1.500"),
          shown_error(0x3210, 8, true), names_of_bits(WordKind::axis_alarm, 1U << 0 | 1U << 5), std::string("bit 30"),
          std::string("0.25")})
      EXPECT_THAT(flat(text), HasSubstr(word)) << columns;
    EXPECT_THAT(text, Not(HasSubstr("40000021"))) << "alarms as a number";
  }
}

TEST(TopicsTable, NamesTheGatewayWhereOneHasAName) {
  axisgate::AxisState axis = faulted();
  axis.gateway("cell_7");
  for (const std::size_t columns : {0U, 80U})
    EXPECT_THAT(flat(table_of(axis, columns)), HasSubstr("cell_7 ")) << columns;
  EXPECT_LE(longest_line(table_of(axis, 80)), 80U);
}

TEST(TopicsTable, SaysLatchedOfAnAxisThatStandsAsTopDoes) {
  axisgate::AxisState axis = faulted();
  axis.axis_state(5);
  axis.alarms(1U << 7);
  axis.velocity(0.05);
  EXPECT_THAT(table_of(axis, 0), HasSubstr("  latched  "));
  axis.velocity(-0.2);
  EXPECT_THAT(table_of(axis, 0), HasSubstr("  stopping  "));
  axis.velocity(0);
  axis.valid(kAllGood & ~(1U << 3));  // an old speed shows nothing
  EXPECT_THAT(table_of(axis, 0), HasSubstr("  stopping  "));
  axis.supported(kAllGood & ~(1U << 3));
  EXPECT_THAT(table_of(axis, 0), HasSubstr("  latched  "));
}

TEST(TopicsTable, OldValuesAreMarkedAndAnOldVendorErrorIsLeftOut) {
  axisgate::AxisState axis = faulted();
  axis.valid(0);
  for (const std::size_t columns : {0U, 80U}) {
    const std::string text = flat(table_of(axis, columns));
    EXPECT_THAT(text, HasSubstr("-1.500?"));
    EXPECT_THAT(text, HasSubstr(std::string(name_of(WordKind::mode, 1)) + "?"));
    EXPECT_THAT(text, Not(HasSubstr("(0x8)")));
  }
  axis.supported(0);
  EXPECT_THAT(table_of(axis, 0), Not(HasSubstr("1.500")));
}

TEST(TopicsTable, ALineIsInTheSameWords) {
  const std::string line = topics_line(faulted());
  EXPECT_THAT(line, HasSubstr("axis 12 turntable: online, "));
  EXPECT_THAT(line, HasSubstr(names_of_bits(WordKind::axis_alarm, 1U << 0 | 1U << 5)));
}

}  // namespace
}  // namespace axisgate::dds
