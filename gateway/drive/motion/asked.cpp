// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/motion/asked.hpp"

namespace axisgate::drive {
namespace {

constexpr ClientId kGateway = 0;

bool lapses(Quantity quantity) { return quantity == Quantity::target_velocity || quantity == Quantity::target_torque; }

}  // namespace

bool is_speed(Quantity quantity) {
  using enum Quantity;
  return quantity == max_torque || quantity == profile_velocity || quantity == profile_acceleration ||
         quantity == profile_deceleration;
}

void Asked::accept(const WriteBatch& batch) {
  const auto note = [&](Quantity quantity, std::int64_t value) {
    entry(quantity).accepted = Wanted{value, {}, batch.client, record_.now()};
  };
  // A button's speed is no client's target.
  if (!batch.jogs)
    for (const Setpoint& sp : batch.setpoints) note(sp.quantity, sp.value);
  if (batch.mode) note(Quantity::mode, *batch.mode);
}

void Asked::withdraw(const WriteBatch& batch) {
  for (const Setpoint& sp : batch.setpoints) entry(sp.quantity).accepted.reset();
  if (batch.mode) entry(Quantity::mode).accepted.reset();
}

std::optional<std::int64_t> Asked::accepted(Quantity quantity) const {
  const auto& newest = entry(quantity).accepted;
  return newest && holds(quantity, *newest) ? std::optional(newest->value) : std::nullopt;
}

void Asked::take(Quantity quantity, Wanted wanted, bool beside_stop) {
  wanted.at = record_.accepted();
  entry(quantity).taken = wanted;
  if (beside_stop && lapses(quantity)) record_.set_aside();
}

std::optional<Wanted> Asked::taken(Quantity quantity) const {
  std::optional<Wanted> newest = entry(quantity).taken;
  if (!newest || !(is_speed(quantity) || holds(quantity, *newest))) return std::nullopt;
  if (record_.rescaled_since(newest->at)) newest->exact.reset();
  return newest;
}

void Asked::owe(Quantity quantity, std::optional<std::int64_t> held) {
  if (held && !owed(quantity)) take(quantity, {*held, {}, kGateway});
}

std::optional<std::int64_t> Asked::owed(Quantity quantity) const {
  const auto newest = taken(quantity);
  return newest && newest->by == kGateway ? std::optional(newest->value) : std::nullopt;
}

bool Asked::holds(Quantity quantity, const Wanted& wanted) const {
  if (lapses(quantity)) return !record_.void_since(wanted.at);
  return quantity == Quantity::target_position || !record_.restarted_since(wanted.at);
}

}  // namespace axisgate::drive
