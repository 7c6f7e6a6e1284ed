// SPDX-License-Identifier: Apache-2.0
#include "adapters/canopen/cob_id.hpp"

#include <cassert>

namespace axisgate::canopen {

std::optional<CobId> cob_id(std::uint32_t id) {
  if (id == kNmtId) return CobId{Service::nmt, 0, 0};
  if (id == kSyncId) return CobId{Service::sync, 0, 0};
  const auto node = static_cast<std::uint8_t>(id & 0x7F);
  if (id > can::kMaxStandardId || node < kFirstNode) return std::nullopt;
  const std::uint32_t function = id >> 7;
  switch (function) {
    case 0x1:
      return CobId{Service::emergency, node, 0};
    case 0x3:
    case 0x5:
    case 0x7:
    case 0x9:
      return CobId{Service::tpdo, node, static_cast<std::uint8_t>((function - 1) / 2)};
    case 0x4:
    case 0x6:
    case 0x8:
    case 0xA:
      return CobId{Service::rpdo, node, static_cast<std::uint8_t>((function - 2) / 2)};
    case 0xB:
      return CobId{Service::sdo_reply, node, 0};
    case 0xC:
      return CobId{Service::sdo_request, node, 0};
    case 0xE:
      return CobId{Service::error_control, node, 0};
    default:
      return std::nullopt;
  }
}

std::vector<can::CanFilter> filters_for(const std::vector<std::uint8_t>& nodes) {
  std::vector<can::CanFilter> filters;
  const auto pass = [&](std::uint32_t id) { filters.push_back({.id = id, .mask = can::kMaxStandardId}); };
  filters.push_back({.id = error_control_id(0), .mask = can::kMaxStandardId & ~std::uint32_t{kLastNode}});
  // 081h to 0FFh: SYNC, which lies before them, comes a thousand times a second where another master needs it.
  for (std::uint8_t first = 1; first < kLastNode; first = static_cast<std::uint8_t>(first << 1))
    filters.push_back({.id = emergency_id(first), .mask = can::kMaxStandardId & ~(std::uint32_t{first} - 1)});
  for (const std::uint8_t node : nodes) {
    for (std::uint8_t number = 1; number <= kTpdos; ++number) pass(tpdo_id(number, node));
    pass(sdo_reply_id(node));
  }
  assert(filters.size() <= can::kMaxFilters);
  return filters;
}

}  // namespace axisgate::canopen
