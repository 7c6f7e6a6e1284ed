// SPDX-License-Identifier: Apache-2.0
// Where on the network a participant is, and with whom it speaks there.
// Promises defaults that reach nobody but this machine.
// Never says what is published.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace axisgate::dds {

inline constexpr std::size_t kMaxInterfaces = 16;
inline constexpr std::size_t kMaxPeers = 64;
inline constexpr std::size_t kMaxDiscoveryServers = 16;
/// DDSI-RTPS 9.6.1.1: above this the port numbers do not fit.
inline constexpr std::uint32_t kMaxDomain = 232;

struct ParticipantOptions {
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces{"lo"};  ///< by name or IPv4 address
  bool shared_memory = false;
  bool multicast = false;                        ///< samples go to multicast addresses that readers name
  std::vector<std::string> peers{};              ///< ADDRESS or ADDRESS:PORT; then nothing is multicast
  std::vector<std::string> discovery_servers{};  ///< ADDRESS:PORT
  std::string qos_file{};                        ///< Fast DDS XML profiles; empty: none
};

}  // namespace axisgate::dds
