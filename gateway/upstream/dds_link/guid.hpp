// SPDX-License-Identifier: Apache-2.0
// DDSI-RTPS GUIDs, as far as the gateway reads them.
// Promises the one place that knows which bytes are the participant's.
// Never knows a DDS type.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace axisgate::dds {

/// GUID of a DataWriter: 12 bytes of its participant's prefix, 4 of the entity id (DDSI-RTPS 2.2, 9.3.1).
using Guid = std::array<std::uint8_t, 16>;
inline constexpr std::size_t kGuidPrefix = 12;

using GuidPrefix = std::array<std::uint8_t, kGuidPrefix>;

template <std::size_t Count>
[[nodiscard]] std::array<std::uint8_t, Count> first_bytes(const Guid& guid) {
  std::array<std::uint8_t, Count> out{};
  std::copy_n(guid.begin(), Count, out.begin());
  return out;
}

[[nodiscard]] inline GuidPrefix participant_of(const Guid& guid) { return first_bytes<kGuidPrefix>(guid); }

/// With DDS-Security these come from the subject of the participant's certificate (DDS-Security 1.1, 9.3.3).
inline constexpr std::size_t kIdentityBytes = 6;
using Identity = std::array<std::uint8_t, kIdentityBytes>;

[[nodiscard]] inline Identity identity_of(const Guid& guid) { return first_bytes<kIdentityBytes>(guid); }

[[nodiscard]] inline bool same_participant(const Guid& a, const Guid& b) {
  return std::equal(a.begin(), a.begin() + kGuidPrefix, b.begin());
}

}  // namespace axisgate::dds
