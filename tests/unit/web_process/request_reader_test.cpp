// SPDX-License-Identifier: Apache-2.0
// Requests out of bytes: each bound with the answer that belongs to it, and just below it a request.
#include "gateway/upstream/web_process/http/request_reader.hpp"

#include <gmock/gmock.h>

#include "gateway/upstream/web_process/http/response.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using ::testing::HasSubstr;

/// A GET of this target with so many fields X-N beside Host.
std::string request_of(const std::string& target, std::size_t further = 0) {
  std::string out = "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n";
  for (std::size_t i = 0; i < further; ++i) out += "X-" + std::to_string(i) + ": 1\r\n";
  return out + "\r\n";
}

/// The first of what these bytes are: a target, or the name of a refusal; "": more is needed.
std::string read(const std::string& bytes, std::size_t at_once = std::string::npos) {
  RequestReader reader(0);
  for (std::size_t i = 0; i < bytes.size(); i += std::min(at_once, bytes.size())) {
    reader.received(std::string_view(bytes).substr(i, at_once), 0);
    if (const auto got = reader.next()) {
      const auto* refusal = std::get_if<Refusal>(&*got);
      return refusal != nullptr ? std::string(name_of(*refusal)) : std::get<Request>(*got).target;
    }
  }
  return "";
}

std::string target_of_line(std::size_t line) {
  return "/" + std::string(line - std::string("GET / HTTP/1.1").size(), 'a');
}

TEST(RequestReader, ReadsAGetWhateverTheCut) {
  for (const std::size_t cut : {1U, 2U, 7U, 1000U}) EXPECT_EQ(read(request_of("/a?b=1"), cut), "/a?b=1");
}

TEST(RequestReader, ReadsTheFieldsThatCount) {
  RequestReader reader(0);
  reader.received(
      "HEAD / HTTP/1.1\r\nHost: plant:80\r\nIf-None-Match: \"x\"\r\nAccept-Encoding: br, gzip;q=0.5\r\n"
      "Last-Event-ID: 4.2\r\nConnection: close\r\n\r\n",
      0);
  const Request request = std::get<Request>(*reader.next());
  EXPECT_EQ(request.method, Request::Method::head);
  EXPECT_EQ(request.host, "plant:80");
  EXPECT_EQ(request.if_none_match, "\"x\"");
  EXPECT_EQ(request.last_event_id, "4.2");
  EXPECT_TRUE(request.takes_gzip);
  EXPECT_FALSE(request.keep_alive);
}

TEST(RequestReader, TakesNoGzipWhereItsWeightIsNothing) {
  RequestReader reader(0);
  reader.received("GET / HTTP/1.1\r\nHost: a\r\nAccept-Encoding: gzip;q=0, br\r\n\r\n", 0);
  EXPECT_FALSE(std::get<Request>(*reader.next()).takes_gzip);
}

TEST(RequestReader, ReadsOneRequestBehindAnother) {
  RequestReader reader(0);
  reader.received(request_of("/1") + request_of("/2"), 0);
  EXPECT_EQ(std::get<Request>(*reader.next()).target, "/1");
  EXPECT_EQ(std::get<Request>(*reader.next()).target, "/2");
  EXPECT_FALSE(reader.next());
}

TEST(RequestReader, EndsARequestLineAt2048Bytes) {
  EXPECT_EQ(read(request_of(target_of_line(2048))), target_of_line(2048));
  EXPECT_EQ(read(request_of(target_of_line(2049))), "long_request_line");
  EXPECT_EQ(read("GET /" + std::string(3000, 'a'), 1), "long_request_line");
}

TEST(RequestReader, EndsAHeaderAt64Fields) {
  EXPECT_EQ(read(request_of("/", 63)), "/");
  EXPECT_EQ(read(request_of("/", 64)), "large_header");
}

TEST(RequestReader, EndsAHeaderAt8KiB) {
  const std::string begin = "GET / HTTP/1.1\r\nHost: a\r\nX: ", end = "\r\n\r\n";
  const auto of_size = [&](std::size_t size) {
    return begin + std::string(size - begin.size() - end.size(), 'x') + end;
  };
  EXPECT_EQ(read(of_size(8192)), "/");
  EXPECT_EQ(read(of_size(8193)), "large_header");
  EXPECT_EQ(read(begin + std::string(9000, 'x'), 100), "large_header");
}

TEST(RequestReader, HoldsNoMoreThanAHeader) {
  RequestReader reader(0);
  EXPECT_EQ(reader.room(), kMaxHeader + 1);
  reader.received(std::string(kMaxHeader + 1, 'x'), 0);
  EXPECT_EQ(reader.room(), 0U);
}

TEST(RequestReader, RefusesOtherMethods) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", "BREW"})
    EXPECT_EQ(read(std::string(method) + " / HTTP/1.1\r\nHost: a\r\nContent-Length: 3\r\n\r\nabc"), "method") << method;
}

TEST(RequestReader, RefusesAGetWithABody) {
  EXPECT_EQ(read("GET / HTTP/1.1\r\nHost: a\r\nContent-Length: 3\r\n\r\nabc"), "body");
  EXPECT_EQ(read("GET / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"), "body");
  EXPECT_EQ(read("GET / HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n"), "/");
}

TEST(RequestReader, RefusesWhatIsNoRequest) {
  for (const char* bytes :
       {"\x16\x03\x01\x02\r\n\r\n", "GET /\r\n\r\n", "GET / HTTP/2.0\r\nHost: a\r\n\r\n", "GET / HTTP/1.1\n\n",
        "\r\n\r\n", "GET a HTTP/1.1\r\nHost: a\r\n\r\n", "GET / HTTP/1.1\r\nHost : a\r\n\r\n", "GET / HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", "GET / HTTP/1.1\r\nHost: a\r\n\x01: b\r\n\r\n"})
    EXPECT_EQ(read(bytes), "malformed") << bytes;
}

TEST(RequestReader, GivesAHeader5SecondsFromItsFirstByte) {
  RequestReader reader(kStarted);
  EXPECT_EQ(reader.deadline(), kStarted + 15 * kSecond);
  EXPECT_FALSE(reader.late());
  reader.received("G", kStarted + kSecond);
  reader.received("E", kStarted + 4 * kSecond);
  EXPECT_EQ(reader.deadline(), kStarted + 6 * kSecond);
  EXPECT_TRUE(reader.late());
}

TEST(RequestReader, GivesTheNextRequest15SecondsFromTheAnswer) {
  RequestReader reader(kStarted);
  reader.received(request_of("/"), kStarted);
  ASSERT_TRUE(reader.next());
  reader.answered(kStarted + kSecond);
  EXPECT_EQ(reader.deadline(), kStarted + 16 * kSecond);
}

// --- How refusals are answered ---------------------------------------------------------------------------------------

std::string header_of(Refusal refusal) { return header_of(problem(refusal), true, at(0)); }

TEST(Refusals, HaveTheirStatus) {
  EXPECT_THAT(header_of(Refusal::long_request_line), HasSubstr("HTTP/1.1 414 "));
  EXPECT_THAT(header_of(Refusal::large_header), HasSubstr("HTTP/1.1 431 "));
  EXPECT_THAT(header_of(Refusal::slow_header), HasSubstr("HTTP/1.1 408 "));
  EXPECT_THAT(header_of(Refusal::body), HasSubstr("HTTP/1.1 400 "));
  EXPECT_THAT(header_of(Refusal::host), HasSubstr("HTTP/1.1 421 "));
}

TEST(Refusals, SayWhatHelps) {
  EXPECT_THAT(header_of(Refusal::method), HasSubstr("HTTP/1.1 405 Method Not Allowed\r\n"));
  EXPECT_THAT(header_of(Refusal::method), HasSubstr("\r\nAllow: GET, HEAD\r\n"));
  for (const Refusal refusal : {Refusal::connections, Refusal::streams, Refusal::memory})
    EXPECT_THAT(header_of(refusal), HasSubstr("\r\nRetry-After: 5\r\n"));
  EXPECT_THAT(header_of(Refusal::rate), HasSubstr("HTTP/1.1 429 "));
  EXPECT_THAT(header_of(Refusal::rate), HasSubstr("\r\nRetry-After: 1\r\n"));
}

TEST(Refusals, EndTheConnectionWhereItsBytesCannotBeTrusted) {
  for (const Refusal refusal : {Refusal::long_request_line, Refusal::large_header, Refusal::slow_header,
                                Refusal::malformed, Refusal::body, Refusal::method, Refusal::connections})
    EXPECT_THAT(header_of(refusal), HasSubstr("\r\nConnection: close\r\n")) << name_of(refusal);
}

TEST(Refusals, AreProblemsInJson) {
  const Response response = problem(Refusal::parameter, "limit: \"x\" is none");
  EXPECT_EQ(response.type, "application/problem+json");
  EXPECT_EQ(Json::parse(response.body()), Json::parse(R"({"type":"about:blank","title":"Bad Request","status":400,
    "detail":"limit: \"x\" is none"})"));
}

TEST(Answers, CarryTheFieldsOfSafetyErrorsToo) {
  for (const std::string& header :
       {header_of(Refusal::not_found), header_of(json_response("{}"), true, at(0)), stream_header(at(0))}) {
    EXPECT_THAT(header, HasSubstr("\r\nX-Content-Type-Options: nosniff\r\n"));
    EXPECT_THAT(header, HasSubstr("\r\nReferrer-Policy: no-referrer\r\n"));
    EXPECT_THAT(header, HasSubstr("\r\nContent-Security-Policy: default-src 'self';"));
    EXPECT_THAT(header, HasSubstr("\r\nDate: Sat, 28 Nov 2026 20:40:00 GMT\r\n"));
    EXPECT_THAT(header, testing::Not(HasSubstr("Access-Control")));
  }
}

}  // namespace
}  // namespace axisgate::web
