// SPDX-License-Identifier: Apache-2.0
// Who is let in and answered: networks, names, numbers at once and a second; and what is counted.
#include "gateway/upstream/web_process/api/reception.hpp"

#include <gmock/gmock.h>

#include "gateway/upstream/web_process/api/refusal_lines.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

const Address kLoopback = *parse_address("127.0.0.1");
const Peer kHere{kLoopback, kLoopback};

TEST(Addresses, OfAMappedOneAndAnIPv4OneAreTheSame) {
  EXPECT_EQ(parse_address("::ffff:10.0.0.1"), parse_address("10.0.0.1"));
  EXPECT_EQ(text(*parse_address("10.0.0.1")), "10.0.0.1");
  EXPECT_EQ(text(*parse_address("fd00::1")), "fd00::1");
  EXPECT_FALSE(parse_address("plant"));
}

TEST(Networks, HoldWhatTheirBitsSay) {
  const auto holds = [](const char* network, const char* address) {
    return parse_network(network)->holds(*parse_address(address));
  };
  EXPECT_TRUE(holds("192.168.1.0/24", "192.168.1.255"));
  EXPECT_FALSE(holds("192.168.1.0/24", "192.168.2.0"));
  EXPECT_TRUE(holds("10.0.0.0/9", "10.127.0.1"));
  EXPECT_FALSE(holds("10.0.0.0/9", "10.128.0.1"));
  EXPECT_TRUE(holds("10.1.2.3", "10.1.2.3"));
  EXPECT_TRUE(holds("fd00::/8", "fdff::1"));
  EXPECT_TRUE(holds("::/0", "10.0.0.1"));
  for (const char* wrong : {"10.0.0.0/33", "fd00::/129", "plant/8", "10.0.0.0/", "10.0.0.0/8x"})
    EXPECT_FALSE(parse_network(wrong)) << wrong;
}

TEST(Names, AreTheAddressReachedLocalhostAndThoseOfTheConfiguration) {
  const Address reached = *parse_address("192.168.1.7");
  for (const char* good :
       {"192.168.1.7", "192.168.1.7:8080", "localhost", "LOCALHOST:80", "plant.example:8080", "Plant.Example"})
    EXPECT_TRUE(names_us(good, reached, {"plant.example"})) << good;
  for (const char* bad : {"evil.example", "192.168.1.8", "plant.example.evil.example", "localhost.evil.example", "",
                          "[::1", "192.168.1.7:80@evil", "localhost:x"})
    EXPECT_FALSE(names_us(bad, reached, {"plant.example"})) << bad;
  EXPECT_TRUE(names_us("[fd00::1]:8080", *parse_address("fd00::1"), {}));
}

TEST(TokenBuckets, GiveAnAddress100AtOnceThen50ASecond) {
  TokenBuckets buckets;
  const auto take = [&](SteadyNs now) {
    int taken = 0;
    while (buckets.takes(kLoopback, now)) ++taken;
    return taken;
  };
  EXPECT_EQ(take(kStarted), 100);
  EXPECT_EQ(take(kStarted + kSecond), 50);
  EXPECT_EQ(take(kStarted + kSecond + TokenBuckets::kRefill - 1), 0);
  EXPECT_EQ(take(kStarted + kSecond + TokenBuckets::kRefill), 1);
  EXPECT_EQ(take(kStarted + 1000 * kSecond), 100);
}

TEST(TokenBuckets, KeepABoundedTable) {
  TokenBuckets buckets;
  Address address = kLoopback;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    address[14] = static_cast<std::uint8_t>(i >> 8);
    address[15] = static_cast<std::uint8_t>(i & 0xFF);
    EXPECT_TRUE(buckets.takes(address, kStarted));
  }
  EXPECT_LE(buckets.addresses(), TokenBuckets::kMostAddresses);
}

TEST(TokenBuckets, CountAnIPv6NetworkAsOne) {
  TokenBuckets buckets;
  int taken = 0;
  while (buckets.takes(*parse_address(taken % 2 == 0 ? "fd00::1" : "fd00::2"), kStarted)) ++taken;
  EXPECT_EQ(taken, 100);
}

TEST(Reception, LetsThisComputerInAloneUnlessOthersAreNamed) {
  Reception alone{Settings{}};
  EXPECT_FALSE(alone.enter(kLoopback));
  EXPECT_THAT(alone.enter(*parse_address("10.0.0.1")), Optional(Refusal::not_allowed));
  Settings settings;
  settings.allow = {*parse_network("10.0.0.0/8")};
  Reception wide(settings);
  EXPECT_FALSE(wide.enter(*parse_address("10.0.0.1")));
  EXPECT_THAT(wide.enter(kLoopback), Optional(Refusal::not_allowed));
}

TEST(Reception, KeepsNoMoreThanMaxConnections) {
  Settings settings;
  settings.max_connections = 2;
  Reception reception(settings);
  EXPECT_FALSE(reception.enter(kLoopback));
  EXPECT_FALSE(reception.enter(kLoopback));
  EXPECT_THAT(reception.enter(kLoopback), Optional(Refusal::connections));
  reception.leave();
  EXPECT_FALSE(reception.enter(kLoopback));
}

TEST(Reception, KeepsNoMoreThanMaxStreams) {
  Told told;
  Settings settings;
  settings.max_streams = 1;
  Reception reception(settings);
  const auto ask = [&] { return reception.answer(get("/api/v1/stream"), kHere, told.stores(), at(0)); };
  EXPECT_TRUE(std::holds_alternative<StreamRequest>(ask().what));
  EXPECT_EQ(status_of(ask()), 503U);
  reception.end_stream();
  EXPECT_TRUE(std::holds_alternative<StreamRequest>(ask().what));
}

TEST(Reception, AnswersAHeadForAStreamWithoutOne) {
  Told told;
  Reception reception{Settings{}};
  Request request = get("/api/v1/stream");
  request.method = Request::Method::head;
  EXPECT_EQ(status_of(reception.answer(request, kHere, told.stores(), at(0))), 200U);
  EXPECT_EQ(reception.served().streams, 0U);
}

TEST(Reception, CountsEveryRefusalByItsReason) {
  Told told;
  Reception reception{Settings{}};
  const auto ask = [&](const Request& request) {
    return status_of(reception.answer(request, kHere, told.stores(), at(0)));
  };
  Request wrong_host = get("/api/v1/gateway");
  wrong_host.host = "evil.example";
  EXPECT_EQ(ask(wrong_host), 421U);
  EXPECT_EQ(ask(get("/nothing")), 404U);
  EXPECT_EQ(ask(get("/api/v1/gateway?x=1")), 400U);
  const Served& served = reception.served();
  EXPECT_EQ(served.requests, 3U);
  for (const Refusal refusal : {Refusal::host, Refusal::not_found, Refusal::parameter})
    EXPECT_EQ(served.refused.of(refusal), 1U) << name_of(refusal);
}

TEST(Reception, AnswersTooManyRequestsWith429) {
  Told told;
  Reception reception{Settings{}};
  unsigned status = 200;
  for (int i = 0; i < 101; ++i)
    status = status_of(reception.answer(get("/api/v1/health"), kHere, told.stores(), at(0)));
  EXPECT_EQ(status, 429U);
}

TEST(RefusalLines, TellOneAMinuteOfAReasonAndCountTheOthers) {
  RefusalLines lines;
  EXPECT_THAT(lines.on(Refusal::not_allowed, kLoopback, kStarted), Optional(HasSubstr("127.0.0.1: closed")));
  EXPECT_FALSE(lines.on(Refusal::not_allowed, kLoopback, kStarted + kSecond));
  EXPECT_TRUE(lines.on(Refusal::rate, kLoopback, kStarted + kSecond));
  EXPECT_THAT(lines.on(Refusal::not_allowed, kLoopback, kStarted + 60 * kSecond), Optional(HasSubstr("and 1 more")));
  EXPECT_FALSE(lines.on(Refusal::parameter, kLoopback, kStarted));
}

}  // namespace
}  // namespace axisgate::web
