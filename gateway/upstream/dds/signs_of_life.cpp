// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/signs_of_life.hpp"

namespace axisgate::dds {

bool SignsOfLife::fresh(SteadyNs written, Instant now) const {
  if (!max_age_) return true;
  if (written == 0) return false;
  const Duration age = now.time_since_epoch() - std::chrono::nanoseconds(written);
  return age <= *max_age_ && -age <= *max_age_;
}

bool SignsOfLife::fresh(SteadyNs written, SteadyNs received, Instant now) const {
  const Duration waited = now.time_since_epoch() - std::chrono::nanoseconds(received);
  return fresh(written, now) && (received == 0 || waited <= longest_wait_);
}

bool SignsOfLife::counts(const HeartbeatRecord& heartbeat, std::optional<std::uint32_t> last, Instant now) const {
  return same_participant(heartbeat.writer, heartbeat.client) && last != heartbeat.counter &&
         fresh(heartbeat.written, now);
}

std::string liveliness_remark(LivelinessKind kind) {
  if (kind == LivelinessKind::endless || is_sign_of_life(kind)) return {};
  return std::string("its ") + (kind == LivelinessKind::automatic ? "AUTOMATIC" : "MANUAL_BY_PARTICIPANT") +
         " liveliness counts for nothing: its axes need samples, MANUAL_BY_TOPIC, or axisgate/heartbeat";
}

}  // namespace axisgate::dds
