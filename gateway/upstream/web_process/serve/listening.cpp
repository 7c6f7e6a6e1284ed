// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/serve/listening.hpp"

#include <fmt/format.h>
#include <netinet/in.h>

#include <algorithm>
#include <boost/asio/ip/v6_only.hpp>
#include <charconv>
#include <limits>

#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"

namespace axisgate::web {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using program::StartError;

/// What the system keeps of a page that does not read; twice of it, by its own count.
constexpr int kSendBuffer = 64 * 1024;
/// What the system keeps of those who are not accepted yet; it may have a smaller bound of its own.
constexpr int kWaiting = 4096;

tcp::endpoint endpoint_of(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  std::string host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  unsigned port = 0;
  const char* const last = text.data() + text.size();
  const char* const first = colon == std::string::npos ? last : text.data() + colon + 1;
  const auto [end, error] = std::from_chars(first, last, port);
  boost::system::error_code no_address;
  const auto address = asio::ip::make_address(host, no_address);
  if (no_address || error != std::errc() || end != last || port > std::numeric_limits<std::uint16_t>::max())
    throw StartError(link::kExitUsage, fmt::format("listen: '{}' is no address: write 127.0.0.1:8080", text));
  return {address, static_cast<std::uint16_t>(port)};
}

/// Of an address that comes late too: what is sent to it is ours as soon as it is there.
void bind_early(tcp::acceptor& acceptor, const tcp::endpoint& endpoint, boost::system::error_code& error) {
  using FreeBind4 = asio::detail::socket_option::boolean<IPPROTO_IP, IP_FREEBIND>;
  acceptor.set_option(FreeBind4(true), error);
  if (!error) acceptor.bind(endpoint, error);
}

Listening open(asio::io_context& io, const std::string& text) {
  const tcp::endpoint endpoint = endpoint_of(text);
  Listening out{tcp::acceptor(io), text, true};
  tcp::acceptor& acceptor = out.acceptor;
  acceptor.open(endpoint.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  if (endpoint.address().is_v6()) acceptor.set_option(asio::ip::v6_only(true));
  acceptor.set_option(asio::socket_base::send_buffer_size(kSendBuffer));
  boost::system::error_code error;
  acceptor.bind(endpoint, error);
  if (error == boost::system::errc::address_not_available) {
    out.is_there = false;
    bind_early(acceptor, endpoint, error);
  }
  if (!error) acceptor.listen(kWaiting, error);
  if (error)
    throw StartError(link::kExitCannotServe, fmt::format("the page cannot be served at {}: {}", text, error.message()));
  acceptor.non_blocking(true);
  const tcp::endpoint bound = acceptor.local_endpoint();
  const std::string host = bound.address().to_string();
  out.address = fmt::format("{}:{}", bound.address().is_v6() ? "[" + host + "]" : host, bound.port());
  return out;
}

}  // namespace

Address address_of(const asio::ip::address& address) {
  if (address.is_v6()) return address.to_v6().to_bytes();
  return asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4()).to_bytes();
}

std::vector<Listening> open_listening(asio::io_context& io, const std::vector<std::string>& listen) {
  std::vector<Listening> out;
  for (const std::string& each : listen) out.push_back(open(io, each));
  if (std::ranges::none_of(out, &Listening::is_there))
    throw StartError(
        link::kExitNoAddress,
        fmt::format("the page cannot be served at {}: this computer does not have the address yet", listen.front()));
  return out;
}

}  // namespace axisgate::web
