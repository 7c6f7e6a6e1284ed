#include "gateway/image/process_image.hpp"

#include <algorithm>
#include <cassert>

namespace axisgate {

AxisImage& ProcessImage::add_axis(AxisNumber number, std::string name, std::uint8_t bus) {
  assert(number >= 1 && number <= kMaxAxisNumber && by_number_[number] == nullptr);
  auto axis = std::make_unique<AxisImage>();
  axis->number = number;
  axis->name = std::move(name);
  axis->bus = bus;
  axis->board = &changes;
  by_number_[number] = axis.get();
  const auto place =
      std::find_if(axes_.begin(), axes_.end(), [number](const auto& other) { return other->number > number; });
  return **axes_.insert(place, std::move(axis));
}

AxisImage* ProcessImage::find(AxisNumber number) const {
  return number < by_number_.size() ? by_number_[number] : nullptr;
}

}  // namespace axisgate
