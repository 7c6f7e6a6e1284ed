// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/http/header_parser.hpp"

#include <boost/beast/http.hpp>

namespace axisgate::web {
namespace {

namespace http = boost::beast::http;

/// "gzip" among the codings, and not with q=0.
bool names_gzip(std::string_view codings) {
  while (!codings.empty()) {
    const std::size_t comma = codings.find(',');
    const std::string_view each = codings.substr(0, comma);
    codings = comma == std::string_view::npos ? std::string_view() : codings.substr(comma + 1);
    const std::size_t at = each.find("gzip");
    if (at == std::string_view::npos) continue;
    const std::size_t weight = each.find("q=", at);
    return weight == std::string_view::npos || each.find_first_of("123456789", weight) != std::string_view::npos;
  }
  return false;
}

Request::Method method_of(http::verb verb) {
  if (verb == http::verb::get) return Request::Method::get;
  return verb == http::verb::head ? Request::Method::head : Request::Method::other;
}

}  // namespace

std::optional<Request> parse_header(std::string_view header) {
  http::request_parser<http::empty_body> parser;
  parser.header_limit(static_cast<std::uint32_t>(header.size() + 1));
  parser.body_limit(boost::none);
  boost::system::error_code error;
  parser.put(boost::asio::const_buffer(header.data(), header.size()), error);
  if ((error && error != http::error::need_more) || !parser.is_header_done()) return std::nullopt;
  const auto& read = parser.get();
  Request out;
  out.method = method_of(read.method());
  out.target = read.target();
  if (!out.target.starts_with('/')) return std::nullopt;
  out.takes_chunks = read.version() == 11;
  out.keep_alive = out.takes_chunks && read.keep_alive();
  out.body = parser.chunked() || read.count(http::field::transfer_encoding) != 0 ||
             (parser.content_length() && *parser.content_length() != 0);
  out.hosts = static_cast<int>(read.count(http::field::host));
  out.host = read[http::field::host];
  out.if_none_match = read[http::field::if_none_match];
  out.last_event_id = read["Last-Event-ID"];
  out.takes_gzip = names_gzip(read[http::field::accept_encoding]);
  return out;
}

}  // namespace axisgate::web
