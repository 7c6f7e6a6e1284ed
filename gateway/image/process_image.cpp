// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/process_image.hpp"

#include <algorithm>
#include <cassert>

namespace axisgate {

AxisImage& ProcessImage::add_axis(AxisNumber number, std::string name, std::uint8_t bus) {
  assert(number >= 1 && number <= kMaxAxisNumber && by_number_[number] == nullptr);
  const auto before = removed_.find(number);
  auto axis = before == removed_.end() ? std::make_unique<AxisImage>() : std::move(before->second);
  if (before != removed_.end()) removed_.erase(before);
  axis->number = number;
  axis->name = std::move(name);
  axis->bus = bus;
  axis->board = &changes;
  by_number_[number] = axis.get();
  const auto place = std::ranges::find_if(axes_, [number](const auto& other) { return other->number > number; });
  return **axes_.insert(place, std::move(axis));
}

void ProcessImage::remove_axis(AxisNumber number) {
  const auto place = std::ranges::find(axes_, number, [](const auto& axis) { return axis->number; });
  if (place == axes_.end()) return;
  by_number_[number] = nullptr;
  AxisImage nothing;
  nothing.number = number;
  nothing.sequence = (*place)->sequence + 1;
  nothing.record = (*place)->record;
  nothing.record.lost();
  nothing.counts = (*place)->counts;
  **place = std::move(nothing);
  removed_.insert_or_assign(number, std::move(*place));
  axes_.erase(place);
  changes.mark(number);
}

AxisImage* ProcessImage::find(AxisNumber number) const {
  return number < by_number_.size() ? by_number_[number] : nullptr;
}

}  // namespace axisgate
