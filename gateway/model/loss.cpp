// SPDX-License-Identifier: Apache-2.0
#include "gateway/model/loss.hpp"

#include <algorithm>

#include "gateway/image/axis_image.hpp"

namespace axisgate::model {

std::uint16_t loss_stop_ms(const DriveModel& drive, std::optional<bool> holds) {
  if (!drive.stops_by_itself) return kGoesOn;
  if (!drive.loss_objects.empty() && !holds.value_or(true)) return kGoesOn;
  const bool unread = !drive.loss_objects.empty() && !holds;
  if (unread || drive.loss_after == Duration{}) return kLossNotKnown;
  // More than the register holds is not known either: a number that is too small would be a promise.
  const std::int64_t ms =
      (drive.loss_after + std::chrono::milliseconds(1) - Duration{1}) / std::chrono::milliseconds(1);
  return static_cast<std::uint16_t>(std::min<std::int64_t>(ms, kLossNotKnown));
}

}  // namespace axisgate::model
