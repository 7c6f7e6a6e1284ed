// SPDX-License-Identifier: Apache-2.0
// What the CANopen wire of a bus must know, from its configuration and its resolved drives.
// Promises the shortest own heartbeat and SYNC period that any drive of the bus asks for.
// Never opens a device.
#pragma once

#include <vector>

#include "adapters/canopen/canopen_wire.hpp"
#include "gateway/config/config.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::compose {

[[nodiscard]] canopen::CanopenSettings canopen_settings(const config::BusConfig& bus,
                                                        const std::vector<model::DriveModel>& drives);

}  // namespace axisgate::compose
