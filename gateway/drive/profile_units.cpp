// Sections "constants" and "units".
#include <algorithm>
#include <nlohmann/json.hpp>

#include "gateway/drive/profile_reading.hpp"

namespace axisgate::drive {

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

std::vector<Factor> factors(Reading& reading, const json& node, std::string_view key, const std::string& pointer) {
  std::vector<Factor> out;
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
                              hint(name, keys_in(reading.profile.constants)));
      else if (!constant->second.from_drive && (!constant->second.min || constant->second.min->numerator() <= 0))
        reading.fault(at, "constant \"" + name + "\" is a factor: give it a \"range\" above 0");
      out.emplace_back(name);
    }
  }
  return out;
}

void check_operand(Reading& reading, const json& operand, const std::string& pointer) {
  if (whole(operand) || !operand.is_string()) return;
  const std::string name = operand;
  if (!reading.profile.constants.contains(name)) reading.names_object(name, pointer);
}

void check_operator(Reading& reading, const json& text, std::initializer_list<std::string_view> known,
                    const std::string& pointer) {
  if (!text.is_string() || std::find(known.begin(), known.end(), text.get_ref<const std::string&>()) == known.end())
    reading.fault(pointer, text.dump() + " is no operator here; use " + std::string(*known.begin()) + " or " +
                               std::string(*(known.end() - 1)));
}

}  // namespace

void check_constant_rules(Reading& reading) {
  const json* section = member(reading.document, "constants");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [name, node] : section->items()) {
    const json* rules = member(node, "first");
    if (rules == nullptr || !rules->is_array()) continue;
    const std::string pointer = pointer_to(pointer_to("/constants", name), "first");
    for (std::size_t i = 0; i < rules->size(); ++i) {
      const std::string at = pointer_to(pointer, i);
      const json* condition = member((*rules)[i], "if");
      if (condition != nullptr && condition->is_array() && condition->size() == 3) {
        check_operand(reading, (*condition)[0], pointer_to(at, "if"));
        check_operator(reading, (*condition)[1], {"==", "!="}, pointer_to(at, "if"));
        check_operand(reading, (*condition)[2], pointer_to(at, "if"));
      } else if (condition == nullptr && i + 1 < rules->size()) {
        reading.fault(at, "without \"if\" this rule always holds: those after it are never used");
      }
      const json* value = member((*rules)[i], "value");
      if (value == nullptr || !value->is_array()) continue;
      if (value->size() % 2 == 0) reading.fault(pointer_to(at, "value"), "ends with an operator");
      for (std::size_t k = 0; k < value->size(); ++k) {
        if (k % 2 == 0)
          check_operand(reading, (*value)[k], pointer_to(at, "value"));
        else
          check_operator(reading, (*value)[k], {"*", "/"}, pointer_to(at, "value"));
      }
    }
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
    Unit out;
    out.base = base_named(text_in(node, "base")).value_or(Base::rpm);
    out.mul = factors(reading, node, "mul", pointer);
    out.div = factors(reading, node, "div", pointer);
    reading.profile.units.emplace(name, std::move(out));
  }
}

}  // namespace axisgate::drive
