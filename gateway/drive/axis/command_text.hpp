// SPDX-License-Identifier: Apache-2.0
// What a client asks of an axis, in words: "move_absolute, target_position 5000 (0.5 rev)".
// Promises the number that a register carries and what it is in turns, rpm and percent; codes in hex and in words; the
// target of a start also where it was written before; and a bounded length, whatever the request holds.
// Never says who asks, nor what became of it.
#pragma once

#include <optional>
#include <string>

#include "gateway/drive/plan/admission.hpp"
#include "gateway/drive/state/axis_core.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

/// Set-points of one request that are written out; of more, their number.
inline constexpr std::size_t kMaxShownValues = 6;

/// "3 rpm", "12.5 turns"; a code as its number.
[[nodiscard]] std::string limit_text(const AxisCore& core, const PassedLimit& passed);
/// `batch` as its client has asked for it; `jog_velocity`: of a jog.
[[nodiscard]] std::string command_text(const AxisCore& core, const WriteBatch& batch, std::uint32_t jog_velocity);

/// The write batch itself carries this quantity.
[[nodiscard]] bool sets(const WriteBatch& batch, Quantity quantity);

}  // namespace axisgate::drive
