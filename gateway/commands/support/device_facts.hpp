// SPDX-License-Identifier: Apache-2.0
// What this computer knows of a device that a configuration names: whether it is there, whose it is, who has it open.
// Promises words where something cannot be seen. Never opens a device: a serial port that is opened may reset what is
// behind it.
#pragma once

#include <string>

#include "gateway/commands/support/plan/places.hpp"

namespace axisgate::commands::support {

/// Lines, each ended by a newline.
[[nodiscard]] std::string device_facts(const Device& device);

}  // namespace axisgate::commands::support
