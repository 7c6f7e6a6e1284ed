// SPDX-License-Identifier: Apache-2.0
// From what is known of an axis to what its image shows (design 3.1 and 3.2). Pure.
// Promises that a value is valid only while the drive is reachable and the value younger than its stale time.
// Never steps the sequence: that is the axis's, which sees the image before and after.
#pragma once

#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {

/// A value older than 3 of its periods, at least this, is not valid (design 7, point 6).
inline constexpr Duration kStaleAtLeast = std::chrono::milliseconds(300);

/// What is fixed when the gateway starts.
void show_model(const model::AxisModel& model, AxisImage& image);
/// `image.link_state` is set by the caller before.
void show_state(const AxisCore& core, AxisImage& image);
/// When show_state() would show something else without a new sample: a value turns stale.
[[nodiscard]] Instant stale_deadline(const AxisCore& core);
/// The text of the check behind the alarm, or of the alarm itself.
[[nodiscard]] std::string alarm_text(const AxisCore& core, AxisAlarm alarm);

}  // namespace axisgate::drive
