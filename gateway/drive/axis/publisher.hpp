// SPDX-License-Identifier: Apache-2.0
// From what is known of an axis to what its image shows (design 3.1 and 3.2). Pure.
// Promises that a value is valid only while the drive is reachable and the value younger than its stale time.
// Never steps the sequence: that is the axis's, which sees what was shown before and after.
#pragma once

#include <vector>

#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {

/// A value older than 3 of its periods, at least this, is not valid (design 7, point 6).
inline constexpr Duration kStaleAtLeast = std::chrono::milliseconds(300);

/// Writes one axis's image. A sample is made again where something has become of the objects it is made of, or where it
/// hangs on more than these; how old it is, is looked at each time.
class AxisWriter {
 public:
  AxisWriter(const AxisCore& core, AxisImage& image) : core_(core), image_(image) { show_model(); }

  /// What is fixed while the drive's own constants are; all samples are made again next time.
  void show_model();
  /// `image.link_state` is set by the caller before.
  void show_state();
  /// When show_state() would show something else without a new sample: a value turns stale.
  [[nodiscard]] Instant stale_at() const { return stale_at_; }

 private:
  struct Made {
    std::uint64_t of = 0;       ///< ObjectStore::changed() of its newest object; 0: it was not made yet
    Instant at = kLongAgo;      ///< when it was last confirmed; kLongAgo: never
    Instant stale_at = kNever;  ///< it is good until then
    bool good = false;          ///< there is a number, and its register holds it
    bool cyclic = false;        ///< its age is the image's
  };
  void make(const model::Binding& binding, const AxisFacts& facts, Made& made);

  const AxisCore& core_;
  AxisImage& image_;
  std::vector<Made> made_;  ///< of each of the model's bindings
  Instant stale_at_ = kNever;
};

/// The text of the check behind the alarm, or of the alarm itself.
[[nodiscard]] std::string alarm_text(const AxisCore& core, AxisAlarm alarm);

}  // namespace axisgate::drive
