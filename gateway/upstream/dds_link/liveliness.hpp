// SPDX-License-Identifier: Apache-2.0
// What a DataWriter states of its liveliness, and whether that says anything of its program (design 4).
// Promises both programs one answer. Never believes what a DDS library tells of all writers of its participant: Fast
// DDS 2.9.1 takes one participant's assertion for one of all participants.
#pragma once

#include <cstdint>

namespace axisgate::dds {

enum class LivelinessKind : std::uint8_t {
  endless,  ///< no finite lease: its silence proves nothing
  automatic,
  manual_by_participant,
  manual_by_topic,
};
[[nodiscard]] constexpr LivelinessKind last_of(LivelinessKind /*any*/) { return LivelinessKind::manual_by_topic; }

/// Its assertions renew the leases of its axes, and their end is its end.
[[nodiscard]] constexpr bool is_sign_of_life(LivelinessKind kind) { return kind == LivelinessKind::manual_by_topic; }

}  // namespace axisgate::dds
