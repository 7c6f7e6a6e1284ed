// SPDX-License-Identifier: Apache-2.0
// /history and /history.csv: what they say, and what is said of what they cannot.
#include <gmock/gmock.h>

#include "gateway/image/events.hpp"
#include "gateway/upstream/web_process/api/asked.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr SteadyNs kStep = 10 * kMillisecond;

/// All pieces.
std::string csv_of(const Answer& answer) {
  const auto& response = std::get<Response>(answer.what);
  if (!response.pieces) return std::string(response.body());
  std::string out;
  for (std::string piece = response.pieces(); !piece.empty(); piece = response.pieces()) out += piece;
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find("\r\n", at);
    out.push_back(text.substr(at, end - at));
    at = end + 2;
  }
  return out;
}

AxisSample moving(std::int32_t position, std::int32_t velocity) {
  AxisSample out = standing(1);
  out.values.clear();
  set(out, Quantity::position_actual, position);
  set(out, Quantity::velocity_actual, velocity);
  return out;
}

TEST(HistoryAnswers, HaveEachLineInSlices) {
  Told told;
  for (int i = 0; i < 100; ++i) told.tell(moving(i * 10000, i == 50 ? -9000 : 1500), i * kStep);
  const Json json =
      body_of(asked(told, "/api/v1/history?series=1.position_rev,1.velocity_rpm&from=-1.6&points=16", kSecond));
  EXPECT_EQ(json["from"], "2026-11-28T20:39:59.400000Z");
  EXPECT_EQ(json["to"], "2026-11-28T20:40:01.000000Z");
  EXPECT_EQ(json["oldest"], "2026-11-28T20:40:00.000000Z");
  const Json& position = json["series"]["1.position_rev"];
  EXPECT_EQ(position[0].dump(), R"(["2026-11-28T20:39:59.400000Z",null,null])") << "nothing was known yet";
  EXPECT_EQ(position[1].dump(), R"(["2026-11-28T20:40:00.000000Z",0.0,9.0])");
  EXPECT_EQ(position[10].dump(), R"(["2026-11-28T20:40:00.900000Z",90.0,99.0])");
  double lowest = 0;
  for (const Json& slice : json["series"]["1.velocity_rpm"])
    if (!slice[1].is_null()) lowest = std::min(lowest, slice[1].get<double>());
  EXPECT_EQ(lowest, -9.0);
}

TEST(HistoryAnswers, TakeTimesInUtcOrBeforeNow) {
  Told told;
  const auto span = [&](const std::string& parameters) {
    const Json json = body_of(asked(told, "/api/v1/history?series=1.position_rev" + parameters, kSecond));
    return json.contains("detail") ? json["detail"].get<std::string>()
                                   : json["from"].get<std::string>() + " " + json["to"].get<std::string>();
  };
  EXPECT_EQ(span(""), "2026-11-28T20:39:01.000000Z 2026-11-28T20:40:01.000000Z");
  EXPECT_EQ(span("&from=-0.25&to=0"), "2026-11-28T20:40:00.750000Z 2026-11-28T20:40:01.000000Z");
  EXPECT_EQ(span("&from=2026-11-28T20:00:00Z&to=2026-11-28T20:30:00.5Z"),
            "2026-11-28T20:00:00.000000Z 2026-11-28T20:30:00.500000Z");
  EXPECT_EQ(span("&to=2026-11-28T23:00:00Z"), "2026-11-28T20:39:01.000000Z 2026-11-28T20:40:01.000000Z")
      << "what is to come is not shown";
  EXPECT_EQ(span("&from=0"), "from: it must lie before `to`, and before now");
  EXPECT_EQ(span("&from=-1&to=-1"), "from: it must lie before `to`, and before now");
  for (const char* const none :
       {"10", "-", "-x", "-1e3", "-1.", "+5", "2026-11-28", "2026-11-28T20:40:00", "2026-11-28T20:40:00.Z",
        "2026-02-30T00:00:00Z", "2026-11-28T24:00:00Z", "2026-11-28 20:40:00Z", "9999-11-28T20:40:00Z",
        "1970-12-31T23:59:59Z", "-99999999999", "2026-11-28T20:40:00.0000000001Z", "2026-11-28T20:40:0xZ"})
    EXPECT_EQ(
        span(std::string("&from=") + (*none == '+' ? "%2B5" : none)),
        std::string("from: '") + none +
            "' is no time: UTC of the years 1971 to 2199 as 2026-11-28T20:40:00.5Z, or seconds before now as -10");
}

TEST(HistoryAnswers, SayWhatAParameterMayBe) {
  Told told;
  const std::string history = "/api/v1/history?series=1.position_rev";
  EXPECT_EQ(detail_of(asked(told, history + "&points=15")), "points: '15' is no whole number from 16 to 4000");
  EXPECT_EQ(detail_of(asked(told, history + "&points=4001")), "points: '4001' is no whole number from 16 to 4000");
  EXPECT_EQ(detail_of(asked(told, history + "&separator=;")),
            "separator: there is no such parameter; there are: series, from, to, points");
  EXPECT_THAT(detail_of(asked(told, "/api/v1/history")), StartsWith("series: 1 to 16 with commas between"));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/history?series=")), StartsWith("series: '' is none"));
  EXPECT_THAT(detail_of(asked(told, history + ",2.position_rev")),
              HasSubstr("'2.position_rev': there is no axis 2; there are: 1, 3"));
  EXPECT_THAT(detail_of(asked(told, history + ",1.position_rev")), HasSubstr("'1.position_rev' is given twice"));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/history?series=%ff.%fe")), StartsWith("series: '\uFFFD.\uFFFD' is none"))
      << "an answer is UTF-8, whatever was asked";
  std::string many;
  for (int i = 0; i < 17; ++i) many += "3.statusword,";
  EXPECT_EQ(detail_of(asked(told, "/api/v1/history?series=" + many)), "series: at most 16");
  const std::string csv = "/api/v1/history.csv?series=1.position_rev";
  EXPECT_EQ(detail_of(asked(told, csv + "&separator=x")), "separator: 'x' is none; there are: a comma, ;, a tab (%09)");
  EXPECT_EQ(detail_of(asked(told, csv + "&decimal=,")),
            "decimal: it must be another sign than `separator`: separator=; with decimal=,");
  EXPECT_THAT(detail_of(asked(told, csv + "&points=20")), HasSubstr("there are: series, from, to, separator, decimal"));
}

TEST(HistoryAnswers, RefuseWhatWouldBeTooLong) {
  Told told;
  for (int i = 0; i < 4000; ++i) told.tell(moving(i * 7919 % 1000003, i * 104729 % 1000003), i * kStep);
  std::string series;
  for (const char* const each : {"statusword", "position_rev", "velocity_rpm", "mode", "error_code"})
    series += (series.empty() ? "1." : ",1.") + std::string(each);
  EXPECT_EQ(status_of(asked(told, "/api/v1/history?points=4000&from=-40&series=" + series, 40 * kSecond)), 200U);
  AxisSample sample = standing(1);
  for (int i = 0; i < 4000; ++i) {
    sample.values.clear();
    for (std::uint8_t name = 0; name < 16; ++name) sample.values.push_back({name, i * 104729 % 1000003 + name, 0});
    told.tell(sample, 40 * kSecond + i * kStep);
  }
  for (const char* const each : {"torque_percent", "current_a", "following_error_rev", "vendor_error", "inputs",
                                 "outputs", "drive_temperature_c", "dc_voltage_v", "controlword", "mode_asked"})
    series += ",1." + std::string(each);
  const Answer answer = asked(told, "/api/v1/history?points=4000&from=-40&series=" + series, 80 * kSecond);
  EXPECT_EQ(status_of(answer), 400U);
  EXPECT_THAT(detail_of(answer), HasSubstr("ask for fewer series or points, or for /api/v1/history.csv"));
}

TEST(HistoryCsv, HasARowForEachInstantWithWhatHeldThen) {
  Told told;
  AxisSample slow = standing(1);
  slow.values.clear();
  set(slow, Quantity::position_actual, 1);
  told.tell(slow);
  for (int i = 1; i <= 4; ++i) {
    AxisSample fast = standing(1);
    fast.values.clear();
    set(fast, Quantity::velocity_actual, i < 4 ? 1500 : -20);
    if (i == 3) set(fast, Quantity::position_actual, 25001);
    told.tell(fast, i * kStep);
  }
  AxisSample mute = standing(1);
  mute.values.clear();
  mute.valid = 0;
  told.tell(mute, 5 * kStep);
  told.tell(EventRecord{1, kStarted + 2 * kStep + 5 * kMillisecond, 1, static_cast<std::uint8_t>(EventKind::fault), 7,
                        "a \"hard\"\nstop, late"},
            5 * kStep);
  EXPECT_THAT(lines_of(csv_of(
                  asked(told, "/api/v1/history.csv?series=1.position_rev,1.velocity_rpm&from=-1", 60 * kMillisecond))),
              ElementsAre("time,1.position_rev,1.velocity_rpm,event",  //
                          "2026-11-28T20:40:00.000000Z,0.0001,,",      //
                          "2026-11-28T20:40:00.010000Z,0.0001,1.5,",   //
                          "2026-11-28T20:40:00.025000Z,0.0001,1.5,\"axis 1, fault: a \"\"hard\"\" stop, late\"",
                          "2026-11-28T20:40:00.030000Z,2.5001,1.5,",    //
                          "2026-11-28T20:40:00.040000Z,2.5001,-0.02,",  //
                          "2026-11-28T20:40:00.050000Z,,,",             //
                          "2026-11-28T20:40:00.060000Z,,,"));
  EXPECT_THAT(lines_of(csv_of(
                  asked(told, "/api/v1/history.csv?series=1.velocity_rpm&separator=;&decimal=,&from=-0.03&to=-0.015",
                        60 * kMillisecond))),
              ElementsAre("time;1.velocity_rpm;event", "2026-11-28T20:40:00.030000Z;1,5;",
                          "2026-11-28T20:40:00.040000Z;-0,02;", "2026-11-28T20:40:00.045000Z;-0,02;"));
}

TEST(HistoryCsv, HasNoExponents) {
  Told told;
  AxisInfoRecord info = told.picture().find(1)->info;
  info.units_numerator = 10'000'000;
  told.tell(info);
  told.tell(moving(1, 0));
  EXPECT_THAT(csv_of(asked(told, "/api/v1/history.csv?series=1.position_rev", kStep)), HasSubstr(",0.0000001,"));
}

TEST(HistoryCsv, IsMadeInPiecesThatAreBounded) {
  Told told;
  for (int i = 0; i < 20000; ++i) told.tell(moving(i, -i), i * kStep);
  const Answer answer =
      asked(told, "/api/v1/history.csv?series=1.position_rev,1.velocity_rpm&from=-200", 200 * kSecond);
  const auto& response = std::get<Response>(answer.what);
  EXPECT_EQ(response.type, "text/csv; charset=utf-8");
  std::size_t longest = 0, pieces = 0, rows = 0;
  for (std::string piece = response.pieces(); !piece.empty(); piece = response.pieces()) {
    longest = std::max(longest, piece.size());
    rows += lines_of(piece).size();
    ++pieces;
  }
  EXPECT_LT(longest, HistoryCsv::kPiece + 1024);
  EXPECT_GT(pieces, 20U);
  EXPECT_EQ(rows, 20000U + 2U) << "with the names, and the end";
}

TEST(HistoryCsv, SaysNothingOfWhatIsThrownAwayWhileItIsTaken) {
  std::vector<Point> points;
  for (int i = 0; i < 2000; ++i) points.push_back({i * kStep, i, true});
  SteadyNs forgotten = -1;
  CsvRequest request;
  request.series = {{1, static_cast<std::uint8_t>(Quantity::statusword)}};
  request.axes.resize(1);
  request.span = {0, 20 * kSecond};
  HistoryCsv csv(
      request,
      [&](Series, SteadyNs from, SteadyNs, const Visit& visit) {
        for (const Point& point : points)
          if (point.at >= from && point.at > forgotten && !visit(point)) return;
      },
      at(0));
  std::string text = csv.next();
  forgotten = 15 * kSecond;
  for (std::string piece = csv.next(); !piece.empty(); piece = csv.next()) text += piece;
  std::string hole;
  const auto lines = lines_of(text);
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i].ends_with(",1501,")) hole = lines[i - 1];
  EXPECT_THAT(hole, testing::EndsWith("Z,,")) << "an empty cell between what was before and what is behind";
}

}  // namespace
}  // namespace axisgate::web
