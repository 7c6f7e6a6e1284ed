// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/http/response.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/http/request_reader.hpp"

namespace axisgate::web {
namespace {

constexpr std::string_view kOnEveryAnswer =
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Content-Security-Policy: default-src 'self'; base-uri 'self'; form-action 'self'; frame-ancestors 'self'\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";

std::string_view reason_of(unsigned status) {
  switch (status) {
    case 200:
      return "OK";
    case 304:
      return "Not Modified";
    case 400:
      return "Bad Request";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 414:
      return "URI Too Long";
    case 421:
      return "Misdirected Request";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    default:
      return "Service Unavailable";
  }
}

constexpr unsigned kUnavailable = 503;

/// Behind these nobody knows where the next request begins, or the connection itself is what is refused.
bool ends_connection(Refusal refusal) {
  switch (refusal) {
    case Refusal::host:
    case Refusal::rate:
    case Refusal::streams:
    case Refusal::memory:
    case Refusal::not_found:
    case Refusal::parameter:
    case Refusal::large_answer:
      return false;
    default:
      return true;
  }
}

std::string detail_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::connections:
      return "as many connections are open as max_connections allows";
    case Refusal::memory:
      return "others have not taken their answers yet";
    case Refusal::streams:
      return "as many streams are open as max_streams allows";
    case Refusal::rate:
      return "an address has 50 requests a second, and 100 at once";
    case Refusal::long_request_line:
      return fmt::format("a request line has at most {} bytes", kMaxRequestLine);
    case Refusal::large_header:
      return fmt::format("a header has at most {} fields and {} bytes", kMaxFields, kMaxHeader);
    case Refusal::slow_header:
      return fmt::format("a header is here within {} s", kHeaderWithin / kSecond);
    case Refusal::malformed:
      return "this is no HTTP/1.1 request with one Host field and a path";
    case Refusal::body:
      return "a GET or HEAD has no body";
    case Refusal::method:
      return "there is nothing to change here: GET and HEAD alone";
    case Refusal::host:
      return "the Host field must be the address that is reached, localhost, or one of `hosts` of the configuration";
    case Refusal::not_found:
      return "nothing is called so; /api/v1/openapi.json names what there is";
    case Refusal::large_answer:
      return fmt::format("the answer would have more than {} bytes: ask for less", kMaxJson);
    default:
      return "";
  }
}

std::string status_line(unsigned status, const Now& now) {
  return fmt::format("HTTP/1.1 {} {}\r\nDate: {}\r\n{}", status, reason_of(status), http_date(now), kOnEveryAnswer);
}

}  // namespace

Response json_response(std::string text, unsigned status) {
  return {.status = status, .type = kJson, .owned = std::make_shared<const std::string>(std::move(text))};
}

Response problem(Refusal refusal, std::string_view detail) {
  const unsigned status = status_of(refusal);
  nlohmann::ordered_json body;
  body["type"] = "about:blank";
  body["title"] = reason_of(status);
  body["status"] = status;
  body["detail"] = detail;
  Response out = json_response(body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n", status);
  out.type = "application/problem+json";
  out.close = ends_connection(refusal);
  if (refusal == Refusal::method) out.fields = "Allow: GET, HEAD\r\n";
  if (status == kUnavailable) out.fields = "Retry-After: 5\r\n";
  if (refusal == Refusal::rate) out.fields = "Retry-After: 1\r\n";
  return out;
}

Response problem(Refusal refusal) { return problem(refusal, detail_of(refusal)); }

std::string header_of(const Response& response, bool keep_alive, const Now& now) {
  std::string out = status_line(response.status, now);
  if (response.pieces)
    out +=
        fmt::format("Content-Type: {}\r\n{}", response.type, response.chunked ? "Transfer-Encoding: chunked\r\n" : "");
  else if (!response.type.empty())
    out += fmt::format("Content-Type: {}\r\nContent-Length: {}\r\n", response.type, response.body().size());
  out += fmt::format("Cache-Control: {}\r\n{}", response.cache, response.fields);
  if (response.close || !keep_alive) out += "Connection: close\r\n";
  return out + "\r\n";
}

std::string piece_of(const Response& response, std::string piece) {
  return response.chunked ? fmt::format("{:x}\r\n{}\r\n", piece.size(), piece) : piece;
}

std::string stream_header(const Now& now) {
  return status_line(200, now) +
         "Content-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n";
}

}  // namespace axisgate::web
