// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/direct_data.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

std::map<std::uint16_t, RegisterRow> direct_data_rows() {
  std::map<std::uint16_t, RegisterRow> made;
  for (std::uint16_t number = DirectData::data_number; number < DirectData::trigger + 2; ++number)
    made[number] = {number, true};
  made[DirectData::inputs] = {DirectData::inputs, true, 0x40};
  for (const int number :
       {int{DirectData::outputs}, int{DirectData::alarm}, int{DirectData::actual_position},
        DirectData::actual_position + 1, int{DirectData::actual_speed}, DirectData::actual_speed + 1})
    made[static_cast<std::uint16_t>(number)] = {static_cast<std::uint16_t>(number)};
  return made;
}

}  // namespace

DirectData::DirectData(const DirectDataOptions& options)
    : RegisterSlave(direct_data_rows(), options.boot_time), options_(options), axis_(mechanics_, steps_per_rev) {
  power_up();
}

void DirectData::power_up() {
  forget();
  motion_.end();
  axis_.forget_demand();
}

void DirectData::step() {
  if (!enabled()) motion_.end();
  const FinePosition far = INT64_MAX / 4;
  axis_.step(motion_.running() ? motion_.next_speed(axis_, {}, -far, far) : 0, enabled(), 1);
}

std::optional<std::int64_t> DirectData::shown(std::uint16_t number) const {
  const std::int64_t place = counts_of(axis_.actual());
  const std::int64_t hertz = divide_rounded(axis_.actual_speed() * 1000, fine_per_count);
  if (number == outputs) return (enabled() && !moves() ? 0x20 : 0) | (moves() ? 0x2000 : 0) | (enabled() ? 1 : 0);
  if (number == alarm) return 0;
  if (number == actual_position) return high_of(place);
  if (number == actual_position + 1) return low_of(place);
  if (number == actual_speed) return high_of(hertz);
  if (number == actual_speed + 1) return low_of(hertz);
  return std::nullopt;
}

void DirectData::written(std::uint16_t number, std::int64_t value, std::uint64_t tag) {
  tags_[number] = tag;
  if (number == inputs && (value & 0x20) != 0) motion_.stop({0, 0, 1, fine_per_ms(100), 0});
  if (number == trigger + 1 && value == 1 && enabled()) start(tag);
}

// What another request has left there counts as 0.
void DirectData::start(std::uint64_t tag) {
  const auto told = [&](std::uint16_t pair) { return tags_[pair] == tag ? held_pair(pair) : 0; };
  ++starts_;
  if (told(way) != 1) return;
  const auto rate = [&](std::uint16_t pair) { return std::max<Dec>(fine_per_ms(told(pair)) / 1000, 1); };
  motion_.move(Id286proMotion::Task::absolute, told(position) * fine_per_count,
               {0, 0, rate(starting_rate), rate(stopping_rate), fine_per_ms(told(speed))});
}

}  // namespace axisgate::simulated
