// SPDX-License-Identifier: Apache-2.0
// Whether a drive shows the effect of a write that no state of its own tells: that it slows down or stands after a
// stop, that a homing has begun. Pure: what was known when the write was sent and what was read since go in.
// Promises that only samples asked for after the write's answer count, and that what nothing can show is not waited
// for. Never sends.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/drive/state/axis_core.hpp"
#include "gateway/drive/watch/slowing.hpp"

namespace axisgate::drive {

enum class Effect : std::uint8_t { none, stop, homing };

class EffectWatch {
 public:
  /// A write goes on the wire now: what is known of the axis is what was so before it.
  void sending(const AxisCore& core);
  /// What must be read to see the effect, what was read longest ago first; kNoObject: nothing of this drive shows it.
  [[nodiscard]] static model::ObjectId to_read(const AxisCore& core, Effect effect);
  /// Samples of exchanges later than `after` show it, or show that nobody can tell.
  [[nodiscard]] bool shown(const AxisCore& core, Effect effect, std::uint64_t after);

 private:
  [[nodiscard]] bool stops(const AxisCore& core, std::uint64_t after);
  [[nodiscard]] bool homes(const AxisCore& core, std::uint64_t after) const;

  Instant sent_at_ = kLongAgo;
  FirstFall fall_;  ///< from the first sending on
  struct Before {
    bool moving = false;
    bool homed = false;
    bool homing_failed = false;
    std::optional<std::int64_t> position{};  ///< as the drive counts
  } before_;
};

/// A stop of this axis has something to show: it may turn, and has torque.
[[nodiscard]] bool stop_shows(const AxisCore& core);

}  // namespace axisgate::drive
