// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/history/slices.hpp"

#include <algorithm>

namespace axisgate::web {
namespace {

class Slicer {
 public:
  void begin(SteadyNs at) {
    if (at == at_) return;
    end();
    at_ = at;
  }
  void take(const Point& point) {
    if (!point.known) {
      (has_ ? gap_behind_ : gap_before_) = true;
      return;
    }
    low_ = has_ ? std::min(low_, point.value) : point.value;
    high_ = has_ ? std::max(high_, point.value) : point.value;
    has_ = true;
  }
  void end() {
    if (gap_before_) gap();
    if (has_) out_.push_back({at_, low_, high_, true});
    if (gap_behind_) gap();
    has_ = gap_before_ = gap_behind_ = false;
  }
  [[nodiscard]] std::vector<Slice> take_all() { return std::move(out_); }

 private:
  void gap() {
    if (out_.empty() || out_.back().known) out_.push_back({at_, 0, 0, false});
  }
  std::vector<Slice> out_;
  SteadyNs at_ = 0;
  std::int64_t low_ = 0;
  std::int64_t high_ = 0;
  bool has_ = false;
  bool gap_before_ = false;  ///< all samples of the slice
  bool gap_behind_ = false;  ///< one of them at least
};

}  // namespace

std::vector<Slice> slices(const EachPoint& each, Series series, SteadyNs from, SteadyNs to, std::size_t count) {
  const auto wanted = static_cast<SteadyNs>(count);
  const SteadyNs width = std::max<SteadyNs>((to - from + wanted - 1) / wanted, 1);
  Slicer slicer;
  slicer.begin(from);
  bool first = true;
  each(series, from, to, [&](const Point& point) {
    if (first && point.at > from) slicer.take({from, 0, false});
    first = false;
    // The very end belongs to the last slice.
    slicer.begin(from + std::min((point.at - from) / width, wanted - 1) * width);
    slicer.take(point);
    return true;
  });
  if (first) slicer.take({from, 0, false});
  slicer.end();
  return slicer.take_all();
}

}  // namespace axisgate::web
