// SPDX-License-Identifier: Apache-2.0
// Which requests a stop has overtaken: stops are sent on before what was received before them (design 3.4, stops).
// Promises that nothing which was received before a stop of its axis counts as asked after it, whoever sent the two and
// by which topic. Never judges what is a stop, nor drops one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>

#include "gateway/image/axis_image.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

class StopOrder {
 public:
  /// A stop of an axis that is there is carried out.
  void stopped(AxisNumber axis, SteadyNs received) {
    Stops& of = axes_[axis];
    of.newest = std::max(of.newest, received);
    ++of.count;
  }
  /// A stop that came later was carried out already. What is received at an unknown time (0) is not.
  [[nodiscard]] bool overtaken(AxisNumber axis, SteadyNs received) const {
    const auto found = axes_.find(axis);
    return found != axes_.end() && received != 0 && received < found->second.newest;
  }
  /// Another number than before: there was a stop between.
  [[nodiscard]] std::uint64_t count(AxisNumber axis) const {
    const auto found = axes_.find(axis);
    return found == axes_.end() ? 0 : found->second.count;
  }

 private:
  struct Stops {
    SteadyNs newest = 0;
    std::uint64_t count = 0;
  };
  std::map<AxisNumber, Stops> axes_;
};

}  // namespace axisgate::dds
