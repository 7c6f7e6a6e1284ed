// SPDX-License-Identifier: Apache-2.0
// axisgate-dds topics: all axes live, as any subscriber would see them; needs no gateway of its own.
// Promises to leave the terminal as it was found, and to end at SIGINT and SIGTERM.
// Never publishes or commands.
#pragma once

#include "gateway/upstream/dds_process/options.hpp"

namespace axisgate::dds {

[[nodiscard]] int run(const TopicsOptions& options);

}  // namespace axisgate::dds
