// SPDX-License-Identifier: Apache-2.0
// Section "quantities": which object each quantity of the unified axis is had from.
#include <nlohmann/json.hpp>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

std::optional<model::PollClass> poll_named(const std::string& name) {
  if (name == "fast") return model::PollClass::fast;
  if (name == "normal") return model::PollClass::normal;
  if (name == "slow") return model::PollClass::slow;
  if (name == "once") return model::PollClass::once;
  return std::nullopt;
}

bool may_be_composed(Quantity quantity) {
  return quantity == Quantity::digital_inputs || quantity == Quantity::digital_outputs ||
         quantity == Quantity::vendor_error;
}

void read_bits(Reading& reading, const json& node, QuantitySpec& out) {
  const json* fields = member(node, "bits");
  if (fields == nullptr || !fields->is_array()) return;
  const std::string pointer = pointer_to(out.pointer, "bits");
  if (!may_be_composed(out.quantity))
    reading.fault(pointer, "only digital_inputs, digital_outputs and vendor_error can be composed of bits");
  const std::uint64_t width = row(out.quantity).type == RegisterType::u32 ? 32 : 16;
  std::uint64_t taken = 0;
  for (std::size_t i = 0; i < fields->size(); ++i) {
    const json& entry = (*fields)[i];
    const std::string at = pointer_to(pointer, i);
    BitsSpec field;
    field.object = text_in(entry, "object");
    field.from = static_cast<std::uint8_t>(whole_in(entry, "from", 0));
    field.count = static_cast<std::uint8_t>(whole_in(entry, "count", 1));
    field.to = static_cast<std::uint8_t>(whole_in(entry, "to", 0));
    field.inverted = flag_in(entry, "inverted", false);
    if (reading.names_object(field.object, pointer_to(at, "object"))) {
      reading.each_meaning(field.object, [&](const Object& object) {
        if (!object.readable) reading.fault(at, "object \"" + object.name + "\" cannot be read");
        if (field.from + field.count > 8 * object.type.size)
          reading.fault(at, "reaches beyond the " + std::to_string(8 * object.type.size) + " bits of object \"" +
                                object.name + "\"");
      });
    }
    if (field.to + std::uint64_t{field.count} > width) {
      reading.fault(at, "reaches beyond the " + std::to_string(width) + " bits of the quantity");
    } else {
      const std::uint64_t mine = ((std::uint64_t{1} << field.count) - 1) << field.to;
      if ((taken & mine) != 0) reading.fault(at, "overlaps bits of another row of this quantity");
      taken |= mine;
    }
    out.bits.push_back(std::move(field));
  }
}

void check_unit(Reading& reading, const QuantitySpec& spec, const Object& object) {
  const std::string& name = spec.unit_of(object);
  const Kind kind = row(spec.quantity).kind;
  const std::string quantity(row(spec.quantity).name);
  if (kind == Kind::code) {
    if (!spec.units.empty())
      reading.fault(pointer_to(spec.pointer, "unit"), "\"" + quantity + "\" is a code and has no unit");
    return;
  }
  if (name.empty()) {
    if (!spec.units.empty()) return;  // told by read_units()
    reading.fault(spec.pointer,
                  "\"" + quantity + "\" needs a unit: give object \"" + object.name + "\" one, or the quantity itself");
    return;
  }
  const auto unit = reading.profile.units.find(name);
  if (unit != reading.profile.units.end() && model::kind_of(unit->second.base) != kind)
    reading.fault(spec.pointer, "unit \"" + name + "\" does not fit \"" + quantity + "\", whose registers count in " +
                                    std::string(unit_text(kind)));
}

void check_object(Reading& reading, const QuantitySpec& spec, const Object& object) {
  const bool writable = row(spec.quantity).writable;
  if (!writable && !object.readable)
    reading.fault(spec.pointer, "object \"" + object.name + "\" cannot be read, so no value can come from it");
  check_unit(reading, spec, object);
}

/// "unit": one for all motors, or one for each.
void read_units(Reading& reading, const json& node, QuantitySpec& out) {
  const json* unit = member(node, "unit");
  if (unit == nullptr) return;
  const std::string pointer = pointer_to(out.pointer, "unit");
  if (unit->is_string()) out.units = {unit->get<std::string>()};
  if (unit->is_object()) {
    for (const std::string& axis : reading.profile.axes) {
      out.units.push_back(text_in(*unit, axis));
      if (out.units.back().empty()) reading.fault(pointer, "a unit for axis \"" + axis + "\" is missing");
    }
  }
  for (const std::string& name : out.units)
    if (!name.empty() && !reading.profile.units.contains(name))
      reading.fault(pointer, "unknown unit \"" + name + "\": not under /units" +
                                 did_you_mean(name, keys_in(reading.profile.units)));
}

void read_limits(Reading& reading, const json& node, QuantitySpec& out) {
  const json* limits = member(node, "limits");
  if (limits == nullptr || !limits->is_array() || limits->size() != 2) return;
  const std::string pointer = pointer_to(out.pointer, "limits");
  out.min = reading.amount((*limits)[0], pointer_to(pointer, 0));
  out.max = reading.amount((*limits)[1], pointer_to(pointer, 1));
  const Kind kind = row(out.quantity).kind;
  for (const std::optional<model::Amount>& limit : {out.min, out.max})
    if (limit && model::kind_of(limit->base) != kind)
      reading.fault(pointer, "the limits are in a unit that does not fit the quantity");
  const auto* low = out.min ? std::get_if<Rational>(&out.min->number) : nullptr;
  const auto* high = out.max ? std::get_if<Rational>(&out.max->number) : nullptr;
  if (low != nullptr && high != nullptr && out.min->base == out.max->base) {
    const double from = low->to_double() * (out.min->negative ? -1 : 1);
    const double to = high->to_double() * (out.max->negative ? -1 : 1);
    if (from > to) reading.fault(pointer, "the first limit is above the second");
  }
}

}  // namespace

void read_quantities(Reading& reading) {
  const json* section = member(reading.document, "quantities");
  if (section == nullptr || !section->is_object()) return;
  for (const QuantityRow& known : quantity_table()) {  // in the order of their numbers
    const json* node = member(*section, known.name);
    if (node == nullptr || !node->is_object()) continue;
    QuantitySpec out;
    out.quantity = known.quantity;
    out.pointer = pointer_to("/quantities", known.name);
    out.objects = names_in(*node, "object");
    out.poll = poll_named(text_in(*node, "poll"));
    read_units(reading, *node, out);
    if (out.objects.empty() == (member(*node, "bits") == nullptr))
      reading.fault(out.pointer, "a quantity needs either \"object\" or \"bits\"");
    for (const std::string& name : out.objects)
      if (reading.names_object(name, pointer_to(out.pointer, "object")))
        reading.each_meaning(name, [&](const Object& object) { check_object(reading, out, object); });
    read_bits(reading, *node, out);
    read_limits(reading, *node, out);
    out.commanded = flag_in(*node, "commanded", false);
    if (out.commanded && out.quantity != Quantity::position_actual)
      reading.fault(pointer_to(out.pointer, "commanded"), "only position_actual can be said to be commanded");
    reading.profile.quantities.push_back(std::move(out));
  }
}

}  // namespace axisgate::profile
