#include "gateway/drive/model.hpp"

#include <algorithm>

namespace axisgate::drive {
namespace {

std::uint32_t low_bytes(std::uint32_t raw, std::uint8_t size) {
  return size >= 4 ? raw : raw & ((std::uint32_t{1} << (8U * size)) - 1U);
}

}  // namespace

std::int64_t ObjectDef::number(std::uint32_t raw) const {
  const std::int64_t value = low_bytes(raw, size);
  const std::int64_t span = std::int64_t{1} << (8 * size);
  return is_signed && value >= span / 2 ? value - span : value;
}

Range ObjectDef::range() const {
  const std::int64_t span = std::int64_t{1} << (8 * size);
  return is_signed ? Range{-span / 2, span / 2 - 1} : Range{0, span - 1};
}

std::optional<std::int64_t> Binding::to_register(std::int64_t raw) const {
  const std::optional<std::int64_t> value = raw_per_unit.inverse().scale(raw);
  if (!value || !range_of(row(quantity).type).holds(*value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> Binding::to_raw(std::int64_t value, const ObjectDef& object_def) const {
  const std::optional<std::int64_t> raw = raw_per_unit.scale(value);
  if (!raw || !object_def.range().holds(*raw)) return std::nullopt;
  return raw;
}

bool Condition::holds(const ObjectDef& object_def, std::uint32_t raw) const {
  const std::int64_t seen = mask == 0 ? object_def.number(raw) : std::int64_t{low_bytes(raw, object_def.size) & mask};
  const bool found = std::find(values.begin(), values.end(), seen) != values.end();
  const bool wanted = test == Test::equals || test == Test::in;
  return found == wanted;
}

const Binding* AxisModel::binding(Quantity q) const {
  const std::int16_t at = binding_of[static_cast<std::size_t>(q)];
  return at < 0 ? nullptr : &bindings[static_cast<std::size_t>(at)];
}

ObjectId DriveModel::find(bus::ObjectAddress address) const {
  const auto at = std::find_if(objects.begin(), objects.end(),
                               [&](const ObjectDef& candidate) { return candidate.address == address; });
  return at == objects.end() ? kNoObject : static_cast<ObjectId>(at - objects.begin());
}

}  // namespace axisgate::drive
