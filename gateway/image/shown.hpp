// SPDX-License-Identifier: Apache-2.0
// What a client may see of an axis: design 3.2's rules for axes that cannot be reached and for values that are none.
// Promises that the rules hold whatever the image says, and that every server and `sequence` use the same ones.
// Never changes the image.
#pragma once

#include <cstdint>

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

}  // namespace axisgate
