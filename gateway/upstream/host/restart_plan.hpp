// SPDX-License-Identifier: Apache-2.0
// When a program of the gateway's own is started again after an end, and what is reported of it.
// Promises a quick first restart, pauses that double while it fails, and one message a change: an end that only repeats
// the one before is counted, not reported. Never starts or ends a process itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/core/clock.hpp"
#include "gateway/upstream/host/restart_cause.hpp"

namespace axisgate::host {

/// What it serves is back within 3 s of a crash: this, and the time that it needs itself (a DDS participant 2 s).
inline constexpr Duration kFirstPause = std::chrono::milliseconds(200);
inline constexpr Duration kLongestPause = std::chrono::seconds(30);
/// Where an address that it needs is not there yet: as for a listener.
inline constexpr Duration kAddressPause = std::chrono::seconds(1);
/// So long after it was ready it counts as sound, and the next pause is the first again.
inline constexpr Duration kRanWell = std::chrono::seconds(60);
/// From its start to its ReadyRecord.
inline constexpr Duration kReadyWithin = std::chrono::seconds(10);
/// From the end of the connection to the end of the process.
inline constexpr Duration kEndsWithin = std::chrono::seconds(2);

class RestartPlan {
 public:
  explicit RestartPlan(const HostedProgram& program) : program_(program) {}

  /// What is reported, once, when it is ready.
  [[nodiscard]] std::string on_ready(const std::string& version, Instant now);

  struct Next {
    Duration pause{};
    std::optional<std::string> report{};  ///< none: it repeats what was reported last
  };
  [[nodiscard]] Next on_end(const ProcessEnd& end, Instant now);

 private:
  const HostedProgram& program_;
  std::optional<Instant> ready_{};
  Duration pause_ = kFirstPause;
  std::optional<ProcessEnd> reported_{};  ///< since it was ready last
  std::uint32_t failed_ = 0;              ///< ends since it was ready last
};

}  // namespace axisgate::host
