// SPDX-License-Identifier: Apache-2.0
// A gateway that dies while it sends: so many bytes, on CAN frames, still leave it, and whatever was to come after them
// does not. Promises that one that was not told to die never does. Never ends the gateway itself: the test does that
// when it is dead to its cable.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

namespace axisgate::test {

class LastWords {
 public:
  /// From now on; a frame is one unit of CAN, a byte one of the others.
  void die_after(std::size_t units) { left_ = units; }
  void live() { left_.reset(); }
  /// It is dead: it hears nothing any more.
  [[nodiscard]] bool dead() const { return left_ == std::size_t{0}; }
  /// How many of the next `units` still leave it.
  [[nodiscard]] std::size_t take(std::size_t units) {
    if (!left_) return units;
    const std::size_t taken = std::min(units, *left_);
    *left_ -= taken;
    return taken;
  }

 private:
  std::optional<std::size_t> left_;
};

}  // namespace axisgate::test
