// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/read/unit_view.hpp"

namespace axisgate::modbus_tcp {

std::optional<UnitView> UnitView::of(std::uint8_t unit, const ListenerSettings& settings, const ProcessImage& image) {
  if (!settings.per_axis_units || unit == kFlatUnit) return UnitView(0);
  if (unit == 0 || image.find(unit) == nullptr) return std::nullopt;
  return UnitView(unit);
}

std::optional<RegisterPlace> UnitView::place_register(std::uint32_t address, const ProcessImage& image) const {
  if (only_axis_ != 0) {
    if (address >= kAxisBlock) return std::nullopt;
    return RegisterPlace{Block::axis, only_axis_, static_cast<std::uint16_t>(address)};
  }
  if (address > UINT16_MAX) return std::nullopt;
  const auto place = place_of(static_cast<std::uint16_t>(address));
  if (!place) return std::nullopt;
  bool exists = true;
  switch (place->block) {
    case Block::gateway:
      break;
    case Block::axis:
      exists = image.find(place->number) != nullptr;
      break;
    case Block::bus:
      exists = place->number < image.buses.size();
      break;
    case Block::overview:
      exists = !image.axes().empty() && place->number <= image.axes().back()->number;
      break;
  }
  return exists ? place : std::nullopt;
}

std::optional<UnitView::BitPlace> UnitView::place_bit(std::uint32_t address, const ProcessImage& image) const {
  const auto place = place_register(address, image);
  if (!place || place->block != Block::axis) return std::nullopt;
  return BitPlace{image.find(place->number), place->offset};
}

const AxisImage* UnitView::axis_of_node(std::uint16_t node, const ProcessImage& image) const {
  if (only_axis_ == 0) return image.find(node);
  return node == 0 || node == only_axis_ ? image.find(only_axis_) : nullptr;
}

}  // namespace axisgate::modbus_tcp
