// SPDX-License-Identifier: Apache-2.0
// Which axes have changed since a server looked last: so that it need not look at all of them all the time.
// Promises that no change is missed: whoever is woken finds every axis that was marked since it took the marks.
// Never says what has changed, and never calls anybody but to wake it.
#pragma once

#include <bitset>
#include <functional>

namespace axisgate {

/// Axis 0 stands for the event ring.
class ChangeBoard {
 public:
  static constexpr std::size_t kPlaces = 500;

  /// Called at the first mark after a take(), inside whatever changes the image: it may arm a timer, and no more.
  std::function<void()> wake = [] {};

  void mark(std::size_t axis) {
    const bool first = marks_.none();
    marks_.set(axis);
    if (first) wake();
  }
  /// Calls `each` with every marked axis in the order of their numbers, and forgets the marks.
  template <typename Each>
  void take(Each&& each) {
    if (marks_.none()) return;
    const auto marked = marks_;
    marks_.reset();
    for (std::size_t i = 0; i < kPlaces; ++i)
      if (marked.test(i)) each(i);
  }

 private:
  std::bitset<kPlaces> marks_;
};

}  // namespace axisgate
