// SPDX-License-Identifier: Apache-2.0
// Sections "constants" and "units".
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

void read_constant(Reading& reading, const JsonNode& node) {
  Constant out;
  out.required = node.flag("required", false);
  out.from_drive = node.has("first");
  out.text = node.text("text");
  if (const JsonNode standard = node["default"]) {
    out.standard = standard.rational();
    if (!out.standard) reading.fault(standard.pointer(), "is no decimal number");
    if (out.required) reading.fault(node.pointer(), "\"required\" and \"default\" exclude each other");
  }
  if (const std::vector<JsonNode> range = node["range"].elements(); range.size() == 2) {
    out.min = range[0].rational();
    out.max = range[1].rational();
    if (!out.min || !out.max)
      reading.fault(node.pointer("range"), "must be two decimal numbers");
    else if (out.max->to_double() < out.min->to_double())
      reading.fault(node.pointer("range"), "the first limit is above the second");
    else if (out.standard &&
             (out.standard->to_double() < out.min->to_double() || out.standard->to_double() > out.max->to_double()))
      reading.fault(node.pointer("default"), "is outside the constant's own range");
  }
  if (out.from_drive && (out.standard || out.required))
    reading.fault(node.pointer(), "\"first\" (read from the drive) excludes \"default\" and \"required\"");
  reading.profile.constants.emplace(node.key(), std::move(out));
}

std::vector<model::Factor> factors(Reading& reading, const JsonNode& list) {
  std::vector<model::Factor> out;
  for (const JsonNode& entry : list.elements()) {
    if (const std::optional<Rational> number = entry.rational()) {
      if (number->numerator() <= 0) reading.fault(entry.pointer(), "a factor must be above 0");
      out.emplace_back(*number);
    } else if (entry.is_string()) {
      const std::string name = entry.text();
      const Constant* constant = reading.constant_named(name, entry.pointer());
      if (constant != nullptr && !constant->from_drive && (!constant->min || constant->min->numerator() <= 0))
        reading.fault(entry.pointer(), "constant \"{}\" is a factor: give it a \"range\" above 0", name);
      out.emplace_back(name);
    }
  }
  return out;
}

/// What a rule of a drive's constant is made of: a number, an object, or a constant that is known beforehand.
model::Factor operand_in(Reading& reading, const JsonNode& node, const std::string& pointer) {
  if (const std::optional<std::int64_t> number = node.whole()) return Rational(*number);
  if (!node.is_string()) return Rational(1);
  const std::string name = node.text();
  const auto constant = reading.profile.constants.find(name);
  if (constant != reading.profile.constants.end()) {
    if (constant->second.from_drive)
      reading.fault(pointer, "constant \"{}\" is itself read from the drive: name the objects it comes from", name);
    return name;
  }
  std::size_t meanings = 0;
  reading.each_named(name, pointer, [&](const Object& object) {
    ++meanings;
    reading.needs_readable(object, pointer);
  });
  if (meanings > 1)
    reading.fault(pointer,
                  "\"{0}\" is another object on each axis, and a constant is the whole drive's: name one of them, "
                  "\"{1}.{0}\"",
                  name, reading.profile.axes.front());
  return name;
}

/// Whether it is the first of the two operators rather than the second.
bool operator_in(Reading& reading, const JsonNode& node, std::string_view first, std::string_view second,
                 const std::string& pointer) {
  const std::string given = node.text();
  if (given != first && given != second)
    reading.fault(pointer, "{} is no operator here; use {} or {}", node.dump(), first, second);
  return given == first;
}

void read_product(Reading& reading, const JsonNode& value, Constant::Rule& out) {
  const std::vector<JsonNode> words = value.elements();
  if (words.size() % 2 == 0) reading.fault(value.pointer(), "ends with an operator");
  bool multiplies = true;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k % 2 == 0)
      (multiplies ? out.mul : out.div).push_back(operand_in(reading, words[k], value.pointer()));
    else
      multiplies = operator_in(reading, words[k], "*", "/", value.pointer());
  }
}

Constant::Rule read_rule(Reading& reading, const JsonNode& node, bool last) {
  Constant::Rule out;
  const JsonNode condition = node["if"];
  if (const std::vector<JsonNode> words = condition.elements(); words.size() == 3) {
    out.conditional = true;
    out.left = operand_in(reading, words[0], condition.pointer());
    out.equal = operator_in(reading, words[1], "==", "!=", condition.pointer());
    out.right = operand_in(reading, words[2], condition.pointer());
  } else if (!condition && !last) {
    reading.fault(node.pointer(), "without \"if\" this rule always holds: those after it are never used");
  }
  if (node["value"].is_array()) read_product(reading, node["value"], out);
  return out;
}

}  // namespace

void read_constant_rules(Reading& reading) {
  for (auto& [name, constant] : reading.profile.constants) {
    const JsonNode first = reading.document["constants"][name]["first"];
    const std::vector<JsonNode> rules = first.elements();
    for (std::size_t i = 0; i < rules.size(); ++i)
      constant.rules.push_back(read_rule(reading, rules[i], i + 1 == rules.size()));
    if (!rules.empty() && rules.back().has("if"))
      reading.fault(first.pointer(), "the last rule needs no \"if\": else the constant may have no value");
  }
}

void read_constants(Reading& reading) {
  for (const JsonNode& node : reading.document["constants"].members()) read_constant(reading, node);
}

void read_units(Reading& reading) {
  for (const JsonNode& node : reading.document["units"].members()) {
    model::Unit out;
    out.base = model::base_named(node.text("base")).value_or(model::Base::rpm);
    out.mul = factors(reading, node["mul"]);
    out.div = factors(reading, node["div"]);
    reading.profile.units.emplace(node.key(), std::move(out));
  }
}

}  // namespace axisgate::profile
