// SPDX-License-Identifier: Apache-2.0
// The keep-alive of a drive that disables itself when it hears no command (profile key "keepalive"): what is sent
// again, and when. Pure: control writes, instants and what the axes show go in. Promises that it repeats nothing but
// the number that a set-point object was last known to take, in a mode in which that moves nothing, for an axis that is
// enabled, by somebody who still answers for it, a speed only while its run is on, and that it is asked for at half its
// period, so that a busy line has the other half. Never enables, starts or changes anything.
#pragma once

#include <optional>
#include <vector>

#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {

class KeepAlive {
 public:
  explicit KeepAlive(const model::DriveModel& model);

  [[nodiscard]] bool wanted() const { return model_.keep_alive > Duration{}; }
  /// The drive comes up from scratch: nothing that was sent counts.
  void reset();
  /// The drive has taken a control write of this object, sent then.
  void written(model::ObjectId object, Instant sent_at);
  /// A repetition came to nothing: it is not tried again at once.
  void failed(AxisSlot slot, Instant now);

  struct Repeat {
    model::ObjectId object = model::kNoObject;
    std::int64_t number = 0;
  };
  /// What is to be sent again for this axis as it is now. `stopping`: a stop of it is pending, under way or owed:
  /// nothing but a speed or torque of 0. `live`: its owner's lease runs, or leases are off.
  [[nodiscard]] std::optional<Repeat> repeat(const AxisCore& core, bool stopping, bool live) const;
  /// When a repetition for this axis is due.
  [[nodiscard]] Instant due(AxisSlot slot) const;

 private:
  const model::DriveModel& model_;
  std::vector<Instant> written_;  ///< per axis: its newest control write
  std::vector<Instant> not_before_;
};

}  // namespace axisgate::drive
