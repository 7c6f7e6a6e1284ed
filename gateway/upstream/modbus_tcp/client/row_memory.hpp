// SPDX-License-Identifier: Apache-2.0
// What one client wrote last to each set-point row of an axis (registers 41 to 79), and how often its targets changed.
// Promises that a scanner's block which repeats itself is known as such. Never knows what the drive holds.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/image/command.hpp"

namespace axisgate::modbus_tcp {

class RowMemory {
 public:
  static constexpr std::uint16_t kFirst = 40;
  static constexpr std::uint16_t kLast = 79;

  /// Remembers the value; true where it differs from the one before. None before counts as one that differed.
  bool write(std::uint16_t offset, std::int64_t value) {
    auto& last = last_.at(offset - kFirst);
    const bool differs = last != value;
    last = value;
    if (differs) ++changes_.at(offset - kFirst);
    return differs;
  }
  /// It was the last that was written there.
  [[nodiscard]] bool holds(std::uint16_t offset, std::int64_t value) const {
    return last_.at(offset - kFirst) == value;
  }
  /// Counts the changes of what this command goes by: two equal numbers mean that nothing of it was changed between.
  [[nodiscard]] std::uint64_t targets_of(Command command) const;
  /// The same of a controlword that starts or lets run: all targets together.
  [[nodiscard]] std::uint64_t targets() const;

 private:
  [[nodiscard]] std::uint64_t changes(std::uint16_t offset) const { return changes_.at(offset - kFirst); }
  std::array<std::optional<std::int64_t>, kLast - kFirst + 1> last_{};
  std::array<std::uint64_t, kLast - kFirst + 1> changes_{};
};

}  // namespace axisgate::modbus_tcp
