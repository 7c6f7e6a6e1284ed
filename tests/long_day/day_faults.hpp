// SPDX-License-Identifier: Apache-2.0
// The faults of the long day: one at a time, drawn, and over after a while. Promises that after end() nothing of it is
// left, and to count each by its kind. Never strikes more than one line at once.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tests/long_day/day_plant.hpp"

namespace axisgate::test::long_day {

enum class Kind : std::uint8_t { unplugged, cut, restarted, lost, late, doubled, corrupted, noise, stalled };
inline constexpr std::size_t kKinds = 9;

class DayFaults {
 public:
  DayFaults(GatewayStage& stage, std::vector<GatewayStage::Line> lines, std::uint64_t seed)
      : stage_(stage), lines_(std::move(lines)), random_(seed), lost_links_(lines_.size()) {}

  void begin();
  void end();
  /// " cut 12, late 3"
  [[nodiscard]] std::string told() const;
  /// How often an exchange on the line may have ended without an answer or a timeout of its own.
  [[nodiscard]] std::uint64_t endings_on(std::size_t line) const { return lost_links_.at(line); }

 private:
  void strike_often(simulated::DriveFault fault);

  GatewayStage& stage_;
  const std::vector<GatewayStage::Line> lines_;
  simulated::Random random_;
  std::vector<std::uint64_t> lost_links_;
  std::array<std::uint64_t, kKinds> count_{};
  std::size_t line_ = 0, drive_ = 0;
};

}  // namespace axisgate::test::long_day
