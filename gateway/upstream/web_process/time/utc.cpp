// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/time/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>

namespace axisgate::web {
namespace {

using namespace std::chrono;

constexpr int kTen = 10;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct TimeOfDay {
  year_month_day date{};
  unsigned weekday = 0;
  hh_mm_ss<microseconds> time{};
};

TimeOfDay time_of_day(std::int64_t utc_ns) {
  const auto since = duration_cast<microseconds>(nanoseconds(utc_ns));
  const auto day = floor<days>(since);
  const sys_days date{day};
  return {year_month_day(date), weekday(date).c_encoding(), hh_mm_ss<microseconds>(since - day)};
}

}  // namespace

std::string utc_text(SteadyNs at, const Now& now) {
  const TimeOfDay t = time_of_day(at + now.to_utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", static_cast<int>(t.date.year()),
                     static_cast<unsigned>(t.date.month()), static_cast<unsigned>(t.date.day()), t.time.hours().count(),
                     t.time.minutes().count(), t.time.seconds().count(), t.time.subseconds().count());
}

std::optional<SteadyNs> parse_utc(std::string_view text, const Now& now) {
  // 2026-11-28T20:40:00.123456Z
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:dd";
  constexpr std::size_t kDigits = 9;
  if (text.size() < kForm.size() + 1 || !text.ends_with('Z')) return std::nullopt;
  text.remove_suffix(1);
  std::array<int, 6> numbers{};
  std::size_t number = 0;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    if (kForm[i] != 'd' && text[i] != kForm[i]) return std::nullopt;
    if (kForm[i] == 'd' && !is_digit(text[i])) return std::nullopt;
    if (kForm[i] != 'd')
      ++number;
    else
      numbers.at(number) = numbers.at(number) * kTen + (text[i] - '0');
  }
  std::string fraction(text.substr(kForm.size()));
  if (!fraction.empty()) {
    if (fraction.size() < 2 || fraction.size() > kDigits + 1 || fraction[0] != '.') return std::nullopt;
    fraction.erase(0, 1);
    if (!std::ranges::all_of(fraction, is_digit)) return std::nullopt;
  }
  fraction.resize(kDigits, '0');
  const year_month_day date{year(numbers[0]), month(static_cast<unsigned>(numbers[1])),
                            day(static_cast<unsigned>(numbers[2]))};
  constexpr int kFirstYear = 1971, kLastYear = 2199, kHours = 24, kSixty = 60;
  if (!date.ok() || numbers[0] < kFirstYear || numbers[0] > kLastYear || numbers[3] >= kHours || numbers[4] >= kSixty ||
      numbers[5] >= kSixty)
    return std::nullopt;
  const nanoseconds since = sys_days(date).time_since_epoch() + hours(numbers[3]) + minutes(numbers[4]) +
                            seconds(numbers[5]) + nanoseconds(std::stoll(fraction));
  return since.count() - now.to_utc;
}

std::string http_date(const Now& now) {
  static constexpr std::array<std::string_view, 7> kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                            "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const TimeOfDay t = time_of_day(now.at + now.to_utc);
  return fmt::format("{}, {:02} {} {:04} {:02}:{:02}:{:02} GMT", kDays.at(t.weekday),
                     static_cast<unsigned>(t.date.day()), kMonths.at(static_cast<unsigned>(t.date.month()) - 1),
                     static_cast<int>(t.date.year()), t.time.hours().count(), t.time.minutes().count(),
                     t.time.seconds().count());
}

}  // namespace axisgate::web
