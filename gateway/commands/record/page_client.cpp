// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/record/page_client.hpp"

#include <fmt/format.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>

#include "gateway/commands/record/plan/request.hpp"

namespace axisgate::commands::record {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

constexpr auto kAwait = boost::asio::as_tuple(boost::asio::use_awaitable);
constexpr unsigned kVersion = 11;

/// Of an error in a connection that was there.
std::string reason(const error_code& error, std::chrono::milliseconds patience) {
  if (error == http::error::end_of_stream || error == boost::asio::error::connection_reset)
    return "the connection was closed without an answer: `allow` of the page does not name this computer, or its "
           "gateway has just ended";
  if (error == beast::error::timeout)
    return fmt::format("no answer within {:g} s", static_cast<double>(patience.count()) / 1e3);
  if (error == http::error::partial_message) return "the answer broke off";
  return error.category() == http::make_error_code(http::error::bad_version).category()
             ? "what answers there speaks no HTTP: " + error.message()
             : error.message();
}

}  // namespace

boost::asio::awaitable<PageAnswer> PageClient::get(std::string target) {
  boost::asio::ip::tcp::resolver resolver(io_);
  const auto [unknown, places] = co_await resolver.async_resolve(place_.host, std::to_string(place_.port), kAwait);
  if (unknown) co_return PageAnswer{.problem = unknown.message()};
  beast::tcp_stream stream(io_);
  stream.expires_after(patience_);
  const auto [refused, place] = co_await stream.async_connect(places, kAwait);
  if (refused) co_return PageAnswer{.problem = refused.message()};
  http::request<http::empty_body> request(http::verb::get, target, kVersion);
  request.set(http::field::host, authority_of(place_));
  request.set(http::field::connection, "close");
  const auto [unsent, sent] = co_await http::async_write(stream, request, kAwait);
  if (unsent) co_return PageAnswer{.problem = reason(unsent, patience_)};
  http::response_parser<http::string_body> answer;
  answer.body_limit(kLongestAnswer);
  beast::flat_buffer buffer;
  const auto [broken, read] = co_await http::async_read(stream, buffer, answer, kAwait);
  if (broken) co_return PageAnswer{.problem = reason(broken, patience_)};
  co_return PageAnswer{.status = answer.get().result_int(), .body = std::move(answer.get().body())};
}

}  // namespace axisgate::commands::record
