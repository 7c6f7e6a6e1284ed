// SPDX-License-Identifier: Apache-2.0
// How values and conditions are written in a profile, wherever they stand.
#include <array>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

std::optional<model::Amount> Reading::amount(const JsonNode& node) {
  const std::string whole_text = node.text();
  std::string_view text = whole_text;
  model::Amount out;
  out.negative = text.starts_with('-');
  if (out.negative) text.remove_prefix(1);
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos) return std::nullopt;
  const std::string number(text.substr(0, space));
  const std::optional<model::Base> base = model::base_named(text.substr(space + 1));
  if (!base) {
    fault(node.pointer(), "unknown unit in \"{}\": use rpm, rps, rpm/s, rps/s, rev, Arms, %, degC or V", whole_text);
    return std::nullopt;
  }
  out.base = *base;
  if (const std::optional<Rational> exact = Rational::parse(number)) {
    out.number = *exact;
  } else {
    if (const Constant* constant = constant_named(number, node.pointer()); constant != nullptr && constant->from_drive)
      fault(node.pointer(), "constant \"{}\" is read from the drive: no amount can be told by it beforehand", number);
    out.number = number;
  }
  return out;
}

std::vector<ValueSpec> Reading::values(const JsonNode& node) {
  if (const std::optional<std::int64_t> literal = node.whole()) return {*literal};
  if (node.is_string()) {
    if (std::optional<model::Amount> found = amount(node)) return {*found};
    return {};
  }
  if (const std::optional<std::string> name = node.string("quantity")) {
    if (*name == "set_position_value") return {SetPositionValue{}};
    const std::optional<Quantity> quantity = quantity_named(*name);
    if (!quantity) {
      fault(node.pointer("quantity"), "\"{}\" is no quantity of the unified axis", *name);
      return {};
    }
    if (profile.find(*quantity) == nullptr)
      fault(node.pointer("quantity"), "this profile has no quantity \"{}\"", *name);
    return {*quantity};
  }
  std::vector<ValueSpec> out;
  if (!node.is_object()) return out;
  for (const std::string& axis : profile.axes) {
    if (!node.has(axis)) fault(node.pointer(), "a value for axis \"{}\" is missing", axis);
    const std::vector<ValueSpec> one = values(node[axis]);
    if (one.size() != 1) return {};
    out.push_back(one.front());
  }
  return out;
}

void Reading::value_fits(const ValueSpec& value, const Object& object, const std::string& pointer) {
  if (const auto* literal = std::get_if<std::int64_t>(&value)) {
    if (!object.numbers().holds(*literal))
      fault(pointer, "the value {} does not fit object \"{}\": it takes {}", *literal, object.name,
            range_text(object.numbers()));
  } else if (const auto* amount = std::get_if<model::Amount>(&value)) {
    const auto unit = profile.units.find(object.unit);
    if (unit == profile.units.end())
      fault(pointer, "object \"{}\" has no unit: give the raw number", object.name);
    else if (model::kind_of(unit->second.base) != model::kind_of(amount->base))
      fault(pointer, "this unit does not fit unit \"{}\" of object \"{}\"", object.unit, object.name);
  }
}

void Reading::value_known(const ValueSpec& value, const Object& object, const std::string& pointer) {
  if (!std::holds_alternative<model::Amount>(value)) return;
  const auto unit = profile.units.find(object.unit);
  if (unit != profile.units.end() && waits_for_drive(profile, unit->second))
    fault(pointer,
          "unit \"{}\" of object \"{}\" counts by a constant of the drive: the amount cannot be converted before the "
          "drive was read",
          object.unit, object.name);
}

/// Compared with a constant: what it may be must be possible.
void Reading::by_constant(const JsonNode& node, std::int64_t mask, ConditionSpec& out) {
  out.constant = node.text("constant");
  out.times = node.whole("times", 1);
  const Constant* constant = constant_named(out.constant, node.pointer());
  if (constant == nullptr) return;
  if (constant->from_drive)
    return fault(node.pointer(), "constant \"{}\" is read from the drive: no condition can wait for it", out.constant);
  const auto most = constant->max ? constant->max->scale(out.times) : std::nullopt;
  if (most && mask != 0 && (*most & ~mask) != 0)
    fault(node.pointer(), "{} has bits outside the mask: this can never be", *most);
}

ConditionSpec Reading::condition(const JsonNode& node, const std::string& object) {
  static constexpr std::array<std::pair<const char*, model::Condition::Test>, 4> kTests{{
      {"equals", model::Condition::Test::equals},
      {"not_equals", model::Condition::Test::not_equals},
      {"in", model::Condition::Test::in},
      {"not_in", model::Condition::Test::not_in},
  }};
  ConditionSpec out;
  out.object = object;
  const std::int64_t mask = node.whole("mask", 0);
  out.mask = static_cast<std::uint32_t>(mask);
  int tests = 0;
  std::string at = node.pointer();
  for (const auto& [key, test] : kTests) {
    const JsonNode found = node[key];
    if (!found) continue;
    ++tests;
    at = found.pointer();
    out.test = test;
    if (const std::optional<std::int64_t> one = found.whole()) out.values.push_back(*one);
    for (const std::int64_t value : numbers_in(found)) out.values.push_back(value);
    if (found.is_object()) by_constant(found, mask, out);
  }
  if (tests != 1)
    fault(node.pointer(), "a condition needs exactly one of \"equals\", \"not_equals\", \"in\", \"not_in\"");
  each_named(object, node.pointer(), [&](const Object& meant) {
    needs_readable(meant, node.pointer(), ", so no condition can look at it");
    const std::int64_t all = (std::int64_t{1} << (8 * meant.type.size)) - 1;
    if (node.has("mask") && (mask <= 0 || mask > all))
      fault(node.pointer("mask"), "the mask does not fit object \"{}\" of {} bits", meant.name, 8 * meant.type.size);
    for (const std::int64_t value : out.values) {
      if (out.mask == 0)
        needs_number(meant, value, at);
      else if ((value & ~std::int64_t{out.mask}) != 0)
        fault(at, "{} has bits outside the mask: this can never be", value);
    }
  });
  return out;
}

}  // namespace axisgate::profile
