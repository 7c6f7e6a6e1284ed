// SPDX-License-Identifier: Apache-2.0
// Which request gets which answer, and what is said of one that cannot be answered.
#include <gmock/gmock.h>

#include "gateway/image/events.hpp"
#include "gateway/upstream/web_process/files/files.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using ::testing::HasSubstr;

EventRecord event_of(std::uint64_t number, std::uint16_t axis, EventKind kind, std::uint32_t code = 0) {
  return {number, kStarted, axis, static_cast<std::uint8_t>(kind), code, "text " + std::to_string(number)};
}

TEST(Answers, RefuseUnknownParametersByName) {
  Told told;
  const Answer answer = asked(told, "/api/v1/events?limit=5&colour=red");
  EXPECT_EQ(status_of(answer), 400U);
  EXPECT_EQ(detail_of(answer), "colour: there is no such parameter; there are: after, limit, axis, kind");
  EXPECT_EQ(detail_of(asked(told, "/api/v1/gateway?x")), "x: there are no parameters here");
}

TEST(Answers, SayWhatAParameterMayBe) {
  Told told;
  EXPECT_EQ(detail_of(asked(told, "/api/v1/events?limit=0")), "limit: '0' is no whole number from 1 to 1000");
  EXPECT_EQ(detail_of(asked(told, "/api/v1/events?axis=2")), "axis: there is no axis 2; there are: 1, 3");
  EXPECT_THAT(detail_of(asked(told, "/api/v1/events?kind=red")), HasSubstr("there are: fault, warning, link"));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/events?after=x")), HasSubstr("after: "));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/stream?period_ms=49")), HasSubstr("from 50 to 5000"));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/stream?axes=1,x")), HasSubstr("axes: 'x'"));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/stream?series=1.speed")), HasSubstr("series: '1.speed' is none"));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/map?format=xml")), HasSubstr("there are: json, csv"));
  EXPECT_THAT(detail_of(asked(told, "/api/v1/explain")), HasSubstr("q: "));
  EXPECT_EQ(detail_of(asked(told, "/api/v1/events?limit=1&limit=2")), "limit: given twice");
  EXPECT_THAT(detail_of(asked(told, "/api/v1/explain?q=%zz")), HasSubstr("hexadecimal"));
}

TEST(Answers, MakeNoPathOfAName) {
  Told told;
  for (const char* target :
       {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc%2fpasswd", "/index.html%00.js",
        "//etc/passwd", "/api/v1/../../etc/passwd", "/api/v1/buses/..%2f..%2fetc", "/.", "/%"})
    EXPECT_EQ(status_of(asked(told, target)), 404U) << target;
}

TEST(Answers, HaveOneAxisOrAllOrSome) {
  Told told;
  told.tell(standing(1));
  EXPECT_EQ(body_of(asked(told, "/api/v1/axes"))["axes"].size(), 2U);
  EXPECT_EQ(body_of(asked(told, "/api/v1/axes?axes=3"))["axes"][0]["name"], "turn");
  EXPECT_EQ(body_of(asked(told, "/api/v1/axes/1")), told.axis(1));
  EXPECT_EQ(status_of(asked(told, "/api/v1/axes/2")), 404U);
  EXPECT_EQ(status_of(asked(told, "/api/v1/axes/1x")), 404U);
}

TEST(Answers, HaveBusesByName) {
  Told told;
  told.tell(statistics());
  const Json bus = body_of(asked(told, "/api/v1/buses/serial"));
  EXPECT_EQ(bus["load_percent"], 42.5);
  EXPECT_EQ(bus["planned"]["load_percent"], 40.0);
  EXPECT_EQ(bus["link"], "up");
  EXPECT_EQ(bus["counters"]["requests"], 100);
  EXPECT_EQ(bus["axes"], Json({1, 3}));
  EXPECT_EQ(body_of(asked(told, "/api/v1/buses"))["buses"][0], bus);
  EXPECT_TRUE(body_of(asked(told, "/api/v1/buses/serial", 3 * kSecond))["link"].is_null());
  EXPECT_EQ(status_of(asked(told, "/api/v1/buses/other")), 404U);
}

TEST(Answers, HaveTheGatewayWithItsAlarmsInWords) {
  Told told;
  StatisticsRecord told_of = statistics();
  told_of.alarms = 1U << 7;
  told.tell(told_of);
  const Json gateway = body_of(asked(told, "/api/v1/gateway"));
  EXPECT_EQ(gateway["boot"], "42");
  EXPECT_EQ(gateway["uptime_s"], 10);
  EXPECT_EQ(gateway["state"], "running");
  EXPECT_EQ(gateway["worst_turn_ms"], 1.5);
  EXPECT_EQ(gateway["alarms"][0]["word"], "DDS process down");
  EXPECT_NE(gateway["alarms"][0]["remedy"], "");
  EXPECT_EQ(gateway["programs"].dump(), R"([{"name":"axisgate-dds","running":true,"restarts":2}])");
  EXPECT_EQ(body_of(asked(told, "/api/v1/gateway", 3 * kSecond))["state"], "unknown");
}

TEST(Answers, HaveEventsWithCauseAndRemedyTheNewestLast) {
  Told told;
  told.tell(event_of(1, 0, EventKind::boot));
  told.tell(event_of(2, 1, EventKind::fault, 0x3210));
  told.tell(event_of(3, 3, EventKind::link, 4));
  const Json all = body_of(asked(told, "/api/v1/events"))["events"];
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0]["id"], "42.1");
  EXPECT_TRUE(all[0]["axis"].is_null());
  EXPECT_EQ(all[1]["axis_name"], "hoist");
  EXPECT_EQ(all[1]["remedy"], "a braking resistor");
  EXPECT_EQ(all[1]["at"], "2026-11-28T20:40:00.000000Z");
  EXPECT_EQ(all[2]["cause"], "power of the drive, its plug, wrong node or baud rate");
  const auto numbers = [&](const std::string& query) {
    std::string out;
    const Json body = body_of(asked(told, "/api/v1/events?" + query));
    for (const Json& each : body["events"]) out += each["number"].dump() + " ";
    return out;
  };
  EXPECT_EQ(numbers("after=1"), "2 3 ");
  EXPECT_EQ(numbers("after=42.2"), "3 ");
  EXPECT_EQ(numbers("after=41.2"), "1 2 3 ") << "of another start of the gateway";
  EXPECT_EQ(numbers("limit=2"), "2 3 ");
  EXPECT_EQ(numbers("axis=0"), "1 ");
  EXPECT_EQ(numbers("kind=fault"), "2 ");
}

TEST(Answers, ExplainWordsNumbersAndTheDrivesOwnCodes) {
  Told told;
  EXPECT_EQ(body_of(asked(told, "/api/v1/explain?q=stop_latched"))["found"][0]["kind"], "axis alarm");
  EXPECT_EQ(body_of(asked(told, "/api/v1/explain?q=result+9"))["found"][0]["name"], "state unsuitable");
  const Json of_code = body_of(asked(told, "/api/v1/explain?q=0x3210"))["found"];
  ASSERT_EQ(of_code.size(), 2U);
  EXPECT_EQ(of_code[1]["meaning"], "the DC bus is too high");
  EXPECT_TRUE(body_of(asked(told, "/api/v1/explain?q=nothing"))["found"].empty());
  EXPECT_GT(body_of(asked(told, "/api/v1/words"))["words"].size(), 100U);
}

TEST(Answers, HaveTheMapOfThisGateway) {
  Told told;
  told.tell(standing(3));
  const Json rows = body_of(asked(told, "/api/v1/map?axis=3"))["rows"];
  EXPECT_EQ(rows[0]["address"], 300);
  EXPECT_EQ(rows[0]["name"], "statusword");
  EXPECT_EQ(rows[0]["supported"], true);
  for (const Json& row : rows) EXPECT_EQ(row["axis"], 3);
  const Answer csv = asked(told, "/api/v1/map?axis=3&format=csv");
  EXPECT_EQ(std::get<Response>(csv.what).type, "text/csv; charset=utf-8");
  EXPECT_THAT(std::string(std::get<Response>(csv.what).body()),
              HasSubstr("\r\nholding,300,1,3,,statusword,u16,,r,true,\r\n"));
}

TEST(Answers, AreAtMostAMebibyteOfJson) {
  Told told;
  HelloRecord hello = told.picture().hello();
  hello.axes = 499;
  told.tell(hello);
  BusInfoRecord bus;
  told.tell(bus);
  for (std::uint16_t axis = 1; axis <= 499; ++axis) {
    AxisInfoRecord info;
    info.axis = axis;
    for (std::uint8_t i = 0; i < kQuantityCount; ++i) info.limits.push_back({i, INT32_MIN, INT32_MAX});
    told.tell(info);
    told.tell(standing(axis));
  }
  for (const char* target : {"/api/v1/axes", "/api/v1/map"}) EXPECT_EQ(status_of(asked(told, target)), 400U) << target;
  EXPECT_THAT(detail_of(asked(told, "/api/v1/axes")), HasSubstr("axes=1,2,3"));
  EXPECT_EQ(status_of(asked(told, "/api/v1/axes?axes=1,2")), 200U);
}

TEST(Answers, HaveHealthForThoseWhoWatch) {
  Told told;
  told.tell(statistics());
  EXPECT_EQ(status_of(asked(told, "/api/v1/health")), 200U);
  const Answer gone = asked(told, "/api/v1/health", 3 * kSecond);
  EXPECT_EQ(status_of(gone), 503U);
  EXPECT_EQ(body_of(gone).dump(), R"({"joined":false,"alive":false})");
}

TEST(Answers, TakeWhatAStreamMayBe) {
  Told told;
  const Answer answer = asked(told, "/api/v1/stream?period_ms=250&axes=3,1&series=1.velocity_rpm");
  const auto& stream = std::get<StreamRequest>(answer.what);
  EXPECT_EQ(stream.period_ms, 250U);
  EXPECT_EQ(stream.axes, (std::set<std::uint64_t>{1, 3}));
  EXPECT_FALSE(stream.after);
  Request resumed = get("/api/v1/stream");
  resumed.last_event_id = "42.17";
  EXPECT_EQ(std::get<StreamRequest>(answer_to(resumed, told).what).after, 17U);
}

TEST(Files, AreServedWithATagAndNotTwice) {
  for (const File& file : files()) {
    Told told;
    const Answer answer = asked(told, std::string(file.path));
    EXPECT_EQ(status_of(answer), 200U);
    EXPECT_EQ(std::get<Response>(answer.what).body(), file.plain);
    Request again = get(std::string(file.path));
    again.if_none_match = file.etag;
    EXPECT_EQ(status_of(answer_to(again, told)), 304U);
    Request compressed = get(std::string(file.path));
    compressed.takes_gzip = true;
    const Answer shorter = answer_to(compressed, told);
    EXPECT_LE(std::get<Response>(shorter.what).body().size(), file.plain.size());
  }
}

TEST(Files, AreNotThereWhereTheTableHasNone) {
  EXPECT_EQ(find_file("/CMakeLists.txt"), nullptr);
  EXPECT_EQ(find_file(""), nullptr);
  EXPECT_EQ(find_file("/none/"), nullptr);
}

}  // namespace
}  // namespace axisgate::web
