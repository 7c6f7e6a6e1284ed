// SPDX-License-Identifier: Apache-2.0
// `axisgate-web serve`: shows the axes of the gateway that holds the other end of its socket.
// Promises to end soon after the gateway, and to tell it why where it cannot begin. Never outlives it.
#pragma once

#include "gateway/upstream/web_process/options.hpp"

namespace axisgate::web {

/// The exit code.
[[nodiscard]] int run(const ServeOptions& options);

}  // namespace axisgate::web
