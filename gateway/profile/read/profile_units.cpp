// SPDX-License-Identifier: Apache-2.0
// Sections "constants" and "units".
#include <algorithm>
#include <nlohmann/json.hpp>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

void read_constant(Reading& reading, const std::string& name, const json& node) {
  const std::string pointer = pointer_to("/constants", name);
  Constant out;
  out.required = flag_in(node, "required", false);
  out.from_drive = member(node, "first") != nullptr;
  out.text = text_in(node, "text");
  if (const json* standard = member(node, "default")) {
    out.standard = rational_of(*standard);
    if (!out.standard) reading.fault(pointer_to(pointer, "default"), "is no decimal number");
    if (out.required) reading.fault(pointer, "\"required\" and \"default\" exclude each other");
  }
  if (const json* range = member(node, "range"); range != nullptr && range->is_array() && range->size() == 2) {
    out.min = rational_of((*range)[0]);
    out.max = rational_of((*range)[1]);
    if (!out.min || !out.max)
      reading.fault(pointer_to(pointer, "range"), "must be two decimal numbers");
    else if (out.max->to_double() < out.min->to_double())
      reading.fault(pointer_to(pointer, "range"), "the first limit is above the second");
    else if (out.standard &&
             (out.standard->to_double() < out.min->to_double() || out.standard->to_double() > out.max->to_double()))
      reading.fault(pointer_to(pointer, "default"), "is outside the constant's own range");
  }
  if (out.from_drive && (out.standard || out.required))
    reading.fault(pointer, "\"first\" (read from the drive) excludes \"default\" and \"required\"");
  reading.profile.constants.emplace(name, std::move(out));
}

std::vector<model::Factor> factors(Reading& reading, const json& node, std::string_view key,
                                   const std::string& pointer) {
  std::vector<model::Factor> out;
  const json* list = member(node, key);
  if (list == nullptr || !list->is_array()) return out;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const json& entry = (*list)[i];
    const std::string at = pointer_to(pointer_to(pointer, key), i);
    if (const std::optional<Rational> number = rational_of(entry)) {
      if (number->numerator() <= 0) reading.fault(at, "a factor must be above 0");
      out.emplace_back(*number);
    } else if (entry.is_string()) {
      const std::string name = entry;
      const auto constant = reading.profile.constants.find(name);
      if (constant == reading.profile.constants.end())
        reading.fault(at, "unknown constant \"" + name + "\": not under /constants" +
                              did_you_mean(name, keys_in(reading.profile.constants)));
      else if (!constant->second.from_drive && (!constant->second.min || constant->second.min->numerator() <= 0))
        reading.fault(at, "constant \"" + name + "\" is a factor: give it a \"range\" above 0");
      out.emplace_back(name);
    }
  }
  return out;
}

/// What a rule of a drive's constant is made of: a number, an object, or a constant that is known beforehand.
model::Factor operand_in(Reading& reading, const json& node, const std::string& pointer) {
  if (const std::optional<std::int64_t> number = whole(node)) return Rational(*number);
  if (!node.is_string()) return Rational(1);
  const std::string name = node;
  const auto constant = reading.profile.constants.find(name);
  if (constant != reading.profile.constants.end()) {
    if (constant->second.from_drive)
      reading.fault(pointer, "constant \"" + name + "\" is itself read from the drive: name the objects it comes from");
    return name;
  }
  if (!reading.names_object(name, pointer)) return name;
  std::size_t meanings = 0;
  reading.each_meaning(name, [&](const Object& object) {
    ++meanings;
    if (!object.readable) reading.fault(pointer, "object \"" + object.name + "\" cannot be read");
  });
  if (meanings > 1)
    reading.fault(pointer, "\"" + name + "\" is another object on each axis, and a constant is the whole drive's: " +
                               "name one of them, \"" + reading.profile.axes.front() + "." + name + "\"");
  return name;
}

/// Whether it is the first of the two operators rather than the second.
bool operator_in(Reading& reading, const json& text, std::string_view first, std::string_view second,
                 const std::string& pointer) {
  const std::string given = text.is_string() ? text.get<std::string>() : std::string();
  if (given != first && given != second)
    reading.fault(pointer,
                  text.dump() + " is no operator here; use " + std::string(first) + " or " + std::string(second));
  return given == first;
}

void read_product(Reading& reading, const json& value, const std::string& pointer, Constant::Rule& out) {
  if (value.size() % 2 == 0) reading.fault(pointer, "ends with an operator");
  bool multiplies = true;
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (k % 2 == 0)
      (multiplies ? out.mul : out.div).push_back(operand_in(reading, value[k], pointer));
    else
      multiplies = operator_in(reading, value[k], "*", "/", pointer);
  }
}

Constant::Rule read_rule(Reading& reading, const json& node, bool last, const std::string& pointer) {
  Constant::Rule out;
  const json* condition = member(node, "if");
  const std::string at = pointer_to(pointer, "if");
  if (condition != nullptr && condition->is_array() && condition->size() == 3) {
    out.conditional = true;
    out.left = operand_in(reading, (*condition)[0], at);
    out.equal = operator_in(reading, (*condition)[1], "==", "!=", at);
    out.right = operand_in(reading, (*condition)[2], at);
  } else if (condition == nullptr && !last) {
    reading.fault(pointer, "without \"if\" this rule always holds: those after it are never used");
  }
  if (const json* value = member(node, "value"); value != nullptr && value->is_array())
    read_product(reading, *value, pointer_to(pointer, "value"), out);
  return out;
}

}  // namespace

void read_constant_rules(Reading& reading) {
  for (auto& [name, constant] : reading.profile.constants) {
    if (!constant.from_drive) continue;
    const json* rules = member(reading.document["constants"][name], "first");
    if (rules == nullptr || !rules->is_array()) continue;
    const std::string pointer = pointer_to(pointer_to("/constants", name), "first");
    for (std::size_t i = 0; i < rules->size(); ++i)
      constant.rules.push_back(read_rule(reading, (*rules)[i], i + 1 == rules->size(), pointer_to(pointer, i)));
    if (!rules->empty() && member(rules->back(), "if") != nullptr)
      reading.fault(pointer, "the last rule needs no \"if\": else the constant may have no value");
  }
}

void read_constants(Reading& reading) {
  if (const json* section = member(reading.document, "constants"); section != nullptr && section->is_object())
    for (const auto& [name, node] : section->items()) read_constant(reading, name, node);
}

void read_units(Reading& reading) {
  const json* section = member(reading.document, "units");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [name, node] : section->items()) {
    const std::string pointer = pointer_to("/units", name);
    model::Unit out;
    out.base = model::base_named(text_in(node, "base")).value_or(model::Base::rpm);
    out.mul = factors(reading, node, "mul", pointer);
    out.div = factors(reading, node, "div", pointer);
    reading.profile.units.emplace(name, std::move(out));
  }
}

}  // namespace axisgate::profile
