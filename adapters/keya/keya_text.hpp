// SPDX-License-Identifier: Apache-2.0
// Keya's frames in words, for the decode log: "speed of motor A = 5000", "speed: A 501, B -498".
// Promises one short line for any frame, in the units of the wire.
// Never decides anything.
#pragma once

#include <string>

#include "adapters/can/can_frame.hpp"
#include "adapters/keya/keya_serial_codec.hpp"

namespace axisgate::keya {

[[nodiscard]] std::string describe(const can::CanFrame& frame);

/// What goes to the drive. A query and an answer whose data are 0 are the same bytes.
[[nodiscard]] std::string describe_request(const SerialFrame& frame);
[[nodiscard]] std::string describe_answer(KeyaLine line, const SerialFrame& frame);

}  // namespace axisgate::keya
