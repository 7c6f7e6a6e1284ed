// What commissioning an axis comes to: the checks of its drive, what they found, and the writes that would remedy them.
// Pure. Promises each write once, in the order of the profile, with storing last. Never writes anything.
#pragma once

#include <string>
#include <vector>

#include "gateway/drive/drive.hpp"

namespace axisgate::app {

struct Finding {
  const drive::Check* check = nullptr;
  bool known = false;  ///< the drive told the value
  bool bad = false;
  std::int64_t value = 0;
};

/// One per check that concerns the axis, in the profile's order.
[[nodiscard]] std::vector<Finding> findings(const drive::DriveModel& model, const drive::ObjectStore& store,
                                            bus::AxisSlot slot);
/// The remedies of the bad ones together.
[[nodiscard]] std::vector<drive::ObjectWrite> remedies(const std::vector<Finding>& found);
/// "2010.03 = 0 (why)"
[[nodiscard]] std::string text(const drive::DriveModel& model, const drive::ObjectWrite& write);
[[nodiscard]] std::string text(const drive::DriveModel& model, const Finding& finding);

}  // namespace axisgate::app
