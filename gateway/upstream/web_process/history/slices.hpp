// SPDX-License-Identifier: Apache-2.0
// A line in so many slices, each with its lowest and highest sample. Pure.
// Promises that no spike is lost, however few the slices, and that a gap is a gap. Never joins what a gap divides.
#pragma once

#include <vector>

#include "gateway/upstream/web_process/history/history.hpp"

namespace axisgate::web {

struct Slice {
  SteadyNs at = 0;  ///< its begin
  std::int64_t low = 0;
  std::int64_t high = 0;
  bool known = false;  ///< false: a gap, until the next one
  friend bool operator==(const Slice&, const Slice&) = default;
};

/// Of the slices those in which there is a sample or a gap begins, with what holds at `from` as the first: three
/// entries at most for each of `count`. What stands is not repeated. @param to behind `from`
[[nodiscard]] std::vector<Slice> slices(const EachPoint& each, Series series, SteadyNs from, SteadyNs to,
                                        std::size_t count);

}  // namespace axisgate::web
