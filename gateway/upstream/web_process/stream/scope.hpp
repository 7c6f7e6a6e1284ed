// SPDX-License-Identifier: Apache-2.0
// The lines that one page's stream shows: which samples go next. Pure: history and instants in.
// Promises each sample of each line once, in the order of time; where more came than a frame has room for, the lowest
// and highest of what came together, and every gap. Never sends what was before the stream: that is /history.
#pragma once

#include <string>
#include <vector>

#include "gateway/upstream/web_process/api/stores.hpp"

namespace axisgate::web {

class Scope {
 public:
  /// In one frame, of all lines together; one more than that is thinned out.
  static constexpr std::size_t kMostPoints = 2000;

  /// @param begin nothing older is sent
  Scope(std::vector<Series> series, SteadyNs begin);

  /// Data of the next event `scope`; empty: there is nothing new.
  [[nodiscard]] std::string next(const Stores& stores, const Now& now);

 private:
  struct Line {
    Series series;
    SteadyNs sent;  ///< up to here
  };
  std::vector<Line> lines_;
};

/// Of more points than `most` (5 at least): the lowest and highest of so many neighbours each, and gaps between them.
[[nodiscard]] std::vector<Point> thinned(const std::vector<Point>& points, std::size_t most);

}  // namespace axisgate::web
