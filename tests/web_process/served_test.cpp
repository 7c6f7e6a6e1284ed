// SPDX-License-Identifier: Apache-2.0
// What a person at a browser gets of the program, whatever becomes of the gateway or of the program itself.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "gateway/upstream/link/exit_codes.hpp"
#include "tests/web_process/client.hpp"
#include "tests/web_process/web.hpp"

namespace axisgate::web::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(AxisgateWeb, ShowsWhatTheGatewayTells) {
  Web web;
  web.tell_of_the_gateway();
  web.tell_position(1.5);
  Client client(web.port());
  // What is told may be read a moment later than what is asked: the connection is kept meanwhile.
  json axes;
  do {
    axes = json::parse(client.get("/api/v1/axes").body)["axes"];
  } while (axes.empty() || axes[0]["values"]["position_rev"].is_null());
  EXPECT_EQ(axes[0]["values"]["position_rev"], 1.5);
  EXPECT_EQ(axes[0]["name"], "hoist");
}

TEST(AxisgateWeb, StreamsWhatChanges) {
  Web web;
  web.tell_of_the_gateway();
  Client client(web.port());
  client.send(get_of("/api/v1/stream?period_ms=50"));
  EXPECT_EQ(client.answer().status, 200U);
  EXPECT_EQ(client.event("hello")->at("boot"), "42");
  web.tell_position(2.5);
  json position;
  while (position.is_null()) {
    const auto axes = client.event("axes");
    ASSERT_TRUE(axes);
    for (const json& axis : axes->at("axes"))
      if (axis.contains("values") && axis["values"].contains("position_rev")) position = axis["values"]["position_rev"];
  }
  EXPECT_EQ(position, 2.5);
}

TEST(AxisgateWeb, BringsLinesToFiftyPages) {
  Web web;
  web.tell_of_the_gateway();
  std::vector<std::unique_ptr<Client>> pages;
  for (int i = 0; i < 50; ++i) {
    pages.push_back(std::make_unique<Client>(web.port()));
    pages.back()->send(get_of("/api/v1/stream?period_ms=50&series=1.position_rev,1.axis_state"));
    ASSERT_TRUE(pages.back()->event("hello"));
  }
  for (int i = 1; i <= 20; ++i) web.tell_position(i);
  for (const auto& page : pages) {
    std::vector<double> turns;
    while (turns.size() < 20) {
      const auto scope = page->event("scope");
      ASSERT_TRUE(scope);
      const json samples = scope->at("series").value("1.position_rev", json::array());
      for (const json& each : samples)
        if (!each[1].is_null()) turns.push_back(each[1].get<double>());
    }
    for (int i = 1; i <= 20; ++i) EXPECT_EQ(turns.at(static_cast<std::size_t>(i - 1)), i);
  }
}

TEST(AxisgateWeb, SendsALongTableInPiecesOfOneConnection) {
  Web web;
  web.tell_of_the_gateway();
  constexpr int kSamples = 5000;
  for (int i = 1; i <= kSamples; ++i) web.tell_position(i);
  Client client(web.port(), 4096);
  const std::string table = "/api/v1/history.csv?series=1.position_rev";
  const std::string newest = "," + std::to_string(kSamples) + ",\r\n";
  Client::Whole whole;
  do {
    const Answered header = client.get(table);
    ASSERT_EQ(header.status, 200U);
    EXPECT_THAT(header.header, HasSubstr("Transfer-Encoding: chunked\r\n"));
    whole = client.chunks();
    EXPECT_TRUE(whole.complete);
  } while (whole.body.find(newest) == std::string::npos);
  EXPECT_GE(std::ranges::count(whole.body, '\n'), kSamples);
  EXPECT_EQ(client.get("/api/v1/words").status, 200U) << "the connection goes on behind it";

  Client old(web.port());
  old.send("GET " + table + " HTTP/1.0\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(old.answer().header.find("Transfer-Encoding"), std::string::npos) << "HTTP/1.0 knows no chunks";
  EXPECT_THAT(old.rest(), testing::StartsWith("time,1.position_rev,event\r\n"));
  client.send("HEAD " + table + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(client.answer().status, 200U);
  EXPECT_EQ(client.get("/api/v1/words").status, 200U) << "a HEAD has no body";
}

TEST(AxisgateWeb, SaysThatTheGatewayIsNotSeenWhenItStands) {
  Web web;
  web.tell_of_the_gateway();
  Client client(web.port());
  client.send(get_of("/api/v1/stream"));
  ASSERT_TRUE(client.event("hello"));
  // The gateway says nothing from here on.
  bool joined = true;
  while (joined) {
    const auto axes = client.event("axes");
    ASSERT_TRUE(axes);
    joined = axes->at("joined").get<bool>();
  }
  EXPECT_EQ(Client(web.port()).get("/api/v1/health").status, 503U);
}

TEST(AxisgateWeb, SaysByeAndFreesItsPortWhenTheGatewayDies) {
  std::uint16_t port = 0;
  {
    Web web;
    port = web.port();
    web.tell_of_the_gateway();
    Client client(port);
    client.send(get_of("/api/v1/stream"));
    ASSERT_TRUE(client.event("hello"));
    web.close_link();
    EXPECT_EQ(client.event("bye")->at("why"), "the gateway has ended");
    EXPECT_TRUE(client.closed());
    EXPECT_EQ(web.exit_code(), link::kExitGatewayGone);
  }
  Web next("", "127.0.0.1:" + std::to_string(port));
  EXPECT_EQ(next.port(), port);
}

TEST(AxisgateWeb, SaysByeWhenItIsAskedToEnd) {
  Web web;
  web.tell_of_the_gateway();
  Client client(web.port());
  client.send(get_of("/api/v1/stream"));
  ASSERT_TRUE(client.event("hello"));
  kill(web.pid(), SIGTERM);
  EXPECT_TRUE(client.event("bye"));
  EXPECT_EQ(web.exit_code(), 0);
}

TEST(AxisgateWeb, FreesItsPortWhenItIsKilled) {
  Web web;
  const std::uint16_t port = web.port();
  Client client(port);
  ASSERT_EQ(client.get("/api/v1/health").status, 503U);
  kill(web.pid(), SIGKILL);
  EXPECT_TRUE(client.closed());
  EXPECT_EQ(web.exit_code(), -SIGKILL);
  Web next("", "127.0.0.1:" + std::to_string(port));
  EXPECT_EQ(Client(port).get("/api/v1/health").status, 503U);
}

TEST(AxisgateWeb, TakesUpWhatWasToldWhileItStood) {
  Web web;
  web.tell_of_the_gateway();
  Client client(web.port());
  ASSERT_NE(client.get("/api/v1/gateway").status, 0U);
  kill(web.pid(), SIGSTOP);
  for (int i = 1; i <= 10; ++i) web.tell_position(i);
  kill(web.pid(), SIGCONT);
  json position;
  while (position != 10.0) {
    web.tell_position(10);
    position = json::parse(client.get("/api/v1/axes/1").body)["values"]["position_rev"];
  }
}

TEST(AxisgateWeb, IsConfinedBeforeItAnswers) {
  Web web;
  EXPECT_EQ(web.status("NoNewPrivs"), "1");
  const std::string filter = web.status("Seccomp");
  EXPECT_EQ(filter, filter.empty() ? "" : "2") << "a kernel without seccomp does not speak of it";
  EXPECT_EQ(web.confined(), !filter.empty());
  web.tell_of_the_gateway();
  Client client(web.port());
  EXPECT_EQ(json::parse(client.get("/api/v1/gateway").body)["confined"], web.confined());
}

TEST(AxisgateWeb, EndsWhereTheGatewayIsOfAnotherVersion) {
  Web web;
  web.send_bytes({0xFF, 0x00});
  const auto line = web.next_line();
  ASSERT_TRUE(line);
  EXPECT_THAT(line->text, HasSubstr("not of one installation"));
  EXPECT_EQ(web.exit_code(), link::kExitProtocol);
}

TEST(AxisgateWeb, TellsWhyItCannotServe) {
  Web first;
  EXPECT_THROW(Web("", "127.0.0.1:" + std::to_string(first.port())), std::runtime_error);
}

TEST(AxisgateWeb, EndsForAnAddressThatComesLateAlone) {
  EXPECT_THROW(Web("", "192.0.2.1:0"), std::runtime_error) << "this computer does not have it";
  Web web("\"insecure\": true", "192.0.2.1:0\", \"127.0.0.1:0");
  EXPECT_EQ(Client(web.port()).get("/api/v1/health").status, 503U) << "what can be served is";
}

TEST(AxisgateWeb, AnswersAFileOnceToABrowserThatHasIt) {
  Web web;
  Client client(web.port());
  const Answered first = client.get("/");
  if (first.status == 404U) return;  // it was built without pages
  EXPECT_EQ(first.status, 200U);
  const std::size_t tag = first.header.find("ETag: ") + 6;
  const std::string etag = first.header.substr(tag, first.header.find('\r', tag) - tag);
  EXPECT_EQ(client.get("/", "If-None-Match: " + etag + "\r\n").status, 304U);
}

}  // namespace
}  // namespace axisgate::web::test
