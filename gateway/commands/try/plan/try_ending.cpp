// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/try_ending.hpp"

#include <fmt/format.h>

namespace axisgate::commands {

std::optional<Write> TryEnding::give_up(std::string words) {
  words_ = std::move(words);
  step_ = Step::over;
  return std::nullopt;
}

std::optional<Write> TryEnding::next(const AxisImage& image, bool waits, Instant now) {
  standstill_.look(image);
  switch (step_) {
    case Step::stop:
      step_ = Step::standing;
      stopped_ = now;
      if (image.supports(Command::quick_stop)) return Write{.command = Command::quick_stop};
      return Write{.command = image.supports(Command::halt) ? Command::halt : Command::disable};
    case Step::standing:
      if (!standstill_.stands() && now - stopped_ < kStopLimit) return std::nullopt;
      step_ = Step::disabled;
      retry_ = now + kRetry;
      return Write{.command = Command::disable};
    case Step::disabled:
      return await_disabled(image, waits, now);
    case Step::restore:
      step_ = Step::restored;
      if (before_.empty() || !image.reachable()) return std::nullopt;
      return Write{.setpoints = before_};
    case Step::restored:
    case Step::over:
      if (waits) return std::nullopt;
      step_ = Step::over;
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Write> TryEnding::await_disabled(const AxisImage& image, bool waits, Instant now) {
  const bool torque = may_hold_torque(image);
  const bool stands = standstill_.stands() || !image.supports(Quantity::position_actual);
  if (image.reachable() && !torque && stands && !waits) {
    step_ = Step::restore;
    return std::nullopt;
  }
  if (now - begun_ >= kLimit) {
    if (!image.reachable())
      return give_up("THE DRIVE DOES NOT ANSWER: whether its motor stands is not known. Use the wired stop");
    return give_up(torque ? "THE DRIVE STILL SHOWS TORQUE. Use the wired stop"
                          : "the drive has no torque, and its motor was not seen to stand: look at it");
  }
  if (waits || now < retry_ || (image.reachable() && !torque)) return std::nullopt;
  retry_ = now + kRetry;
  return Write{.command = Command::disable};
}

}  // namespace axisgate::commands
