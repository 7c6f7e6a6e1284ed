// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile.hpp"

#include <algorithm>

namespace axisgate::profile {
Range Object::numbers() const {
  const std::int64_t span = std::int64_t{1} << (8 * type.size);
  Range out = type.is_signed ? Range{-span / 2, span / 2 - 1} : Range{0, span - 1};
  if (range) out = {std::max(out.min, range->min), std::min(out.max, range->max)};
  return out;
}

const Place* Object::place(std::string_view protocol) const {
  const auto at = places.find(protocol);
  return at == places.end() ? nullptr : &at->second;
}

const std::string& QuantitySpec::unit_of(const Object& object) const {
  if (units.empty()) return object.unit;
  return object.slot < units.size() ? units[object.slot] : units.front();
}

bool WriteSpec::is_on(std::string_view protocol) const {
  return on.empty() || std::ranges::find(on, protocol) != on.end();
}

bool ConfiguredModeSpec::is_fixed_on(std::string_view protocol) const {
  return std::ranges::find(fixed_on, protocol) != fixed_on.end();
}

bool KeepAliveSpec::is_on(std::string_view protocol) const {
  return on.empty() || std::ranges::find(on, protocol) != on.end();
}

const Object* Profile::find(std::string_view object, AxisSlot motor) const {
  const std::string own = motor < axes.size() ? axes[motor] + "." + std::string(object) : std::string();
  const Object* shared = nullptr;
  for (const Object& candidate : objects) {
    if (candidate.name == own) return &candidate;
    if (candidate.name == object) shared = &candidate;
  }
  return shared;
}

const Object* Profile::named(std::string_view object) const {
  const auto at = std::ranges::find(objects, object, &Object::name);
  return at == objects.end() ? nullptr : &*at;
}

const QuantitySpec* Profile::find(Quantity quantity) const {
  const auto at = std::ranges::find(quantities, quantity, &QuantitySpec::quantity);
  return at == quantities.end() ? nullptr : &*at;
}

}  // namespace axisgate::profile
