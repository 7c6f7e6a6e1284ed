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
    if (!out.standard) reading.fault(standard.pointer(), "is no exact number");
    if (out.required) reading.fault(node.pointer(), "\"required\" and \"default\" exclude each other");
  }
  if (const std::vector<JsonNode> range = node["range"].elements(); range.size() == 2) {
    out.min = range[0].rational();
    out.max = range[1].rational();
    if (!out.min || !out.max)
      reading.fault(node.pointer("range"), "must be two exact numbers");
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
void check_operand(Reading& reading, const JsonNode& node, const std::string& pointer) {
  if (node.whole() || node.rational() || !node.is_string()) return;
  const std::string name = node.text();
  const auto constant = reading.profile.constants.find(name);
  if (constant != reading.profile.constants.end()) {
    if (constant->second.from_drive)
      reading.fault(pointer, "constant \"{}\" is itself read from the drive: name the objects it comes from", name);
    return;
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
}

void check_operator(Reading& reading, const JsonNode& node, std::string_view first, std::string_view second,
                    const std::string& pointer) {
  if (node.text() != first && node.text() != second)
    reading.fault(pointer, "{} is no operator here; use {} or {}", node.dump(), first, second);
}

/// ["a", "==", 5], or ["a", "present"].
void check_condition(Reading& reading, const JsonNode& node) {
  const std::vector<JsonNode> words = node.elements();
  if (words.size() != 2 && words.size() != 3)
    return reading.fault(node.pointer(), "is no condition: write [\"a\", \"==\", 5] or [\"a\", \"present\"]");
  check_operand(reading, words[0], node.pointer());
  if (words.size() > 2) {
    check_operator(reading, words[1], "==", "!=", node.pointer());
    return check_operand(reading, words[2], node.pointer());
  }
  if (words[1].text() != "present") reading.fault(node.pointer(), "{} is no word here; use present", words[1].dump());
  if (!words[0].is_string() || words[0].rational() || reading.profile.constants.contains(words[0].text()))
    reading.fault(node.pointer(), "only an object can be present");
}

void check_rule(Reading& reading, const JsonNode& node, bool last) {
  for (const JsonNode& each : conditions_of(node)) check_condition(reading, each);
  if (!node.has("if") && !last)
    reading.fault(node.pointer(), "without \"if\" this rule always holds: those after it are never used");
  const JsonNode value = node["value"];
  const std::vector<JsonNode> words = value.elements();
  if (!words.empty() && words.size() % 2 == 0) reading.fault(value.pointer(), "ends with an operator");
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k % 2 == 0)
      check_operand(reading, words[k], value.pointer());
    else
      check_operator(reading, words[k], "*", "/", value.pointer());
  }
}

}  // namespace

void check_constant_rules(Reading& reading) {
  for (const JsonNode& constant : reading.document["constants"].members()) {
    const JsonNode first = constant["first"];
    const std::vector<JsonNode> rules = first.elements();
    for (std::size_t i = 0; i < rules.size(); ++i) check_rule(reading, rules[i], i + 1 == rules.size());
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
    out.inverse = node.flag("inverse", false);
    if (out.inverse && model::kind_of(out.base) != Kind::acceleration)
      reading.fault(node.pointer("inverse"), "only a ramp, in rpm/s or rps/s, can be counted as a time");
    reading.profile.units.emplace(node.key(), std::move(out));
  }
}

}  // namespace axisgate::profile
