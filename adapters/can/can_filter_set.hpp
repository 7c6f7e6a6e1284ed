// SPDX-License-Identifier: Apache-2.0
// The receive filters of a link: what the kernel is given, and what is looked at once more here.
// Promises that nothing is passed by passes() but what some filter passes, and that for_kernel() lets all of that
// through, with at most as many filters as asked for. Never drops a filter.
#pragma once

#include <bitset>
#include <vector>

#include "adapters/can/can_link.hpp"

namespace axisgate::can {

/// CAN_RAW_FILTER_MAX of <linux/can/raw.h>: setsockopt() refuses more.
inline constexpr std::size_t kMaxKernelFilters = 512;

class FilterSet {
 public:
  FilterSet() = default;
  explicit FilterSet(std::vector<CanFilter> filters);
  [[nodiscard]] bool passes(const CanFrame& frame) const;
  /// The filters themselves where they are few enough; else wider ones, each standing for a range of ids.
  [[nodiscard]] std::vector<CanFilter> for_kernel(std::size_t most = kMaxKernelFilters) const;

 private:
  std::vector<CanFilter> filters_;
  std::bitset<kMaxStandardId + 1>
      standard_;  ///< looked up for each frame: 127 nodes with all their ids are 889 filters
  std::vector<CanFilter> extended_;
};

}  // namespace axisgate::can
