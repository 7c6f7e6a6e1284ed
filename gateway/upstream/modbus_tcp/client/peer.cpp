// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/client/peer.hpp"

#include <arpa/inet.h>

#include <algorithm>

namespace axisgate::modbus_tcp {

bool is_mapped(const Address& address) {
  return std::all_of(address.begin(), address.begin() + 10, [](std::uint8_t b) { return b == 0; }) &&
         address[10] == 0xFF && address[11] == 0xFF;
}

std::string text(const Address& address) {
  char written[INET6_ADDRSTRLEN] = {};
  const bool v4 = is_mapped(address);
  const void* from = v4 ? address.data() + kMappedBytes : address.data();
  const char* result = inet_ntop(v4 ? AF_INET : AF_INET6, from, written, sizeof written);
  return result == nullptr ? std::string() : std::string(result);
}

std::string text(const Peer& peer) {
  const std::string host = text(peer.address);
  return (is_mapped(peer.address) ? host : "[" + host + "]") + ":" + std::to_string(peer.port);
}

}  // namespace axisgate::modbus_tcp
