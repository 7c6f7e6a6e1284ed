// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/standstill.hpp"

#include <cmath>

namespace axisgate::commands {

std::optional<double> turns_of(const AxisImage& image) {
  const Sample& position = image[Quantity::position_actual];
  if (!image.supports(Quantity::position_actual) || !position.valid) return std::nullopt;
  return static_cast<double>(position.value) / image.units_per_rev.to_double();
}

std::optional<double> rpm_of(const AxisImage& image) {
  constexpr double kPerRpm = 1000;
  const Sample& velocity = image[Quantity::velocity_actual];
  if (!image.supports(Quantity::velocity_actual) || !velocity.valid) return std::nullopt;
  return static_cast<double>(velocity.value) / kPerRpm;
}

bool may_hold_torque(const AxisImage& image) {
  if (image.has(AxisInput::enabled)) return true;
  if (!image.supports(Quantity::statusword)) return false;
  const Sample& statusword = image[Quantity::statusword];
  return !statusword.valid || model::holds_motor(model::state_of(static_cast<std::uint16_t>(statusword.value)));
}

void Standstill::look(const AxisImage& image) {
  const auto turns = turns_of(image);
  const Instant at = image[Quantity::position_actual].at;
  if (!turns || at <= newest_) return;
  newest_ = at;
  if (at_ && std::abs(*turns - *at_) <= kTremble) return;
  if (at_) turned_ = at;
  here_since_ = at;
  at_ = turns;
}

}  // namespace axisgate::commands
