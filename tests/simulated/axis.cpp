// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/axis.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

FinePosition floor_divide(FinePosition value, FinePosition by) { return value / by - (value % by < 0 ? 1 : 0); }

}  // namespace

void Axis::step(Dec speed, bool position_loop, int direction) {
  speed_ = speed;
  demand_ += speed;
  FinePosition lag = demand_ - actual_;
  if (position_loop) lag -= std::clamp(lag, -short_by_, short_by_);
  FinePosition wanted = physical_ + direction * lag;
  if (jammed_) wanted = physical_;
  if (mechanics_.positive_stop) wanted = std::min(wanted, *mechanics_.positive_stop * fine_per_count);
  if (mechanics_.negative_stop) wanted = std::max(wanted, *mechanics_.negative_stop * fine_per_count);

  const FinePosition before = physical_;
  actual_speed_ = direction * (wanted - before);
  stalled_ = speed != 0 && actual_speed_ == 0;
  physical_ = wanted;
  actual_ += actual_speed_;
  if (blurred()) {
    ++steps_;
    told_.push_back(actual_speed_);
    while (told_.size() > blur_.late + 1) told_.pop_front();
  }
  if (!position_loop) demand_ = actual_;

  // An index pulse lies at index_offset + k revolutions. One is passed when the step crosses or reaches it.
  index_passed_.reset();
  const FinePosition offset = mechanics_.index_offset * fine_per_count;
  const FinePosition turns_before = floor_divide(before - offset, revolution_);
  const FinePosition turns_now = floor_divide(physical_ - offset, revolution_);
  std::optional<FinePosition> index;
  if (turns_now > turns_before) index = offset + turns_now * revolution_;
  if (turns_now < turns_before) index = offset + turns_before * revolution_;
  if (index && *index != before) index_passed_ = actual_ - direction * (physical_ - *index);
}

Dec Axis::told_speed() const {
  if (!blurred() || told_.empty()) return actual_speed_;
  constexpr std::uint64_t spread = 2654435761U;  // each step otherwise, and always the same
  const auto part = static_cast<Dec>(steps_ * spread >> 8 & 1023U) - 511;
  return told_.front() + blur_.noise * part / 511;
}

void Axis::redefine(FinePosition actual) {
  demand_ += actual - actual_;
  actual_ = actual;
}

}  // namespace axisgate::simulated
