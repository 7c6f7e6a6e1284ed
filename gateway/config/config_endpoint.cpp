// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_endpoint.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>

namespace axisgate::config {
namespace {

constexpr std::uint8_t kMappedPrefix = 96;  // ::ffff:0:0/96 holds IPv4

std::optional<unsigned> parse_number(std::string_view text, unsigned largest) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value > largest) return std::nullopt;
  return value;
}

struct ParsedAddress {
  modbus_tcp::Address bytes{};
  bool v4 = false;
};

std::optional<ParsedAddress> parse_address(std::string_view text) {
  const std::string copy(text);
  ParsedAddress parsed;
  if (inet_pton(AF_INET6, copy.c_str(), parsed.bytes.data()) == 1) return parsed;
  parsed.v4 = true;
  parsed.bytes = {};
  parsed.bytes[10] = parsed.bytes[11] = 0xFF;
  if (inet_pton(AF_INET, copy.c_str(), parsed.bytes.data() + 12) == 1) return parsed;
  return std::nullopt;
}

bool bits_clear_after(const modbus_tcp::Address& address, std::uint8_t prefix) {
  for (unsigned i = prefix; i < 128; ++i) {
    if ((address[i / 8] & (0x80U >> (i % 8))) != 0) return false;
  }
  return true;
}

}  // namespace

std::optional<Endpoint> parse_endpoint(std::string_view text) {
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  const auto port = parse_number(text.substr(colon + 1), 65535);
  if (!port || *port == 0) return std::nullopt;

  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  const auto address = parse_address(host);
  // "::1:1502" could be either an address or an address and a port: IPv6 needs its brackets.
  if (!address || address->v4 == bracketed) return std::nullopt;
  return Endpoint{std::string(host), static_cast<std::uint16_t>(*port)};
}

bool is_any_address(std::string_view host) {
  const auto parsed = parse_address(host);
  if (!parsed) return false;
  const auto first = parsed->bytes.begin() + (parsed->v4 ? 12 : 0);
  return std::all_of(first, parsed->bytes.end(), [](std::uint8_t byte) { return byte == 0; });
}

bool is_loopback(std::string_view host) {
  const auto parsed = parse_address(host);
  if (!parsed) return false;
  if (parsed->v4) return parsed->bytes[12] == 127;
  return parsed->bytes == modbus_tcp::Address{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
}

bool is_group_address(std::string_view host) {
  const auto parsed = parse_address(host);
  if (!parsed) return false;
  constexpr std::uint8_t kMulticast4 = 0xE0, kEverybody4 = 0xFF, kMulticast6 = 0xFF;
  if (!parsed->v4) return parsed->bytes[0] == kMulticast6;
  const bool everybody = std::all_of(parsed->bytes.begin() + 12, parsed->bytes.end(),
                                     [](std::uint8_t byte) { return byte == kEverybody4; });
  return everybody || (parsed->bytes[12] & 0xF0U) == kMulticast4;
}

std::optional<Network> parse_network(std::string_view text) {
  const auto slash = text.find('/');
  const auto address = parse_address(text.substr(0, slash));
  if (!address) return std::nullopt;
  Network network{address->bytes, 128, true};
  if (slash != std::string_view::npos) {
    const auto prefix = parse_number(text.substr(slash + 1), address->v4 ? 32 : 128);
    if (!prefix) return std::nullopt;
    network.prefix = static_cast<std::uint8_t>(*prefix + (address->v4 ? kMappedPrefix : 0));
  }
  network.host_bits_clear = bits_clear_after(network.address, network.prefix);
  return network;
}

}  // namespace axisgate::config
