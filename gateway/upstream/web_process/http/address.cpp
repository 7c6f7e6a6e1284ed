// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/http/address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace axisgate::web {
namespace {

constexpr std::size_t kMappedBytes = 12;
constexpr unsigned kMappedBits = 96, kAllBits = 128;
constexpr std::array<std::uint8_t, kMappedBytes> kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};

bool is_mapped(const Address& address) { return std::equal(kMapped.begin(), kMapped.end(), address.begin()); }

bool same_letters(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::ranges::equal(a, b, [&](char x, char y) { return lower(x) == lower(y); });
}

/// Without the port; empty: it is no host.
std::string_view host_of(std::string_view field) {
  const bool bracket = field.starts_with('[');
  const std::size_t end = bracket ? field.find(']') : std::min(field.find(':'), field.size());
  if (end == std::string_view::npos) return {};
  const std::string_view rest = field.substr(bracket ? end + 1 : end);
  const std::string_view port = rest.substr(std::min<std::size_t>(1, rest.size()));
  const bool good_rest =
      rest.empty() || (rest.front() == ':' && std::ranges::all_of(port, [](char c) { return c >= '0' && c <= '9'; }));
  return good_rest ? field.substr(bracket ? 1 : 0, bracket ? end - 1 : end) : std::string_view();
}

}  // namespace

std::optional<Address> parse_address(std::string_view text) {
  const std::string copy(text);
  Address out{};
  if (inet_pton(AF_INET6, copy.c_str(), out.data()) == 1) return out;
  std::array<std::uint8_t, 4> v4{};
  if (inet_pton(AF_INET, copy.c_str(), v4.data()) != 1) return std::nullopt;
  std::ranges::copy(kMapped, out.begin());
  std::ranges::copy(v4, out.begin() + kMappedBytes);
  return out;
}

std::string text(const Address& address) {
  std::array<char, INET6_ADDRSTRLEN> out{};
  const bool v4 = is_mapped(address);
  inet_ntop(v4 ? AF_INET : AF_INET6, address.data() + (v4 ? kMappedBytes : 0), out.data(), out.size());
  return out.data();
}

bool is_loopback(const Address& address) {
  constexpr std::uint8_t kLoopback = 127;
  if (is_mapped(address)) return address[kMappedBytes] == kLoopback;
  return std::all_of(address.begin(), address.end() - 1, [](std::uint8_t b) { return b == 0; }) && address.back() == 1;
}

Address counted_as(const Address& address) {
  constexpr std::size_t kNetwork = 8;
  Address out = address;
  if (!is_mapped(address)) std::fill(out.begin() + kNetwork, out.end(), std::uint8_t{0});
  return out;
}

bool Network::holds(const Address& other) const {
  constexpr unsigned kByte = 8;
  const std::size_t whole = bits / kByte;
  if (!std::equal(address.begin(), address.begin() + static_cast<std::ptrdiff_t>(whole), other.begin())) return false;
  const unsigned rest = bits % kByte;
  return rest == 0 || ((static_cast<unsigned>(address[whole]) ^ other[whole]) >> (kByte - rest)) == 0;
}

std::optional<Network> parse_network(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto address = parse_address(text.substr(0, slash));
  if (!address) return std::nullopt;
  if (slash == std::string_view::npos) return Network{*address, kAllBits};
  const bool v4 = text.find(':') == std::string_view::npos;
  const std::string_view number = text.substr(slash + 1);
  unsigned bits = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), bits);
  if (error != std::errc() || end != number.data() + number.size()) return std::nullopt;
  if (bits > (v4 ? kAllBits - kMappedBits : kAllBits)) return std::nullopt;
  return Network{*address, bits + (v4 ? kMappedBits : 0)};
}

bool names_us(std::string_view field, const Address& reached, const std::vector<std::string>& hosts) {
  const std::string_view host = host_of(field);
  if (host.empty()) return false;
  if (same_letters(host, "localhost")) return true;
  if (const auto address = parse_address(host); address && *address == reached) return true;
  return std::ranges::any_of(
      hosts, [&](const std::string& each) { return same_letters(each, host) || same_letters(each, field); });
}

}  // namespace axisgate::web
