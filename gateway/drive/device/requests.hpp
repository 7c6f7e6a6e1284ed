// SPDX-License-Identifier: Apache-2.0
// The requests that a drive is read with. Promises that an object is asked for in the profile's width, or in any where
// the profile says so. Never asks for more than was wanted: what comes along is ReadBlocks' part.
#pragma once

#include "adapters/bus/exchange.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::drive {

[[nodiscard]] bus::Exchange read_of(const model::DriveModel& model, model::ObjectId object);
/// As many registers as tell its reply from one that is owed.
[[nodiscard]] bus::Exchange read_of(const model::DriveModel& model, const model::ResyncRead& read);
/// A read that every drive of this type answers.
[[nodiscard]] bus::Exchange plain_read(const model::DriveModel& model);
/// A read that shows that the drive is there.
[[nodiscard]] bus::Exchange probe_read(const model::DriveModel& model);
/// Another object than that of probe_read(), where the drive has one.
[[nodiscard]] bus::Exchange other_probe_read(const model::DriveModel& model);

}  // namespace axisgate::drive
