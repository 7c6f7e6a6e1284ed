// SPDX-License-Identifier: Apache-2.0
// How soon a drive stops its motors by itself when the gateway dies: register 98.
// Promises one answer for the register, alarm no_comm_watchdog and `axisgate check`. Pure. Never promises a stop that
// no manual states.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/model/model.hpp"

namespace axisgate::model {

/// `holds`: whether the drive was read to hold what makes it notice (DriveModel::loss_objects); none: nobody knows.
/// axisgate::kGoesOn: it does not stop; axisgate::kLossNotKnown: nobody knows.
[[nodiscard]] std::uint16_t loss_stop_ms(const DriveModel& drive, std::optional<bool> holds);

}  // namespace axisgate::model
