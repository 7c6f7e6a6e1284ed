// SPDX-License-Identifier: Apache-2.0
// How values, writes and conditions are judged, wherever they stand.
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

std::optional<model::Amount> Reading::amount(const JsonNode& node) {
  std::optional<model::Amount> out = amount_in(node);
  if (!out && node.text().find(' ') != std::string::npos)
    fault(node.pointer(), "unknown unit in \"{}\": use rpm, rps, rpm/s, rps/s, rev, Arms, %, degC or V", node.text());
  const auto* name = out ? std::get_if<std::string>(&out->number) : nullptr;
  const Constant* constant = name == nullptr ? nullptr : constant_named(*name, node.pointer());
  if (constant != nullptr && constant->from_drive)
    fault(node.pointer(), "constant \"{}\" is read from the drive: no amount can be told by it beforehand", *name);
  return out;
}

void Reading::values(const JsonNode& node) {
  if (!node) return;
  for (const std::string& axis : profile.axes) {
    const JsonNode own = of_axis(node, axis);
    if (own.is_string()) {
      amount(own);
    } else if (const std::optional<std::string> name = own.string("quantity")) {
      const WriteValue value = value_in(own);
      const auto* quantity = std::get_if<Quantity>(&value);
      if (std::holds_alternative<std::monostate>(value))
        fault(own.pointer("quantity"), "\"{}\" is no quantity of the unified axis", *name);
      else if (quantity != nullptr && profile.find(*quantity) == nullptr)
        fault(own.pointer("quantity"), "this profile has no quantity \"{}\"", *name);
    } else if (!own.whole()) {
      fault(node.pointer(), "a value for axis \"{}\" is missing", axis);
    }
  }
}

void Reading::value_fits(const WriteValue& value, const Object& object, const std::string& pointer) {
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

void Reading::value_known(const WriteValue& value, const Object& object, const std::string& pointer) {
  if (!std::holds_alternative<model::Amount>(value)) return;
  const auto unit = profile.units.find(object.unit);
  if (unit != profile.units.end() && waits_for_drive(profile, unit->second))
    fault(pointer,
          "unit \"{}\" of object \"{}\" counts by a constant of the drive: the amount cannot be converted before the "
          "drive was read",
          object.unit, object.name);
}

void Reading::write(const JsonNode& node, bool by_command) {
  values(node["value"]);
  const std::string at = node.pointer("value");
  each_named(node.text("write"), node.pointer("write"), [&](const Object& object) {
    needs_writable(object, node.pointer("write"));
    for (const WriteValue& value : values_in(profile, node)) {
      if (!by_command && (std::holds_alternative<Quantity>(value) || std::holds_alternative<SetPositionValue>(value)))
        fault(at, "only a command can write what a client asked for");
      value_fits(value, object, at);
      if (by_command) value_known(value, object, at);
    }
    for (const std::string& protocol : node.names("on"))
      if (names_protocol(protocol, node.pointer("on"))) needs_address(object, protocol, node.pointer("on"));
  });
}

/// Compared with a constant: what it may be must be possible.
void Reading::by_constant(const JsonNode& node, std::int64_t mask) {
  const std::string name = node.text("constant");
  const Constant* constant = constant_named(name, node.pointer());
  if (constant == nullptr) return;
  if (constant->from_drive)
    return fault(node.pointer(), "constant \"{}\" is read from the drive: no condition can wait for it", name);
  const auto most = constant->max ? constant->max->scale(node.whole("times", 1)) : std::nullopt;
  if (most && mask != 0 && (*most & ~mask) != 0)
    fault(node.pointer(), "{} has bits outside the mask: this can never be", *most);
}

void Reading::condition(const JsonNode& node, std::string_view object) {
  if (!node.is_object()) return;
  const std::int64_t mask = node.whole("mask", 0);
  int tests = 0;
  std::string at = node.pointer();
  for (const char* key : {"equals", "not_equals", "in", "not_in"}) {
    if (!node.has(key)) continue;
    ++tests;
    at = node.pointer(key);
    if (node[key].is_object()) by_constant(node[key], mask);
  }
  if (tests != 1)
    fault(node.pointer(), "a condition needs exactly one of \"equals\", \"not_equals\", \"in\", \"not_in\"");
  each_named(node.text(object), node.pointer(), [&](const Object& meant) {
    needs_readable(meant, node.pointer(), ", so no condition can look at it");
    const std::int64_t all = (std::int64_t{1} << (8 * meant.type.size)) - 1;
    if (node.has("mask") && (mask <= 0 || mask > all))
      fault(node.pointer("mask"), "the mask does not fit object \"{}\" of {} bits", meant.name, 8 * meant.type.size);
    for (const std::int64_t value : condition_in(node).values) {
      if (mask == 0)
        needs_number(meant, value, at);
      else if ((value & ~mask) != 0)
        fault(at, "{} has bits outside the mask: this can never be", value);
    }
  });
}

}  // namespace axisgate::profile
