// SPDX-License-Identifier: Apache-2.0
// How a trial ends, whatever it did: the motor is stopped, the torque taken away, and the limits put back as they were.
// Pure. Promises a stop before a disable, a disable also where the stop stops nothing, and an end within kLimit. Never
// says that a motor stands which nobody has seen standing.
#pragma once

#include <string>

#include "gateway/commands/try/plan/try_acts.hpp"

namespace axisgate::commands {

class TryEnding {
 public:
  /// A stop that has not made the motor stand by then stops nothing: better that it coasts.
  static constexpr Duration kStopLimit = std::chrono::seconds(2);
  /// What the drive did not take is asked again.
  static constexpr Duration kRetry = std::chrono::seconds(1);
  static constexpr Duration kLimit = std::chrono::seconds(20);

  /// `torque`: it may be enabled. `before`: what the limits were.
  TryEnding(bool torque, std::vector<Setpoint> before, Instant now)
      : step_(torque ? Step::stop : Step::restore), before_(std::move(before)), begun_(now), standstill_(now) {}

  /// What is written next; none: nothing now. `waits`: what it gave before is not answered yet.
  [[nodiscard]] std::optional<Write> next(const AxisImage& image, bool waits, Instant now);
  [[nodiscard]] bool over() const { return step_ == Step::over; }
  /// What is left to say; empty: it stands without torque, with its limits as they were.
  [[nodiscard]] const std::string& words() const { return words_; }

 private:
  enum class Step : std::uint8_t { stop, standing, disabled, restore, restored, over };
  [[nodiscard]] std::optional<Write> give_up(std::string words);
  [[nodiscard]] std::optional<Write> await_disabled(const AxisImage& image, bool waits, Instant now);

  Step step_;
  std::vector<Setpoint> before_;
  Instant begun_;
  Instant stopped_ = kNever;
  Instant retry_ = kNever;
  Standstill standstill_;
  std::string words_;
};

}  // namespace axisgate::commands
