// SPDX-License-Identifier: Apache-2.0
// Sections "constants", "units" and "quantities": which object each quantity of the unified axis is had from, and in
// what it counts.
#include "gateway/core/name_table.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr auto kPollClasses = names_of<model::PollClass>({{model::PollClass::fast, "fast"},
                                                          {model::PollClass::normal, "normal"},
                                                          {model::PollClass::slow, "slow"},
                                                          {model::PollClass::once, "once"}});

bool may_be_composed(Quantity quantity) {
  return quantity == Quantity::digital_inputs || quantity == Quantity::digital_outputs ||
         quantity == Quantity::vendor_error;
}

void read_bits(Reading& reading, const JsonNode& list, QuantitySpec& out) {
  if (!list.is_array()) return;
  if (!may_be_composed(out.quantity))
    reading.fault(list.pointer(), "only digital_inputs, digital_outputs and vendor_error can be composed of bits");
  const std::uint64_t width = row(out.quantity).type == RegisterType::u32 ? 32 : 16;
  std::uint64_t taken = 0;
  for (const JsonNode& entry : list.elements()) {
    BitsSpec& field = out.bits.emplace_back();
    field.name = entry.text("object");
    field.from = static_cast<std::uint8_t>(entry.whole("from", 0));
    field.count = static_cast<std::uint8_t>(entry.whole("count", 1));
    field.to = static_cast<std::uint8_t>(entry.whole("to", 0));
    field.inverted = entry.flag("inverted", false);
    reading.each_named(field.name, entry.pointer("object"), [&](const Object& object) {
      reading.needs_readable(object, entry.pointer());
      reading.needs_whole(object, entry.pointer());
      if (field.from + field.count > 8 * object.size)
        reading.fault(entry.pointer(), "reaches beyond the {} bits of object \"{}\"", 8 * object.size, object.name);
    });
    if (field.to + std::uint64_t{field.count} > width) {
      reading.fault(entry.pointer(), "reaches beyond the {} bits of the quantity", width);
    } else {
      const std::uint64_t mine = ((std::uint64_t{1} << field.count) - 1) << field.to;
      if ((taken & mine) != 0) reading.fault(entry.pointer(), "overlaps bits of another row of this quantity");
      taken |= mine;
    }
  }
}

void check_unit(Reading& reading, const QuantitySpec& spec, const Object& object) {
  const std::string& name = spec.unit_of(object);
  const QuantityRow& quantity = row(spec.quantity);
  if (quantity.kind == Kind::code || quantity.kind == Kind::position) reading.needs_whole(object, spec.pointer);
  if (quantity.kind == Kind::code) {
    if (!spec.units.empty())
      reading.fault(pointer_to(spec.pointer, "unit"), "\"{}\" is a code and has no unit", quantity.name);
    return;
  }
  if (name.empty()) {
    if (!spec.units.empty()) return;  // told by read_units_of_motors()
    return reading.fault(spec.pointer, "\"{}\" needs a unit: give object \"{}\" one, or the quantity itself",
                         quantity.name, object.name);
  }
  const auto unit = reading.profile.units.find(name);
  if (unit == reading.profile.units.end()) return;
  if (unit->second.inverse) reading.needs_whole(object, spec.pointer);
  if (spec.quantity == Quantity::position_actual && unit->second.mul.empty() && unit->second.div.empty())
    reading.fault(spec.pointer,
                  "by unit \"{}\" one count would be a whole turn: give the unit \"mul\", the counts of a turn, as a "
                  "number or a constant",
                  name);
  if (model::kind_of(unit->second.base) != quantity.kind)
    reading.fault(spec.pointer, "unit \"{}\" does not fit \"{}\", whose registers count in {}", name, quantity.name,
                  unit_text(quantity.kind));
}

void check_object(Reading& reading, const QuantitySpec& spec, const Object& object) {
  if (!row(spec.quantity).writable) reading.needs_readable(object, spec.pointer, ", so no value can come from it");
  if (is_target(spec.quantity) && !object.writable)
    reading.fault(spec.pointer,
                  "object \"{}\" is read-only, so nothing can be asked by it: say \"access\": \"rw\", or "
                  "take the quantity out",
                  object.name);
  if (object.is_directed() && row(spec.quantity).kind == Kind::position)
    reading.fault(spec.pointer, "object \"{}\" has its direction beside it: a position has a sign of its own",
                  object.name);
  check_unit(reading, spec, object);
}

/// "unit": one for all motors, or one for each.
void read_units_of_motors(Reading& reading, const JsonNode& unit, QuantitySpec& out) {
  if (!unit) return;
  for (const std::string& axis : reading.profile.axes) {
    const std::string& name = out.units.emplace_back(of_axis(unit, axis).text());
    if (name.empty())
      reading.fault(unit.pointer(), "a unit for axis \"{}\" is missing", axis);
    else
      reading.names_unit(name, unit.pointer());
  }
}

void read_limits(Reading& reading, const JsonNode& limits, QuantitySpec& out) {
  const std::vector<JsonNode> ends = limits.elements();
  if (ends.size() != 2) return;
  out.min = reading.amount(ends[0]);
  out.max = reading.amount(ends[1]);
  for (const std::optional<model::Amount>& limit : {out.min, out.max})
    if (limit && model::kind_of(limit->base) != row(out.quantity).kind)
      reading.fault(limits.pointer(), "the limits are in a unit that does not fit the quantity");
  const auto end = [](const std::optional<model::Amount>& limit) {
    return limit ? model::in_registers(*limit, {}, Rational(1)) : std::nullopt;
  };
  const std::optional<Rational> low = end(out.min), high = end(out.max);
  if (low && high && low->to_double() > high->to_double())
    reading.fault(limits.pointer(), "the first limit is above the second");
}

/// They count one and the same way; where one of them was copied wrongly, a move would end elsewhere.
void check_positions_alike(Reading& reading) {
  const QuantitySpec* actual = reading.profile.find(Quantity::position_actual);
  const QuantitySpec* target = reading.profile.find(Quantity::target_position);
  if (actual == nullptr || target == nullptr) return;
  reading.each_object_of(Quantity::position_actual, [&](const Object& read) {
    reading.each_object_of(Quantity::target_position, [&](const Object& written) {
      if (actual->unit_of(read) != target->unit_of(written)) return;
      if (read.size < written.size)
        reading.fault(actual->pointer, "object \"{}\" has {} bits and \"{}\" {}: one of the two has the wrong \"type\"",
                      read.name, 8 * read.size, written.name, 8 * written.size);
      if (!read.is_signed && written.is_signed)
        reading.fault(actual->pointer,
                      "object \"{}\" has no sign and \"{}\" has one: one of the two has the wrong "
                      "\"type\"",
                      read.name, written.name);
    });
  });
}

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
  if (node.rational() || !node.is_string()) return;
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
    reading.needs_whole(object, pointer);
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

void read_quantities(Reading& reading) {
  for (const QuantityRow& known : quantity_table()) {  // in the order of their numbers
    const JsonNode node = reading.document["quantities"][known.name];
    if (!node.is_object()) continue;
    QuantitySpec out;
    out.quantity = known.quantity;
    out.pointer = node.pointer();
    out.objects = node.names("object");
    out.poll = kPollClasses.named(node.text("poll"));
    read_units_of_motors(reading, node["unit"], out);
    if (out.objects.empty() != node.has("bits"))
      reading.fault(out.pointer, "a quantity needs either \"object\" or \"bits\"");
    for (const std::string& name : out.objects)
      reading.each_named(name, node.pointer("object"),
                         [&](const Object& object) { check_object(reading, out, object); });
    read_bits(reading, node["bits"], out);
    read_limits(reading, node["limits"], out);
    out.commanded = node.flag("commanded", false);
    if (out.commanded && out.quantity != Quantity::position_actual)
      reading.fault(node.pointer("commanded"), "only position_actual can be said to be commanded");
    reading.profile.quantities.push_back(std::move(out));
  }
  check_positions_alike(reading);
}

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
