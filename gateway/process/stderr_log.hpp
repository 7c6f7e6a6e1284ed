// SPDX-License-Identifier: Apache-2.0
// The log of the product: one line an event on stderr, with the time of day, or for systemd's journal with its
// priority. Promises a line that is written whole or not at all; systemd and a person read the same. Never waits for a
// disk: stderr is a pipe or a terminal.
#pragma once

#include "gateway/core/log.hpp"

namespace axisgate::process {

[[nodiscard]] Log stderr_log(LogLevel most_detailed);

}  // namespace axisgate::process
