// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/unknown_constant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gateway/drive/device/object_tries.hpp"

namespace axisgate::drive {
namespace {

std::string named(const model::DriveModel& model, model::ObjectId object) {
  return fmt::format("{} ({})", model.object(object).name, place_of(model, object));
}

/// "speed_unit (0x60A9:00) holds 0x00410300".
std::string held_text(const model::DriveModel& model, const model::DriveConstant& constant, const ObjectStore& store) {
  std::vector<std::string> out;
  for (const model::ObjectId id : model::objects_of(constant))
    if (store[id].known)
      out.push_back(fmt::format("{} holds {} ({:#x})", named(model, id), store[id].number,
                                static_cast<std::uint32_t>(store[id].number)));
  return out.empty() ? "the drive has none of its objects" : fmt::format("{}", fmt::join(out, ", "));
}

std::string reason(const model::DriveModel& model, const model::DriveConstant& constant, const model::Evaluated& found,
                   const ObjectStore& store) {
  using Why = model::Evaluated::Why;
  switch (found.why) {
    case Why::absent:
      return "the drive does not have " + named(model, found.object);
    case Why::not_read:
      return "the drive does not answer " + named(model, found.object) + " as its profile has it";
    case Why::no_rule:
      return held_text(model, constant, store) + ", by which the profile knows no value";
    case Why::known:
    case Why::unusable:
      break;
  }
  return held_text(model, constant, store) + ", which makes no value that it can have";
}

bool is_of_motion(const model::DriveModel& model, const std::string& name) {
  const auto is_of = [&](const model::Binding& binding) {
    const Kind kind = row(binding.quantity).kind;
    const auto names = [&](std::size_t at) { return model.constants[at].name == name; };
    const model::ScaleRecipe& recipe = binding.recipe;
    return (kind == Kind::position || kind == Kind::velocity || kind == Kind::acceleration) &&
           (std::ranges::any_of(recipe.mul, names) || std::ranges::any_of(recipe.div, names));
  };
  return std::ranges::any_of(model.axes,
                             [&](const model::AxisModel& axis) { return std::ranges::any_of(axis.bindings, is_of); });
}

}  // namespace

std::string unknown_text(const model::DriveModel& model, const model::DriveConstant& constant,
                         const model::Evaluated& found, const ObjectStore& store) {
  if (found.value && found.value->numerator() > 0) return {};
  return fmt::format(
      "constant {0} is not known: {1}. What counts by it has no value{2}: write \"constants\": "
      "{{\"{0}\": ...}} into the entry of this drive in the configuration",
      constant.name, reason(model, constant, found, store),
      is_of_motion(model, constant.name) ? ", and nothing is moved" : "");
}

}  // namespace axisgate::drive
