// SPDX-License-Identifier: Apache-2.0
// What bad clients get of the program, and that good ones are served beside them.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "tests/web_process/client.hpp"
#include "tests/web_process/web.hpp"

namespace axisgate::web::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::uint64_t refused(Client& client, const char* reason) {
  return json::parse(client.get("/api/v1/gateway").body)["web"]["refused"][reason].get<std::uint64_t>();
}

TEST(AxisgateWebBounds, AnswerAHeaderThatDoesNotEndInTime) {
  Web web;
  Client slow(web.port()), good(web.port());
  slow.send("GET / HT");
  EXPECT_EQ(good.get("/api/v1/words").status, 200U) << "while the other one takes its time";
  const Answered answered = slow.answer();
  EXPECT_EQ(answered.status, 408U);
  EXPECT_TRUE(slow.closed());
}

TEST(AxisgateWebBounds, EndAConnectionThatAsksNothing) {
  Web web;
  Client idle(web.port());
  EXPECT_EQ(idle.answer().status, 0U);
}

TEST(AxisgateWebBounds, AnswerAHeaderOfAMebibyte) {
  Web web;
  Client client(web.port());
  client.send("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(1024 * 1024, 'x') + "\r\n\r\n");
  EXPECT_EQ(client.answer().status, 431U);
}

TEST(AxisgateWebBounds, AnswerALongLineABodyAnotherMethodAndAWrongHost) {
  Web web;
  const auto status = [&](const std::string& request) {
    Client client(web.port());
    client.send(request);
    return client.answer().status;
  };
  EXPECT_EQ(status(get_of("/" + std::string(2048, 'x'))), 414U);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc"), 400U);
  EXPECT_EQ(status("POST /api/v1/axes HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc"), 405U);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), 421U);
  EXPECT_EQ(status(get_of("/../../../etc/passwd")), 404U);
  Client good(web.port());
  for (const char* reason : {"long_request_line", "body", "method", "host", "not_found"})
    EXPECT_EQ(refused(good, reason), 1U) << reason;
}

TEST(AxisgateWebBounds, CloseAnAddressThatNobodyAllowed) {
  Web web("\"allow\": [\"10.0.0.0/8\"]");
  Client client(web.port());
  client.send(get_of("/api/v1/health"));
  EXPECT_EQ(client.answer().status, 0U);
  const auto line = web.next_line();
  ASSERT_TRUE(line);
  EXPECT_THAT(line->text, HasSubstr("127.0.0.1: closed"));
}

TEST(AxisgateWebBounds, RefuseTooManyRequestsOfOneAddress) {
  Web web;
  Client client(web.port());
  // All at once: one after the other a slow machine would ask no more than it may.
  std::string requests;
  constexpr int kMany = 400;
  for (int i = 0; i < kMany; ++i) requests += get_of("/api/v1/health");
  client.send(requests);
  Answered answered = client.answer();
  for (int i = 1; i < kMany && answered.status != 429; ++i) answered = client.answer();
  EXPECT_EQ(answered.status, 429U);
  EXPECT_THAT(answered.header, HasSubstr("\r\nRetry-After: 1\r\n"));
}

TEST(AxisgateWebBounds, KeepNoMoreStreamsThanTheyMay) {
  Web web("\"max_streams\": 1");
  web.tell_of_the_gateway();
  Client first(web.port());
  first.send(get_of("/api/v1/stream"));
  ASSERT_TRUE(first.event("hello"));
  EXPECT_EQ(Client(web.port()).get("/api/v1/stream").status, 503U);
}

TEST(AxisgateWebBounds, OutliveTenThousandConnections) {
  // As many as the system lets this test have.
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
  constexpr rlim_t kWanted = 10000, kOthers = 100;
  const auto count = static_cast<std::size_t>(std::min(kWanted, limit.rlim_cur - kOthers));
  constexpr std::size_t kKept = 20;
  Web web("\"max_connections\": 20");
  web.tell_of_the_gateway();
  std::vector<std::unique_ptr<Client>> clients;
  for (std::size_t i = 0; i < count; ++i) {
    clients.push_back(std::make_unique<Client>(web.port()));
    if (i >= kKept) {
      ASSERT_EQ(clients.back()->answer().status, 503U) << i;
      continue;
    }
    clients.back()->send(get_of("/api/v1/stream"));
    ASSERT_TRUE(clients.back()->event("hello"));
  }
  EventRecord event;
  event.number = 1;
  event.at = now();
  web.tell(event);
  for (std::size_t i = 0; i < kKept; ++i) EXPECT_TRUE(clients[i]->event("event")) << "those that came first are served";
  clients.clear();
  unsigned status = 0;
  while (status != 200) status = Client(web.port()).get("/api/v1/words").status;  // once their ends are seen
}

TEST(AxisgateWebBounds, RefuseAnswersWhileOthersTakeNone) {
  Web web("\"memory_limit_mb\": 64");
  web.tell_of_the_gateway(200);
  constexpr int kSmall = 4096;
  std::vector<std::unique_ptr<Client>> deaf;
  Client good(web.port());
  Answered answered;
  while (answered.status != 503) {
    deaf.push_back(std::make_unique<Client>(web.port(), kSmall));
    ASSERT_TRUE(deaf.back()->send(get_of("/api/v1/map?format=csv")));
    answered = good.get("/api/v1/words");
    ASSERT_LT(deaf.size(), 90U);
  }
  EXPECT_THAT(answered.header, HasSubstr("\r\nRetry-After: 5\r\n"));
  deaf.clear();
  while (answered.status != 200) answered = good.get("/api/v1/gateway");
  EXPECT_GE(json::parse(answered.body)["web"]["refused"]["memory"].get<int>(), 1);
}

TEST(AxisgateWebBounds, AnswerScrapesOfAllAxesThatThereCanBeWithLittleMemory) {
  Web web("\"memory_limit_mb\": 48, \"history_mb\": 4");
  web.tell_of_the_gateway(kMaxAxisNumber);
  SamplesRecord record;
  record.at = now();
  for (std::uint16_t number = 1; number <= kMaxAxisNumber; ++number) {
    AxisSample sample;
    sample.axis = number;
    sample.lease_ms = sample.result_age_ms = UINT32_MAX;
    record.axes.push_back(sample);
  }
  web.tell(record);
  Client client(web.port());
  const std::string last = "axisgate_axis_age_seconds{axis=\"499\"}";
  Answered answered;
  // What is told may be read a moment later than what is asked.
  for (int scrapes = 0; scrapes < 20 || answered.status != 200 || answered.body.find(last) == std::string::npos;
       ++scrapes) {
    answered = client.get("/metrics");
    ASSERT_TRUE(answered.status == 200 || answered.status == 429) << scrapes;  // it asks as fast as it can
  }
  EXPECT_GT(answered.body.size(), 500'000U);
}

/// Samples of one value that is always another one, some thousand in a packet.
void tell_many(Web& web, int values, SteadyNs at, int& number) {
  constexpr int kSamplesOfAxis = 32, kSamplesOfPacket = 3200;
  constexpr std::uint32_t kBetween = 10;
  SamplesRecord record;
  record.at = at;
  for (int i = 0; i < kSamplesOfPacket; ++i) {
    if (i % kSamplesOfAxis == 0) {
      AxisSample& sample = record.axes.emplace_back();
      sample.axis = 1;
      sample.supported = sample.valid = UINT32_MAX;
    }
    const auto name = static_cast<std::uint8_t>(i < values ? i : 0);
    record.axes.back().values.push_back(
        {name, -2'000'000'000 + ++number, static_cast<std::uint32_t>(kSamplesOfPacket - i) * kBetween});
  }
  web.tell(record);
}

TEST(AxisgateWebBounds, BreakATableOffThatIsLongerThan64Mib) {
  Web web;
  web.tell_of_the_gateway();
  std::string series;
  constexpr int kSeries = 16;
  for (const char* const name :
       {"statusword", "mode", "position_rev", "velocity_rpm", "torque_percent", "current_a", "following_error_rev",
        "error_code", "vendor_error", "inputs", "outputs", "drive_temperature_c", "motor_temperature_c", "dc_voltage_v",
        "controlword", "mode_asked"})
    series += (series.empty() ? "1." : ",1.") + std::string(name);
  constexpr std::size_t kMost = std::size_t{64} << 20;
  Client client(web.port());
  Client::Whole whole;
  int number = 0;
  SteadyNs at = now() - 100 * kSecond;
  // Each row has some 200 bytes.
  while (whole.body.size() < kMost - 64 * 1024) {
    for (int i = 0; i < 110; ++i) tell_many(web, kSeries, at += 40 * kMillisecond, number);
    client.send(get_of("/api/v1/history.csv?from=-3600&series=" + series));
    ASSERT_EQ(client.answer().status, 200U);
    whole = client.chunks();
    ASSERT_EQ(whole.complete, whole.body.size() < kMost - 64 * 1024);
  }
  EXPECT_LE(whole.body.size(), kMost);
  EXPECT_TRUE(client.closed());
}

TEST(AxisgateWebBounds, EndAPageThatNeverReadsAndKeepOthersServed) {
  Web web;
  web.tell_of_the_gateway();
  constexpr int kSmall = 4096;
  Client deaf(web.port(), kSmall), good(web.port());
  deaf.send(get_of("/api/v1/stream?period_ms=50"));
  good.send(get_of("/api/v1/stream?period_ms=50"));
  ASSERT_TRUE(good.event("hello"));
  // Events are never merged: they fill what the system takes for the one that does not read.
  Client asks(web.port());
  std::uint64_t number = 0, ended = 0;
  while (ended == 0) {
    EventRecord event;
    event.text = std::string(500, 'x');
    event.number = ++number;
    event.at = now();
    web.tell(event);
    const auto seen = good.event("event");
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->at("number"), number);
    const Answered answered = asks.get("/api/v1/gateway");
    if (answered.status == 200)
      ended = json::parse(answered.body)["web"]["refused"]["slow_reader"].get<std::uint64_t>();
  }
  EXPECT_EQ(ended, 1U);
}

}  // namespace
}  // namespace axisgate::web::test
