// SPDX-License-Identifier: Apache-2.0
// axisgate-dds serve: the gateway's records become samples, and clients' samples records, until the gateway is gone.
// Promises that one thread does all of it and waits for nothing but poll(), and an exit code of exit_codes.hpp.
// Never decides about an axis.
#pragma once

#include "gateway/upstream/dds_process/options.hpp"

namespace axisgate::dds {

[[nodiscard]] int run(const ServeOptions& options);

}  // namespace axisgate::dds
