// SPDX-License-Identifier: Apache-2.0
// What counts as a sign of life of a DDS client (design 4): the one place that says so.
// Promises that what was written, or has waited here, too long ago is none, and that a library which goes on for a
// program that hangs is believed nothing. Never knows which axes a client owns.
#pragma once

#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

class SignsOfLife {
 public:
  /// `max_age`: none: when a sample was written is not looked at. `longest_wait`: from axisgate-dds to here.
  SignsOfLife(std::optional<Duration> max_age, Duration longest_wait)
      : max_age_(max_age), longest_wait_(longest_wait) {}

  /// A sample that was written then: it is neither too old, nor from as far ahead, nor without a time.
  [[nodiscard]] bool fresh(SteadyNs written, Instant now) const;
  /// A request that was written then as well, and has not waited too long since axisgate-dds received it, while this
  /// gateway stood still perhaps: that clock is ours, whether those of other hosts are looked at or not. 0: unknown.
  [[nodiscard]] bool fresh(SteadyNs written, SteadyNs received, Instant now) const;
  /// Of the writer `heartbeat.client`, whose last counter was this one: only one that has changed counts, from the
  /// client's own participant.
  [[nodiscard]] bool counts(const HeartbeatRecord& heartbeat, std::optional<std::uint32_t> last, Instant now) const;

 private:
  std::optional<Duration> max_age_;
  Duration longest_wait_;
};

/// What the log is to say of a writer whose liveliness counts for nothing; empty: nothing.
[[nodiscard]] std::string liveliness_remark(LivelinessKind kind);

}  // namespace axisgate::dds
