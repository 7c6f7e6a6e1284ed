// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/inverter.hpp"

#include <algorithm>
#include <cstdlib>

namespace axisgate::simulated {
namespace {

constexpr std::int64_t frequency_step = 10;  // 0.01 Hz in a millisecond

std::map<std::uint16_t, RegisterRow> inverter_rows() {
  std::map<std::uint16_t, RegisterRow> made;
  for (const RegisterRow& row :
       {RegisterRow{Inverter::command, true}, RegisterRow{Inverter::frequency, true, 0, 0, 40'000},
        RegisterRow{Inverter::reset, true}, RegisterRow{Inverter::direction, true, 0, 0, 1},
        RegisterRow{Inverter::fault}, RegisterRow{Inverter::status}, RegisterRow{Inverter::output}})
    made[row.number] = row;
  return made;
}

}  // namespace

Inverter::Inverter(const InverterOptions& options)
    : RegisterSlave(inverter_rows(), options.boot_time), options_(options) {
  power_up();
}

void Inverter::power_up() {
  forget();
  runs_ = reverse_ = false;
  speed_ = 0;
  demands_ = {0};
}

std::int64_t Inverter::demand() const {
  if (!runs_ || booting()) return 0;
  return reverse_ ? -held(frequency) : held(frequency);
}

void Inverter::step() {
  const std::int64_t to = demand();
  speed_ = speed_ < to ? std::min(speed_ + frequency_step, to) : std::max(speed_ - frequency_step, to);
}

std::optional<std::int64_t> Inverter::shown(std::uint16_t number) const {
  if (number == status) return (runs_ ? 1 : 0) | (speed_ < 0 ? 8 : 0);
  if (number == output) return std::abs(speed_);
  return std::nullopt;
}

void Inverter::written(std::uint16_t number, std::int64_t value, std::uint64_t) {
  if (number == command) {
    if ((value & 3) == 1) runs_ = false;
    if ((value & 3) == 2) runs_ = true;
    if ((value >> 4 & 3) == 1) reverse_ = false;
    if ((value >> 4 & 3) == 2) reverse_ = true;
  }
  if (number == direction) reverse_ = value == 1;
  if (demand() != demands_.back()) demands_.push_back(demand());
}

}  // namespace axisgate::simulated
