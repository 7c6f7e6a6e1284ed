// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile_reading.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace axisgate::profile {

void Reading::fault(const std::string& pointer, std::string message) {
  const auto covers = [&](const SchemaFault& known) {
    return !known.pointer.empty() && pointer.starts_with(known.pointer) &&
           (pointer.size() == known.pointer.size() || pointer[known.pointer.size()] == '/');
  };
  const auto end = faults_.begin() + static_cast<std::ptrdiff_t>(from_schema_);
  if (std::any_of(faults_.begin(), end, covers)) return;
  const SchemaFault found{pointer, std::move(message)};
  if (std::ranges::find(faults_, found) == faults_.end()) faults_.push_back(found);
}

bool Reading::names_object(const std::string& object, const std::string& pointer) {
  for (std::size_t slot = 0; slot < profile.axes.size(); ++slot) {
    if (profile.find(object, static_cast<AxisSlot>(slot)) != nullptr) continue;
    std::vector<std::string> known;
    for (const Object& candidate : profile.objects) known.push_back(candidate.name);
    if (std::ranges::any_of(known, [&](const std::string& name) { return name.ends_with("." + object); }))
      fault(pointer, "there is no object \"{}.{}\", but one for another axis", profile.axes[slot], object);
    else
      fault(pointer, "unknown object \"{}\": not under /objects{}", object, did_you_mean(object, known));
    return false;
  }
  return true;
}

bool Reading::names_protocol(const std::string& protocol, const std::string& pointer) {
  if (profile.protocols.contains(protocol)) return true;
  fault(pointer, "protocol \"{}\" is not under /protocols{}", protocol,
        did_you_mean(protocol, keys_in(profile.protocols)));
  return false;
}

bool Reading::names_unit(const std::string& unit, const std::string& pointer) {
  if (profile.units.contains(unit)) return true;
  fault(pointer, "unknown unit \"{}\": not under /units{}", unit, did_you_mean(unit, keys_in(profile.units)));
  return false;
}

bool Reading::names_mode(std::int64_t mode, const std::string& pointer) {
  if (profile.modes.contains(static_cast<std::int16_t>(mode))) return true;
  fault(pointer, "mode {} is not under /modes", mode);
  return false;
}

const Constant* Reading::constant_named(const std::string& name, const std::string& pointer) {
  const auto at = profile.constants.find(name);
  if (at != profile.constants.end()) return &at->second;
  fault(pointer, "unknown constant \"{}\": not under /constants{}", name,
        did_you_mean(name, keys_in(profile.constants)));
  return nullptr;
}

bool Reading::needs_readable(const Object& object, const std::string& pointer, std::string_view consequence) {
  if (!object.readable) fault(pointer, "object \"{}\" cannot be read{}", object.name, consequence);
  return object.readable;
}

bool Reading::needs_whole(const Object& object, const std::string& pointer) {
  if (object.is_real) fault(pointer, "object \"{}\" is an f32: here it must be a whole number", object.name);
  return !object.is_real;
}

bool Reading::needs_writable(const Object& object, const std::string& pointer) {
  if (!object.writable) fault(pointer, "object \"{}\" is read-only", object.name);
  const auto is_part = [&](const Object& other) {
    return other.is_part() && other.writable && other.whole == object.name;
  };
  if (const auto part = std::ranges::find_if(profile.objects, is_part); part != profile.objects.end())
    fault(pointer, "object \"{}\" is written by its parts alone: \"{}\"", object.name, part->name);
  return object.writable;
}

bool Reading::needs_address(const Object& object, std::string_view protocol, const std::string& pointer) {
  if (object.place(protocol) != nullptr) return true;
  fault(pointer, "object \"{}\" has no address on {}", object.name, protocol);
  return false;
}

bool Reading::needs_number(const Object& object, std::int64_t number, const std::string& pointer,
                           std::string_view what) {
  if (object.numbers().holds(number)) return true;
  fault(pointer, "{}{} does not fit object \"{}\": it takes {}", what, number, object.name,
        range_text(object.numbers()));
  return false;
}

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

void Reading::value_fits(const WriteValue& value, const Object& object, const std::string& pointer, bool at_once) {
  if (const auto* literal = std::get_if<std::int64_t>(&value)) {
    if (object.is_real && *literal != 0)
      fault(pointer, "object \"{}\" is an f32: give it 0, or an amount with its unit", object.name);
    else
      needs_number(object, *literal, pointer, "the value ");
  }
  const auto* amount = std::get_if<model::Amount>(&value);
  if (amount == nullptr) return;
  const auto unit = profile.units.find(object.unit);
  if (unit == profile.units.end())
    fault(pointer, "object \"{}\" has no unit: give the raw number", object.name);
  else if (model::kind_of(unit->second.base) != model::kind_of(amount->base))
    fault(pointer, "this unit does not fit unit \"{}\" of object \"{}\"", object.unit, object.name);
  if (at_once && unit != profile.units.end() && waits_for_drive(profile, unit->second))
    fault(pointer,
          "unit \"{}\" of object \"{}\" counts by a constant of the drive: the amount cannot be converted before the "
          "drive was read",
          object.unit, object.name);
}

void Reading::write(const JsonNode& node, bool by_command, bool at_once) {
  values(node["value"]);
  const std::string at = node.pointer("value");
  each_named(node.text("write"), node.pointer("write"), [&](const Object& object) {
    needs_writable(object, node.pointer("write"));
    if (node.has("instead_of")) needs_whole(object, node.pointer("write"));
    for (const WriteValue& value : values_in(profile, node)) {
      if (!by_command && (std::holds_alternative<Quantity>(value) || std::holds_alternative<SetPositionValue>(value)))
        fault(at, "only a command can write what a client asked for");
      value_fits(value, object, at, at_once);
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
    if (!needs_whole(meant, node.pointer())) return;
    const std::int64_t all = (std::int64_t{1} << (8 * meant.size)) - 1;
    if (node.has("mask") && (mask <= 0 || mask > all))
      fault(node.pointer("mask"), "the mask does not fit object \"{}\" of {} bits", meant.name, 8 * meant.size);
    for (const std::int64_t value : condition_in(node).values) {
      if (mask == 0)
        needs_number(meant, value, at);
      else if ((value & ~mask) != 0)
        fault(at, "{} has bits outside the mask: this can never be", value);
    }
  });
}

std::string listed(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

void take_type(model::ObjectDef& object, std::string_view name) {
  constexpr std::array<std::string_view, 7> kTypes{"u8", "u16", "u32", "i8", "i16", "i32", "f32"};
  const auto at = static_cast<std::size_t>(std::ranges::find(kTypes, name) - kTypes.begin());
  if (at == kTypes.size()) return;
  object.is_real = kTypes[at] == "f32";
  object.is_signed = at >= 3;
  object.size = static_cast<std::uint8_t>(object.is_real ? 4U : 1U << at % 3);
}

model::Nvm nvm_named(std::string_view name) {
  return name == "no" ? model::Nvm::no : name == "yes" ? model::Nvm::yes : model::Nvm::unknown;
}

bool waits_for_drive(const Profile& profile, const model::Unit& unit) {
  const auto waits = [&](const model::Factor& factor) {
    const auto* name = std::get_if<std::string>(&factor);
    const auto constant = name == nullptr ? profile.constants.end() : profile.constants.find(*name);
    return constant != profile.constants.end() && constant->second.from_drive;
  };
  return std::ranges::any_of(unit.mul, waits) || std::ranges::any_of(unit.div, waits);
}

std::string range_text(const Range& range) { return fmt::format("{} to {}", range.min, range.max); }

}  // namespace axisgate::profile
