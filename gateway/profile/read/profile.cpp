// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile.hpp"

#include <algorithm>

namespace axisgate::profile {

const Place* Object::place(std::string_view protocol) const {
  const auto at = places.find(protocol);
  return at == places.end() ? nullptr : &at->second;
}

const std::string& QuantitySpec::unit_of(const Object& object) const {
  if (units.empty()) return object.unit;
  return object.slot < units.size() ? units[object.slot] : units.front();
}

WriteValue value_in(const JsonNode& node) {
  if (const std::optional<std::int64_t> number = node.whole()) return *number;
  if (std::optional<model::Amount> amount = amount_in(node)) return *std::move(amount);
  const std::string quantity = node.text("quantity");
  if (quantity == "set_position_value") return SetPositionValue{};
  if (const std::optional<Quantity> known = quantity_named(quantity)) return *known;
  return {};
}

std::optional<model::Amount> amount_in(const JsonNode& node) {
  const std::string whole_text = node.text();
  std::string_view text = whole_text;
  model::Amount out;
  out.negative = text.starts_with('-');
  if (out.negative) text.remove_prefix(1);
  const std::size_t space = text.find(' ');
  const auto base = space == std::string_view::npos ? std::nullopt : model::base_named(text.substr(space + 1));
  if (!base) return std::nullopt;
  out.base = *base;
  out.number = std::string(text.substr(0, space));
  if (const auto exact = Rational::parse(std::get<std::string>(out.number))) out.number = *exact;
  return out;
}

model::Condition condition_in(const JsonNode& node) {
  using enum model::Condition::Test;
  model::Condition out;
  out.mask = static_cast<std::uint32_t>(node.whole("mask", 0));
  for (const auto& [key, test] : {std::pair("equals", equals), std::pair("not_equals", not_equals), std::pair("in", in),
                                  std::pair("not_in", not_in)}) {
    if (!node.has(key)) continue;
    out.test = test;
    out.values = node.wholes(key);
  }
  return out;
}

std::vector<JsonNode> conditions_of(const JsonNode& rule) {
  std::vector<JsonNode> out = rule["if"].elements();
  return out.empty() || out[0].is_array() ? out : std::vector<JsonNode>{rule["if"]};
}

JsonNode of_axis(const JsonNode& node, const std::string& axis) { return node.has(axis) ? node[axis] : node; }

std::vector<WriteValue> values_in(const Profile& profile, const JsonNode& write) {
  std::vector<WriteValue> out;
  for (const std::string& axis : profile.axes)
    if (const WriteValue value = value_in(of_axis(write["value"], axis));
        !std::holds_alternative<std::monostate>(value))
      out.push_back(value);
  return out;
}

bool is_on(const JsonNode& node, std::string_view protocol) {
  const std::vector<std::string> on = node.names("on");
  return on.empty() || std::ranges::find(on, protocol) != on.end();
}

JsonNode Profile::section(std::string_view key) const { return JsonNode(*document, "")[key]; }

std::optional<std::size_t> IdentitySpec::other_in(const std::array<std::optional<std::uint32_t>, 4>& found) const {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!numbers[i].empty() && found[i] && std::ranges::find(numbers[i], *found[i]) == numbers[i].end()) return i;
  return std::nullopt;
}

const Object* Profile::find(std::string_view object, AxisSlot motor) const {
  const std::string own = motor < axes.size() ? axes[motor] + "." + std::string(object) : std::string();
  const Object* of_drive = nullptr;
  for (const Object& candidate : objects) {
    if (candidate.name == own) return &candidate;
    if (candidate.name == object) of_drive = &candidate;
  }
  return of_drive;
}

const QuantitySpec* Profile::find(Quantity quantity) const {
  const auto at = std::ranges::find(quantities, quantity, &QuantitySpec::quantity);
  return at == quantities.end() ? nullptr : &*at;
}

std::vector<Ask> Profile::open_asks(const std::map<std::string, Rational>& configured) const {
  std::vector<Ask> out = asks;
  std::erase_if(out, [&](const Ask& ask) {
    const auto constant = constants.find(ask.of);
    return constant != constants.end() &&
           (constant->second.standard || constant->second.from_drive || configured.contains(ask.of));
  });
  return out;
}

namespace {

/// On any motor.
bool counts_by(const Profile& profile, std::string_view protocol, const QuantitySpec& spec,
               const std::string& constant) {
  const auto is_it = [&](const model::Factor& factor) {
    const auto* name = std::get_if<std::string>(&factor);
    return name != nullptr && *name == constant;
  };
  for (const std::string& name : spec.objects)
    for (std::size_t motor = 0; motor < profile.axes.size(); ++motor) {
      const Object* object = profile.find(name, static_cast<AxisSlot>(motor));
      const bool has = object != nullptr && object->place(protocol) != nullptr;
      const auto unit = has ? profile.units.find(spec.unit_of(*object)) : profile.units.end();
      if (unit == profile.units.end()) continue;
      if (std::ranges::any_of(unit->second.mul, is_it) || std::ranges::any_of(unit->second.div, is_it)) return true;
    }
  return false;
}

}  // namespace

std::vector<WantedConstant> Profile::wanted(std::string_view protocol,
                                            const std::map<std::string, Rational>& configured) const {
  std::vector<WantedConstant> out;
  for (const auto& [key, constant] : constants) {
    if (constant.standard || constant.from_drive || configured.contains(key)) continue;
    WantedConstant one{key, constant.text, {}};
    for (const QuantitySpec& spec : quantities)
      if (counts_by(*this, protocol, spec, key)) one.quantities.push_back(spec.quantity);
    std::ranges::sort(one.quantities);
    if (constant.required || !one.quantities.empty()) out.push_back(std::move(one));
  }
  return out;
}

std::vector<AxisSlot> Profile::shared() const {
  const std::vector<std::string> names = JsonNode(*document, "").names("shared");
  std::vector<AxisSlot> out;
  for (std::size_t slot = 0; slot < axes.size(); ++slot)
    if (std::ranges::find(names, axes[slot]) != names.end()) out.push_back(static_cast<AxisSlot>(slot));
  return out;
}

bool Profile::has_emergency_word(std::string_view protocol) const {
  const std::vector<std::string> words = fault_words();
  return protocol == "canopen" && std::ranges::find(words, kEmergencyWord) != words.end();
}

}  // namespace axisgate::profile
