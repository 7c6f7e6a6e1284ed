// SPDX-License-Identifier: Apache-2.0
// A CANopen frame in words, for the decode log: "SDO read 6041:00 of node 3".
// Promises one short line for any frame. Which service a frame is of follows from its COB-ID alone.
// Never decides anything.
#pragma once

#include <string>

#include "adapters/bus/exchange.hpp"
#include "adapters/can/can_frame.hpp"

namespace axisgate::canopen {

/// "6041:00".
[[nodiscard]] std::string object_text(ObjectAddress object);

[[nodiscard]] std::string describe(const can::CanFrame& frame);

}  // namespace axisgate::canopen
