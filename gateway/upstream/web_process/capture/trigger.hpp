// SPDX-License-Identifier: Apache-2.0
// What somebody has asked to be captured beside faults: a quantity of an axis that leaves its bounds, a bit, any
// change. Promises to fire when a condition becomes true that was known to be false: not at the first value, not again
// while it stays true, and what is not known in between makes it neither. Never looks at an axis but its own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/image/quantity.hpp"

namespace axisgate::web {

/// Of something that is true, false or not known: whether it has become true.
class Edge {
 public:
  /// @param now what is known; whoever does not know does not call it
  bool rises(bool now) {
    const bool rose = now && was_ == false;
    was_ = now;
    return rose;
  }

 private:
  std::optional<bool> was_;
};

enum class TriggerIs : std::uint8_t { above, below, outside, bit_set, bit_clear, changes };

struct Trigger {
  std::string name;
  std::uint16_t axis = 0;
  Quantity quantity{};
  TriggerIs is = TriggerIs::changes;
  double min = 0;    ///< of below and outside, in the unit of the quantity's name
  double max = 0;    ///< of above and outside
  unsigned bit = 0;  ///< 0 to 31
};

class TriggerWatch {
 public:
  explicit TriggerWatch(Trigger trigger) : trigger_(std::move(trigger)) {}

  [[nodiscard]] const Trigger& trigger() const { return trigger_; }
  /// A valid value. True: it fires. @param number in register units @param shown in the unit of the quantity's name
  [[nodiscard]] bool sees(std::int64_t number, double shown);

 private:
  [[nodiscard]] bool holds(std::int64_t number, double shown) const;

  Trigger trigger_;
  Edge edge_;
  std::optional<std::int64_t> last_;  ///< for what changes
};

}  // namespace axisgate::web
