// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/word_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {
namespace {

/// No motor turns so fast, and no drive is told to: in the units of the registers.
double most(Kind kind) {
  constexpr double kMostRpm = 100'000, kMostRpmPerS = 100'000'000;
  if (kind == Kind::velocity) return kMostRpm * shown_unit(kind).registers;
  if (kind == Kind::acceleration) return kMostRpmPerS * shown_unit(kind).registers;
  return INFINITY;
}

bool plausible(const model::DriveModel& model, model::ObjectId id, std::int64_t number) {
  const Range& printed = model.object(id).printed;
  if (number < printed.min || number > printed.max) return false;
  return std::ranges::all_of(model.axes, [&](const model::AxisModel& axis) {
    return std::ranges::all_of(axis.bindings, [&](const model::Binding& binding) {
      if (binding.object != id || !binding.scaled || binding.inverse) return true;
      const double value = static_cast<double>(number) / binding.raw_per_unit.to_double();
      return std::abs(value) <= most(row(binding.quantity).kind);
    });
  });
}

std::int64_t other_way_round(const model::ObjectDef& object, std::int64_t number) {
  const auto raw = static_cast<std::uint32_t>(static_cast<std::uint64_t>(number));
  return object.number(raw << 16U | raw >> 16U);
}

}  // namespace

std::string against_word_order(const model::DriveModel& model, const ObjectStore& store) {
  std::string against;
  if (model.protocol != "modbus-rtu") return against;
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    const auto id = static_cast<model::ObjectId>(i);
    const model::ObjectDef& object = model.object(id);
    if (object.size != 4 || object.emulated || object.is_part() || object.is_real || !store[id].known) continue;
    const std::int64_t number = store[id].number;
    const std::int64_t other = other_way_round(object, number);
    const bool as_it_is = plausible(model, id, number);
    if (as_it_is == plausible(model, id, other)) continue;
    if (as_it_is) return {};
    if (against.empty())
      against = fmt::format("{} ({}) reads {}, which no drive has, and {} the other way round", object.name,
                            place_of(model, id), number, other);
  }
  return against;
}

}  // namespace axisgate::drive
