// SPDX-License-Identifier: Apache-2.0
// Section "quantities": which object each quantity of the unified axis is had from.
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
    field.object = entry.text("object");
    field.from = static_cast<std::uint8_t>(entry.whole("from", 0));
    field.count = static_cast<std::uint8_t>(entry.whole("count", 1));
    field.to = static_cast<std::uint8_t>(entry.whole("to", 0));
    field.inverted = entry.flag("inverted", false);
    reading.each_named(field.object, entry.pointer("object"), [&](const Object& object) {
      reading.needs_readable(object, entry.pointer());
      if (field.from + field.count > 8 * object.type.size)
        reading.fault(entry.pointer(), "reaches beyond the {} bits of object \"{}\"", 8 * object.type.size,
                      object.name);
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
  if (quantity.kind == Kind::code) {
    if (!spec.units.empty())
      reading.fault(pointer_to(spec.pointer, "unit"), "\"{}\" is a code and has no unit", quantity.name);
    return;
  }
  if (name.empty()) {
    if (!spec.units.empty()) return;  // told by read_units()
    return reading.fault(spec.pointer, "\"{}\" needs a unit: give object \"{}\" one, or the quantity itself",
                         quantity.name, object.name);
  }
  const auto unit = reading.profile.units.find(name);
  if (unit == reading.profile.units.end()) return;
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
  const bool target = spec.quantity == Quantity::target_position || spec.quantity == Quantity::target_velocity ||
                      spec.quantity == Quantity::target_torque;
  if (target && !object.writable)
    reading.fault(spec.pointer,
                  "object \"{}\" is read-only, so nothing can be asked by it: say \"access\": \"rw\", or "
                  "take the quantity out",
                  object.name);
  check_unit(reading, spec, object);
}

/// "unit": one for all motors, or one for each.
void read_units(Reading& reading, const JsonNode& unit, QuantitySpec& out) {
  if (unit.is_string()) out.units = {unit.text()};
  if (unit.is_object()) out.units = text_for_each_axis(reading, unit, "unit");
  for (const std::string& name : out.units)
    if (!name.empty()) reading.names_unit(name, unit.pointer());
}

void read_limits(Reading& reading, const JsonNode& limits, QuantitySpec& out) {
  const std::vector<JsonNode> ends = limits.elements();
  if (ends.size() != 2) return;
  out.min = reading.amount(ends[0]);
  out.max = reading.amount(ends[1]);
  for (const std::optional<model::Amount>& limit : {out.min, out.max})
    if (limit && model::kind_of(limit->base) != row(out.quantity).kind)
      reading.fault(limits.pointer(), "the limits are in a unit that does not fit the quantity");
  const auto* low = out.min ? std::get_if<Rational>(&out.min->number) : nullptr;
  const auto* high = out.max ? std::get_if<Rational>(&out.max->number) : nullptr;
  if (low != nullptr && high != nullptr && out.min->base == out.max->base) {
    const double from = low->to_double() * (out.min->negative ? -1 : 1);
    const double to = high->to_double() * (out.max->negative ? -1 : 1);
    if (from > to) reading.fault(limits.pointer(), "the first limit is above the second");
  }
}

/// They count one and the same way; where one of them was copied wrongly, a move would end elsewhere.
void check_positions_alike(Reading& reading) {
  const QuantitySpec* actual = reading.profile.find(Quantity::position_actual);
  const QuantitySpec* target = reading.profile.find(Quantity::target_position);
  if (actual == nullptr || target == nullptr) return;
  reading.each_object_of(Quantity::position_actual, [&](const Object& read) {
    reading.each_object_of(Quantity::target_position, [&](const Object& written) {
      if (actual->unit_of(read) != target->unit_of(written)) return;
      if (read.type.size < written.type.size)
        reading.fault(actual->pointer, "object \"{}\" has {} bits and \"{}\" {}: one of the two has the wrong \"type\"",
                      read.name, 8 * read.type.size, written.name, 8 * written.type.size);
      if (!read.type.is_signed && written.type.is_signed)
        reading.fault(actual->pointer,
                      "object \"{}\" has no sign and \"{}\" has one: one of the two has the wrong "
                      "\"type\"",
                      read.name, written.name);
    });
  });
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
    read_units(reading, node["unit"], out);
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

}  // namespace axisgate::profile
