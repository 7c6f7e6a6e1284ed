// SPDX-License-Identifier: Apache-2.0
// What a browser, or whoever, sends to axisgate-web: requests out of a stream of bytes, and what each is answered.
#include <nlohmann/json.hpp>

#include "gateway/upstream/web_process/api/reception.hpp"
#include "gateway/upstream/web_process/http/request_reader.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"

namespace axisgate::fuzz {
namespace {

using web::Refusal;
using web::Request;

/// What is read of one connection: targets, and the refusal that ends it.
struct WebRead {
  std::vector<std::string> targets;
  std::optional<Refusal> refusal;
  friend bool operator==(const WebRead&, const WebRead&) = default;
};

WebRead read_requests(std::string_view bytes, std::size_t at_once) {
  web::RequestReader reader(0);
  WebRead out;
  while (!out.refusal) {
    const auto read = reader.next();
    if (!read) {
      if (bytes.empty()) return out;
      const std::size_t size = std::min({at_once, bytes.size(), reader.room()});
      must(size > 0, "a reader that has neither a request nor a refusal has room");
      reader.received(bytes.substr(0, size), 0);
      bytes.remove_prefix(size);
    } else if (const auto* refusal = std::get_if<Refusal>(&*read)) {
      out.refusal = *refusal;
    } else {
      const auto& request = std::get<Request>(*read);
      must(request.target.size() <= web::kMaxRequestLine, "a target fits a request line");
      must(request.method != Request::Method::other && !request.body && request.hosts == 1,
           "what is read is a GET or HEAD");
      out.targets.push_back(request.target);
    }
  }
  return out;
}

const web::Stores& stores() {
  static const web::Stores kStores = [] {
    constexpr std::size_t kHistoryBytes = std::size_t{1} << 20;
    web::Stores out(kHistoryBytes);
    web::HelloRecord hello;
    hello.axes = hello.buses = 1;
    web::AxisInfoRecord axis;
    axis.axis = 1;
    for (const web::Record& record : {web::Record(hello), web::Record(axis), web::Record(web::BusInfoRecord{})})
      must(out.take(record, {1, 0}), "a record of the gateway is taken");
    return out;
  }();
  return kStores;
}

void must_be_an_answer(const std::string& target) {
  Request request;
  request.target = target;
  const web::Answer answer = web::answer(request, stores(), web::Served{}, {1, 0});
  if (const auto* stream = std::get_if<web::StreamRequest>(&answer.what)) {
    must(stream->period_ms >= web::kLeastPeriodMs && stream->period_ms <= web::kMostPeriodMs,
         "a period has its bounds");
    return;
  }
  const auto& response = std::get<web::Response>(answer.what);
  must(answer.refused.has_value() == (response.status >= 400 && response.status != 503), "a refusal says so");
  const std::string header = header_of(response, true, {1, 0});
  must(header.find('\n') != std::string::npos && header.ends_with("\r\n\r\n"), "a header ends");
  must(header.find("nosniff") != std::string::npos, "safety is on every answer");
  if (answer.refused) must(nlohmann::json::accept(response.body()), "a problem is JSON, whatever was asked");
  std::uint64_t taken = 0;
  while (response.pieces) {
    const std::string piece = response.pieces();
    if (piece.empty()) break;
    must((taken += piece.size()) <= web::kMaxPieces, "an answer in pieces ends");
  }
}

void web_requests(Bytes content) {
  const std::string bytes(content.begin(), content.end());
  const WebRead whole = read_requests(bytes, bytes.size());
  must(whole == read_requests(bytes, 1), "requests do not depend on how the stream is cut");
  for (const std::string& target : whole.targets) must_be_an_answer(target);
  // Of a stream that is no request at all, its bytes as a target.
  if (whole.targets.empty()) must_be_an_answer("/" + bytes.substr(0, web::kMaxRequestLine));
}

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_web_requests(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::web_requests({data, size});
  return 0;
}
