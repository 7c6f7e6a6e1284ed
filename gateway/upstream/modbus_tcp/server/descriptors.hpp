// SPDX-License-Identifier: Apache-2.0
// What the descriptor plan asks of the system: the limit on open files, and sockets moved to higher numbers.
// Promises that the plan it returns is in force, whatever the system has refused.
// Never closes anything but what it has just moved.
#pragma once

#include "gateway/upstream/modbus_tcp/server/descriptor_plan.hpp"

namespace axisgate::modbus_tcp {

[[nodiscard]] DescriptorLimits descriptor_limits();

/// Raises the soft limit as far as the needs ask and the system lets us. Once, before the first client.
[[nodiscard]] DescriptorPlan take_descriptors(const DescriptorNeeds& needs);

/// Moves an accepted socket to the lowest free number from 1024 up and closes the old one. -1: none free (errno says
/// why), and `descriptor` is closed all the same.
[[nodiscard]] int moved_up(int descriptor);

}  // namespace axisgate::modbus_tcp
