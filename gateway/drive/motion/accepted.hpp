// SPDX-License-Identifier: Apache-2.0
// The set-points of one axis that were accepted last, whoever wrote them and whatever was sent to the drive for them.
// Promises that a velocity or torque is forgotten with everything that makes it needed again (design 3.4 What
// survives). Never decides what is accepted: the axis does.
#pragma once

#include <array>
#include <optional>

#include "gateway/image/axis_record.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

class Accepted {
 public:
  /// `at`: the point in the axis's record.
  void note(Quantity quantity, std::int64_t value, AxisRecord::Point at) { entry(quantity) = Entry{value, at}; }
  /// It was accepted and never begun: nobody knows any more what is wanted.
  void forget(const WriteBatch& batch) {
    for (const Setpoint& sp : batch.setpoints) forget(sp.quantity);
    if (batch.mode) forget(Quantity::mode);
  }
  void forget(Quantity quantity) { entry(quantity).reset(); }
  /// The drive has come up from scratch: parameters are what it holds, targets are as they were asked for.
  void forget_parameters() {
    for (std::size_t i = 0; i < entries_.size(); ++i)
      if (!is_target(static_cast<Quantity>(i))) entries_[i].reset();
  }
  [[nodiscard]] std::optional<std::int64_t> value(Quantity quantity, const AxisRecord& record) const {
    const auto& entry = entries_[static_cast<std::size_t>(quantity)];
    const bool lapses = quantity == Quantity::target_velocity || quantity == Quantity::target_torque;
    if (!entry || (lapses && record.void_since(entry->at))) return std::nullopt;
    return entry->value;
  }

 private:
  struct Entry {
    std::int64_t value = 0;
    AxisRecord::Point at = 0;
  };
  [[nodiscard]] static bool is_target(Quantity quantity) {
    return quantity == Quantity::target_position || quantity == Quantity::target_velocity ||
           quantity == Quantity::target_torque;
  }
  [[nodiscard]] std::optional<Entry>& entry(Quantity quantity) { return entries_[static_cast<std::size_t>(quantity)]; }
  std::array<std::optional<Entry>, kQuantityCount> entries_{};
};

}  // namespace axisgate::drive
