// SPDX-License-Identifier: Apache-2.0
// Which gateway of a DDS domain a sample is of, or is for: the name of the configuration and its key (design 4).
// Promises that both programs, and every client, reckon the same key from a name.
// Never compares keys alone where a name is known: two names may have one key.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate::dds {

/// Of the IDL's `gateway`.
inline constexpr std::size_t kMaxGatewayName = 32;

/// CRC-32 (IEEE 802.3) of the name's characters; 0 of none.
[[nodiscard]] std::uint32_t gateway_key(std::string_view name);
/// [a-z][a-z0-9_]*, of kMaxGatewayName at most: it is a ROS 2 namespace as well.
[[nodiscard]] bool is_gateway_name(std::string_view name);

struct GatewayId {
  std::uint32_t key = 0;
  std::string name{};
  friend bool operator==(const GatewayId&, const GatewayId&) = default;
};
[[nodiscard]] inline GatewayId gateway_id(const std::string& name) { return {gateway_key(name), name}; }

}  // namespace axisgate::dds
