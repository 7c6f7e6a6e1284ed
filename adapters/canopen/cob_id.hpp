// SPDX-License-Identifier: Apache-2.0
// The predefined connection set of CiA 301 section 7.3.5: which COB-ID carries what of which node.
// Promises that every id of the set is distinguished, and that the filters let through what the configured nodes send
// by it, of any other node its signs of life and errors, which are few, and nothing else. Never knows an id that was
// moved elsewhere: the profiles leave them where they are.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "adapters/can/can_link.hpp"

namespace axisgate::canopen {

inline constexpr std::uint8_t kFirstNode = 1;
inline constexpr std::uint8_t kLastNode = 127;
/// TPDOs that have an id of their own in the set.
inline constexpr std::uint8_t kTpdos = 4;

inline constexpr std::uint32_t kNmtId = 0x000;
inline constexpr std::uint32_t kSyncId = 0x080;

enum class Service : std::uint8_t { nmt, sync, emergency, tpdo, rpdo, sdo_reply, sdo_request, error_control };

[[nodiscard]] constexpr std::uint32_t emergency_id(std::uint8_t node) { return 0x080U + node; }
/// `number` 1 to kTpdos.
[[nodiscard]] constexpr std::uint32_t tpdo_id(std::uint8_t number, std::uint8_t node) {
  return 0x080U + 0x100U * number + node;
}
[[nodiscard]] constexpr std::uint32_t rpdo_id(std::uint8_t number, std::uint8_t node) {
  return 0x100U + 0x100U * number + node;
}
[[nodiscard]] constexpr std::uint32_t sdo_reply_id(std::uint8_t node) { return 0x580U + node; }
[[nodiscard]] constexpr std::uint32_t sdo_request_id(std::uint8_t node) { return 0x600U + node; }
/// Boot-up, heartbeat and node guarding.
[[nodiscard]] constexpr std::uint32_t error_control_id(std::uint8_t node) { return 0x700U + node; }

struct CobId {
  Service service = Service::nmt;
  std::uint8_t node = 0;    ///< 0: of no node (NMT, SYNC)
  std::uint8_t number = 0;  ///< of a PDO
  friend bool operator==(const CobId&, const CobId&) = default;
};

/// No value: an id outside the set.
[[nodiscard]] std::optional<CobId> cob_id(std::uint32_t id);

/// What the link hands over: the TPDO 1 to 4 and SDO reply ids of these nodes; EMCY and error control of
/// any node.
[[nodiscard]] std::vector<can::CanFilter> filters_for(const std::vector<std::uint8_t>& nodes);

}  // namespace axisgate::canopen
