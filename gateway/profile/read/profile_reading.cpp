// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile_reading.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "gateway/core/name_table.hpp"

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
  for (std::size_t slot = 0; slot < axes(); ++slot) {
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

bool Reading::needs_writable(const Object& object, const std::string& pointer) {
  if (!object.writable) fault(pointer, "object \"{}\" is read-only", object.name);
  const auto is_part = [&](const Object& other) {
    return other.part && other.writable && other.part->of == object.name;
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

bool Reading::needs_number(const Object& object, std::int64_t number, const std::string& pointer) {
  if (object.numbers().holds(number)) return true;
  fault(pointer, "{} does not fit object \"{}\": it takes {}", number, object.name, range_text(object.numbers()));
  return false;
}

std::string listed(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::vector<std::string> text_for_each_axis(Reading& reading, const JsonNode& node, std::string_view what) {
  std::vector<std::string> out;
  for (const std::string& axis : reading.profile.axes) {
    out.push_back(node.text(axis));
    if (out.back().empty()) reading.fault(node.pointer(), "a {} for axis \"{}\" is missing", what, axis);
  }
  return out;
}

std::optional<DataType> type_named(std::string_view name) {
  static constexpr auto kTypes = names_of<DataType>({{{1, false}, "u8"},
                                                     {{2, false}, "u16"},
                                                     {{4, false}, "u32"},
                                                     {{1, true}, "i8"},
                                                     {{2, true}, "i16"},
                                                     {{4, true}, "i32"}});
  return kTypes.named(name);
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
