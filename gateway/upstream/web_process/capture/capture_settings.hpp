// SPDX-License-Identifier: Apache-2.0
// What is captured, and how many captures stay: keys `captures` and `triggers` of the section "web", resolved.
// Promises values that the gateway has checked. Never changes while the program runs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gateway/upstream/web_link/capture_defaults.hpp"
#include "gateway/upstream/web_process/capture/trigger.hpp"
#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::web {

struct CaptureSettings {
  SteadyNs before = kCaptureBeforeS * kSecond;
  SteadyNs after = kCaptureAfterS * kSecond;
  std::size_t keep = kCapturesKept;
  std::string folder{};  ///< empty: in memory alone
  std::vector<Trigger> triggers{};
};

}  // namespace axisgate::web
