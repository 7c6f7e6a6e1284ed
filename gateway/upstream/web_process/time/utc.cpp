// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/time/utc.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <string_view>

namespace axisgate::web {
namespace {

using namespace std::chrono;

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
