// SPDX-License-Identifier: Apache-2.0
// What a client may see of an axis: design 3.2's rules for axes that cannot be reached and for values that are none.
// Promises that the rules hold whatever the image says, and that every server and `sequence` use the same ones.
// Never changes the image.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "gateway/image/axis_image.hpp"

namespace axisgate {

/// error_code of an axis that cannot be reached, unless the drive's last code was another (CiA 402: life guard error).
inline constexpr std::uint16_t kErrorCodeNoContact = 0x8130;

/// In register units, or no_value() of the quantity's type. While link_state is not 2 or 3: statusword 0, error_code
/// the drive's last or kErrorCodeNoContact, all others their last good number.
[[nodiscard]] std::int64_t shown_value(const AxisImage& axis, Quantity quantity);
/// AxisInput bits; 0..10 are 0 while link_state is not 2 or 3. owned_by_me is each client's own and 0 here.
[[nodiscard]] std::uint16_t shown_inputs(const AxisImage& axis);
/// Bits 0, 3 and 7 of the coils; 0 while link_state is not 2 or 3.
[[nodiscard]] std::uint16_t shown_level_coils(const AxisImage& axis);

/// All that a client could notice of an axis: `sequence` counts how often it becomes another (design 3.2). Ages, times,
/// how long the lease still runs, `sequence` itself and the latest result are not among it.
struct AxisView {
  LinkState link_state = LinkState::unknown;
  AxisState axis_state = AxisState::unknown;
  MotionState motion_state = MotionState::none;
  std::uint16_t motion_id = 0;
  std::uint32_t alarms = 0;
  std::uint16_t loss_stop_ms = kLossNotKnown;
  std::uint32_t supported = 0;
  std::uint32_t valid = 0;        ///< AxisImage::valid_bits()
  std::uint16_t inputs = 0;       ///< shown_inputs()
  std::uint16_t level_coils = 0;  ///< shown_level_coils()
  std::shared_ptr<const ClientLife> owner{};
  std::array<std::int64_t, kQuantityCount> values{};  ///< shown_value() of each quantity
  [[nodiscard]] bool has(AxisInput input) const { return (inputs & bit(input)) != 0; }
  friend bool operator==(const AxisView&, const AxisView&) = default;
};
[[nodiscard]] AxisView view_of(const AxisImage& axis);

}  // namespace axisgate
