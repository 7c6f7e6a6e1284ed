// SPDX-License-Identifier: Apache-2.0
// Whether a drive on Modbus RTU holds its 32-bit numbers in the order of registers that its profile says. Pure: what
// was read goes in. Promises to say so only where a number is one that no drive has, a speed of 200,000 rpm or one
// beyond what the maker prints, would not be so the other way round, and no other number says the contrary. Never
// judges a position: any of them may be.
#pragma once

#include <string>

#include "gateway/drive/state/object_store.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

/// "profile_velocity (register 18944) reads 2147483650, ...": what tells that the order is the other one; empty:
/// nothing does.
[[nodiscard]] std::string against_word_order(const model::DriveModel& model, const ObjectStore& store);

}  // namespace axisgate::drive
