// SPDX-License-Identifier: Apache-2.0
// How values and conditions are written in a profile, wherever they stand.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

std::optional<model::Amount> Reading::amount(const json& node, const std::string& pointer) {
  if (!node.is_string()) return std::nullopt;
  std::string_view text = node.get_ref<const std::string&>();
  model::Amount out;
  out.negative = text.starts_with('-');
  if (out.negative) text.remove_prefix(1);
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos) return std::nullopt;
  const std::string number(text.substr(0, space));
  const std::optional<model::Base> base = model::base_named(text.substr(space + 1));
  if (!base) {
    fault(pointer,
          "unknown unit in \"" + node.get<std::string>() + "\": use rpm, rps, rpm/s, rps/s, rev, Arms, %, degC or V");
    return std::nullopt;
  }
  out.base = *base;
  if (const std::optional<Rational> exact = Rational::parse(number)) {
    out.number = *exact;
  } else {
    const auto constant = profile.constants.find(number);
    if (constant == profile.constants.end())
      fault(pointer, "unknown constant \"" + number + "\": not under /constants" +
                         did_you_mean(number, keys_in(profile.constants)));
    else if (constant->second.from_drive)
      fault(pointer, "constant \"" + number + "\" is read from the drive: no amount can be told by it beforehand");
    out.number = number;
  }
  return out;
}

std::vector<ValueSpec> Reading::values(const json& node, const std::string& pointer) {
  if (const std::optional<std::int64_t> literal = whole(node)) return {*literal};
  if (node.is_string()) {
    if (std::optional<model::Amount> found = amount(node, pointer)) return {*found};
    return {};
  }
  if (const json* name = member(node, "quantity"); name != nullptr && name->is_string()) {
    if (*name == "set_position_value") return {SetPositionValue{}};
    if (const std::optional<Quantity> quantity = quantity_named(name->get_ref<const std::string&>())) {
      if (profile.find(*quantity) == nullptr)
        fault(pointer_to(pointer, "quantity"), "this profile has no quantity \"" + name->get<std::string>() + "\"");
      return {*quantity};
    }
    fault(pointer_to(pointer, "quantity"), "\"" + name->get<std::string>() + "\" is no quantity of the unified axis");
    return {};
  }
  std::vector<ValueSpec> out;
  if (!node.is_object()) return out;
  for (const std::string& axis : profile.axes) {
    const json* own = member(node, axis);
    const std::vector<ValueSpec> one =
        own == nullptr ? std::vector<ValueSpec>{} : values(*own, pointer_to(pointer, axis));
    if (one.size() != 1) {
      if (own == nullptr) fault(pointer, "a value for axis \"" + axis + "\" is missing");
      return {};
    }
    out.push_back(one.front());
  }
  return out;
}

void Reading::value_fits(const ValueSpec& value, const Object& object, const std::string& pointer) {
  if (const auto* literal = std::get_if<std::int64_t>(&value)) {
    if (!object.numbers().holds(*literal))
      fault(pointer, "the value " + std::to_string(*literal) + " does not fit object \"" + object.name +
                         "\": it takes " + range_text(object.numbers()));
    return;
  }
  const std::string& named = object.unit;
  if (const auto* amount = std::get_if<model::Amount>(&value)) {
    const auto unit = profile.units.find(named);
    if (unit == profile.units.end())
      fault(pointer, "object \"" + object.name + "\" has no unit: give the raw number");
    else if (model::kind_of(unit->second.base) != model::kind_of(amount->base))
      fault(pointer, "this unit does not fit unit \"" + named + "\" of object \"" + object.name + "\"");
  }
}

void Reading::value_known(const ValueSpec& value, const Object& object, const std::string& pointer) {
  if (!std::holds_alternative<model::Amount>(value)) return;
  const auto unit = profile.units.find(object.unit);
  if (unit != profile.units.end() && waits_for_drive(profile, unit->second))
    fault(pointer,
          "unit \"" + object.unit + "\" of object \"" + object.name +
              "\" counts by a constant of the drive: the amount cannot be converted before the drive was read");
}

/// Compared with a constant: what it may be must be possible.
void Reading::by_constant(const json& node, std::int64_t mask, const std::string& pointer, ConditionSpec& out) {
  out.constant = text_in(node, "constant");
  out.times = whole_in(node, "times", 1);
  const auto constant = profile.constants.find(out.constant);
  if (constant == profile.constants.end())
    return fault(pointer, "unknown constant \"" + out.constant + "\": not under /constants" +
                              did_you_mean(out.constant, keys_in(profile.constants)));
  if (constant->second.from_drive)
    return fault(pointer, "constant \"" + out.constant + "\" is read from the drive: no condition can wait for it");
  const auto most = constant->second.max ? constant->second.max->scale(out.times) : std::nullopt;
  if (most && mask != 0 && (*most & ~mask) != 0)
    fault(pointer, std::to_string(*most) + " has bits outside the mask: this can never be");
}

ConditionSpec Reading::condition(const json& node, const std::string& object, const std::string& pointer) {
  static constexpr std::array<std::pair<const char*, model::Condition::Test>, 4> kTests{{
      {"equals", model::Condition::Test::equals},
      {"not_equals", model::Condition::Test::not_equals},
      {"in", model::Condition::Test::in},
      {"not_in", model::Condition::Test::not_in},
  }};
  ConditionSpec out;
  out.object = object;
  const std::int64_t mask = whole_in(node, "mask", 0);
  out.mask = static_cast<std::uint32_t>(mask);
  int tests = 0;
  std::string at = pointer;
  for (const auto& [key, test] : kTests) {
    const json* found = member(node, key);
    if (found == nullptr) continue;
    ++tests;
    at = pointer_to(pointer, key);
    out.test = test;
    if (const std::optional<std::int64_t> one = whole(*found)) out.values.push_back(*one);
    if (found->is_array())
      for (const json& entry : *found)
        if (const std::optional<std::int64_t> value = whole(entry)) out.values.push_back(*value);
    if (found->is_object()) by_constant(*found, mask, at, out);
  }
  if (tests != 1) fault(pointer, "a condition needs exactly one of \"equals\", \"not_equals\", \"in\", \"not_in\"");
  if (!names_object(object, pointer)) return out;
  each_meaning(object, [&](const Object& meant) {
    if (!meant.readable) fault(pointer, "object \"" + meant.name + "\" cannot be read, so no condition can look at it");
    const std::int64_t all = (std::int64_t{1} << (8 * meant.type.size)) - 1;
    if (member(node, "mask") != nullptr && (mask <= 0 || mask > all))
      fault(pointer_to(pointer, "mask"),
            "the mask does not fit object \"" + meant.name + "\" of " + std::to_string(8 * meant.type.size) + " bits");
    for (const std::int64_t value : out.values) {
      const bool masked_out = out.mask != 0 && (value & ~std::int64_t{out.mask}) != 0;
      if (masked_out)
        fault(at, std::to_string(value) + " has bits outside the mask: this can never be");
      else if (out.mask == 0 && !meant.numbers().holds(value))
        fault(at, std::to_string(value) + " does not fit object \"" + meant.name + "\": it takes " +
                      range_text(meant.numbers()));
    }
  });
  return out;
}

}  // namespace axisgate::profile
