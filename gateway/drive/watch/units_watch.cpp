// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/watch/units_watch.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/model/watch_rules.hpp"

namespace axisgate::drive {

std::optional<UnitsWatch::Disagreement> UnitsWatch::observe(const Seen& seen) {
  if (!seen.counts || seen.motion != motion_ || reported_) window_.reset();
  motion_ = seen.motion;
  if (!seen.counts || reported_) return std::nullopt;
  if (seen.velocity && seen.velocity->at > velocity_at_) take_velocity(*seen.velocity);
  if (!seen.position || seen.position->at <= position_at_) return std::nullopt;
  position_at_ = seen.position->at;
  if (!window_) window_ = Window{.from = *seen.position, .to = {}};
  if (!window_->to && position_at_ - window_->from.at >= seen.window) window_->to = *seen.position;
  if (!window_->to || velocity_at_ < window_->to->at + rules_.lag) return std::nullopt;
  const Window whole = *window_;
  window_ = Window{.from = *seen.position, .to = {}};
  return judge(whole);
}

void UnitsWatch::take_velocity(const TimedValue& velocity) {
  velocity_at_ = velocity.at;
  if (!window_ || velocity.at < window_->from.at) return;
  Window& window = *window_;
  window.lowest = window.velocities == 0 ? velocity.value : std::min(window.lowest, velocity.value);
  window.highest = window.velocities == 0 ? velocity.value : std::max(window.highest, velocity.value);
  window.sum += velocity.value;
  ++window.velocities;
  // What is all but 0 is as steady as can be.
  const double largest = std::max(std::abs(window.lowest), std::abs(window.highest));
  if (window.highest - window.lowest >= std::max(kSteady * largest, rules_.standstill)) window_.reset();
}

std::optional<UnitsWatch::Disagreement> UnitsWatch::judge(const Window& window) {
  constexpr double kSecondsPerMinute = 60;
  constexpr int kFewest = 3;
  if (window.velocities < kFewest) return std::nullopt;
  const double minutes = std::chrono::duration<double>(window.to->at - window.from.at).count() / kSecondsPerMinute;
  const Disagreement found{.velocity = window.sum / window.velocities,
                           .position = (window.to->value - window.from.value) / minutes};
  const double faster = std::max(std::abs(found.velocity), std::abs(found.position));
  if (faster <= model::kTimesStandstill * rules_.standstill) return std::nullopt;
  off_ = std::abs(found.velocity - found.position) > kOff * faster ? off_ + 1 : 0;
  if (off_ < kWindows) return std::nullopt;
  reported_ = true;
  return found;
}

}  // namespace axisgate::drive
