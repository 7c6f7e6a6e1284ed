// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile_reading.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace axisgate::profile {

using nlohmann::json;

void Reading::fault(const std::string& pointer, std::string message) {
  const auto covers = [&](const SchemaFault& known) {
    return !known.pointer.empty() && pointer.starts_with(known.pointer) &&
           (pointer.size() == known.pointer.size() || pointer[known.pointer.size()] == '/');
  };
  const auto end = faults_.begin() + static_cast<std::ptrdiff_t>(from_schema_);
  if (std::any_of(faults_.begin(), end, covers)) return;
  const SchemaFault found{pointer, std::move(message)};
  if (std::find(faults_.begin(), faults_.end(), found) == faults_.end()) faults_.push_back(found);
}

bool Reading::names_object(const std::string& object, const std::string& pointer) {
  for (std::size_t slot = 0; slot < axes(); ++slot) {
    if (profile.find(object, static_cast<AxisSlot>(slot)) != nullptr) continue;
    std::vector<std::string> known;
    for (const Object& candidate : profile.objects) known.push_back(candidate.name);
    const bool some =
        std::any_of(known.begin(), known.end(), [&](const std::string& name) { return name.ends_with("." + object); });
    fault(pointer, some ? "there is no object \"" + profile.axes[slot] + "." + object + "\", but one for another axis"
                        : "unknown object \"" + object + "\": not under /objects" + did_you_mean(object, known));
    return false;
  }
  return true;
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

const json* member(const json& node, std::string_view key) {
  if (!node.is_object()) return nullptr;
  const auto at = node.find(key);
  return at == node.end() ? nullptr : &*at;
}

std::string text_in(const json& node, std::string_view key) {
  const json* found = member(node, key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

bool flag_in(const json& node, std::string_view key, bool otherwise) {
  const json* found = member(node, key);
  return found != nullptr && found->is_boolean() ? found->get<bool>() : otherwise;
}

std::optional<std::int64_t> whole(const json& node) {
  if (node.is_number_unsigned() && node.get<std::uint64_t>() > INT64_MAX) return std::nullopt;
  if (node.is_number_integer()) return node.get<std::int64_t>();
  if (!node.is_string()) return std::nullopt;
  std::string_view text = node.get_ref<const std::string&>();
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const bool hex = text.starts_with("0x");
  if (hex) text.remove_prefix(2);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
  if (error != std::errc{} || end != text.data() + text.size() || value < 0) return std::nullopt;
  return negative ? -value : value;
}

std::int64_t whole_in(const json& node, std::string_view key, std::int64_t otherwise) {
  const json* found = member(node, key);
  return found == nullptr ? otherwise : whole(*found).value_or(otherwise);
}

std::vector<std::string> names_in(const json& node, std::string_view key) {
  std::vector<std::string> out;
  const json* found = member(node, key);
  if (found == nullptr) return out;
  if (found->is_string()) return {found->get<std::string>()};
  if (found->is_array())
    for (const json& name : *found)
      if (name.is_string()) out.push_back(name);
  return out;
}

std::optional<DataType> type_named(std::string_view name) {
  if (name.size() < 2 || (name[0] != 'u' && name[0] != 'i')) return std::nullopt;
  const std::string_view bits = name.substr(1);
  const bool is_signed = name[0] == 'i';
  if (bits == "8") return DataType{1, is_signed};
  if (bits == "16") return DataType{2, is_signed};
  if (bits == "32") return DataType{4, is_signed};
  return std::nullopt;
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
  return std::any_of(unit.mul.begin(), unit.mul.end(), waits) || std::any_of(unit.div.begin(), unit.div.end(), waits);
}

std::string range_text(const Range& range) { return std::to_string(range.min) + " to " + std::to_string(range.max); }

}  // namespace axisgate::profile
