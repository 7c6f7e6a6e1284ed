// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/answer_width.hpp"

#include <algorithm>

namespace axisgate::drive {

bool moves_by(const model::DriveModel& model, model::ObjectId object) {
  const auto same = [&](model::ObjectId bound) {
    if (model.whole(bound) == object) return true;
    const auto& aliases = model.object(object).aliases;
    return std::ranges::find(aliases, bound) != aliases.end();
  };
  const auto counts = [&](const model::Binding& binding) {
    const Kind kind = row(binding.quantity).kind;
    const bool of_motion = kind == Kind::position || kind == Kind::velocity || kind == Kind::acceleration;
    return of_motion && same(binding.object);
  };
  return std::ranges::any_of(model.axes,
                             [&](const model::AxisModel& axis) { return std::ranges::any_of(axis.bindings, counts); });
}

std::optional<std::int64_t> narrowed(const model::DriveModel& model, model::ObjectId id, const bus::ReplyField& field) {
  const model::ObjectDef& object = model.object(id);
  if (!model::is_canopen(model) || field.size <= object.size || moves_by(model, id)) return std::nullopt;
  model::ObjectDef wide;
  wide.size = field.size;
  wide.is_signed = object.is_signed;
  const std::int64_t number = object.number(field.raw);
  const bool zeros = (std::uint64_t{field.raw} >> (8U * object.size)) == 0;
  if (!zeros && wide.number(field.raw) != number) return std::nullopt;
  return number;
}

}  // namespace axisgate::drive
