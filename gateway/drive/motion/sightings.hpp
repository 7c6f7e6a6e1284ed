// SPDX-License-Identifier: Apache-2.0
// What samples have shown of one axis until now, and what a new one shows that those before did not: a fault, the loss
// of the drive, that it is disabled. Pure. Promises that each such change is reported once, and that an axis which was
// found enabled counts as found until it was out of that state, or something was asked of it. Never decides what a
// change ends: the motion rules do.
#pragma once

#include "gateway/drive/motion/axis_facts.hpp"

namespace axisgate::drive {

class Sightings {
 public:
  struct Changes {
    bool faulted = false;
    bool lost = false;
    bool disabled = false;
    [[nodiscard]] bool any() const { return faulted || lost || disabled; }
  };
  /// New samples.
  [[nodiscard]] Changes see(const AxisFacts& facts);

  /// Something was started or stopped: what runs now is known.
  void asked() { found_ = false; }
  /// Enabled when it came into sight and ever since, and nothing was asked of it.
  [[nodiscard]] bool found() const { return found_; }
  /// The same by the newest samples, and the gateway had not seen it before.
  [[nodiscard]] bool found_at_start() const { return found_at_start_; }

 private:
  bool faulted_ = false;  ///< by the samples seen last, as are the two below
  bool reachable_ = false;
  bool enabled_ = false;
  bool ever_reachable_ = false;
  bool found_ = false;
  bool found_at_start_ = false;
};

}  // namespace axisgate::drive
