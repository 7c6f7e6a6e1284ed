// SPDX-License-Identifier: Apache-2.0
// Nothing grows and nothing is left over: a plant of 30 axes that clients move, with one fault each minute, in virtual
// time. AXISGATE_DAY_MINUTES: so many (a day has 1440); without it a few faults, one close behind the other.
// AXISGATE_DAY_SEED: another day.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "tests/long_day/day.hpp"

namespace axisgate::test::long_day {
namespace {

constexpr std::uint64_t kFaults = 10;
constexpr std::chrono::milliseconds kClose = std::chrono::seconds(8);
/// In bytes: what the ring of events, the journals of simulated lines and what clients wrote fill up to by and by.
constexpr std::size_t kMostGrowth = 2'000'000;

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

TEST(LongDay, LeavesNothingBehind) {
  const std::uint64_t minutes = number_from("AXISGATE_DAY_MINUTES", 0);
  const auto day = std::make_unique<Day>(number_from("AXISGATE_DAY_SEED", 1));
  const auto tell = [](const std::string& line) { std::cout << line << std::endl; };
  const DayLeft left =
      minutes == 0 ? day->pass(kFaults, kClose, tell) : day->pass(minutes, std::chrono::minutes(1), tell);
  EXPECT_EQ(left.not_online, std::vector<AxisNumber>{});
  EXPECT_EQ(left.never_moved, std::vector<AxisNumber>{});
  EXPECT_EQ(left.wrong, "");
  EXPECT_EQ(left.waiting, 0U);
  EXPECT_EQ(left.asked.requests, left.asked.answers + left.asked.lost);
  EXPECT_LE(left.events, kMaxEvents);
  EXPECT_LE(left.allocated, left.allocated_at_first + kMostGrowth);
  std::uint64_t exchanges = 0;
  for (std::size_t line = 0; line < left.lines.size(); ++line) {
    const LineLeft& at = left.lines[line];
    EXPECT_GT(at.replies, 0U) << "line " << line;
    EXPECT_LE(at.unaccounted, at.may_be_ended) << "line " << line;
    EXPECT_EQ(at.queued, 0U) << "line " << line;
    exchanges += at.exchanges;
  }
  std::cout << exchanges << " exchanges, " << left.asked.requests << " requests: " << left.asked.answers << " answers ("
            << left.asked.exceptions << " exceptions), " << left.asked.lost << " lost with their connection; "
            << left.log_lines << " log lines, " << left.events << " events; allocated " << left.allocated_at_first
            << ", at the end " << left.allocated << "\nfaults:" << left.faults << "\n";
}

}  // namespace
}  // namespace axisgate::test::long_day
