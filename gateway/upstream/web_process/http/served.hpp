// SPDX-License-Identifier: Apache-2.0
// What this program counts itself, and how it runs. Promises counters that only grow in its life. Never says anything
// of the gateway.
#pragma once

#include <cstdint>

#include "gateway/upstream/web_process/http/refusals.hpp"

namespace axisgate::web {

struct Served {
  bool insecure = false;
  bool confined = false;
  std::size_t connections = 0;
  std::size_t streams = 0;
  std::uint64_t requests = 0;
  RefusalCounts refused{};
};

}  // namespace axisgate::web
