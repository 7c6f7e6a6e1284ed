// SPDX-License-Identifier: Apache-2.0
// resolve(): what this version can do, constants, objects, and how names, values and units become the model's.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "gateway/core/nearest.hpp"
#include "gateway/model/real32.hpp"
#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/read/profile_reading.hpp"
#include "gateway/profile/resolve/profile_resolving.hpp"

namespace axisgate::profile {
namespace {

void check_protocol(Resolving& r) {
  const std::string& protocol = r.input.protocol;
  if (r.profile.protocols.contains(protocol)) return;
  r.fault("/profile", fmt::format("profile \"{}\" has no protocol \"{}\": it has {}", r.profile.name, protocol,
                                  listed(keys_in(r.profile.protocols))));
}

/// Who says that the drive is one which its profile is not for has taken the wrong profile, or the wrong number.
void check_identity(Resolving& r) {
  if (!r.profile.identity) return;
  const std::optional<std::size_t> other = r.profile.identity->other_in(r.input.identity);
  if (!other) return;
  std::vector<std::string> own;
  for (const std::uint32_t number : r.profile.identity->numbers[*other]) own.push_back(fmt::format("{:#010x}", number));
  r.fault(fmt::format("/identity/{}", IdentitySpec::kNames[*other]),
          fmt::format("is {:#010x}, but profile \"{}\" is for {}: for this drive take its own maker's profile, "
                      "\"cia402-generic\", or one of yours that extends this with its own \"identity\"",
                      *r.input.identity[*other], r.profile.name, listed(own)));
}

/// A constant that decides a mode tells why there are no more of them.
std::string why_no_more(const Profile& profile, const std::string& name, const Constant& constant) {
  const JsonNode names = profile.section("configured_mode")["constant"];
  const auto decides = [&](const std::string& axis) { return of_axis(names, axis).text() == name; };
  return std::ranges::any_of(profile.axes, decides) ? ": " + constant.text : "";
}

}  // namespace

model::ObjectId Resolving::id(std::string_view name, AxisSlot slot) const {
  const Object* object = profile.find(name, motor(slot));
  if (object == nullptr) return model::kNoObject;
  const auto at = ids.find(object->name);
  return at == ids.end() ? model::kNoObject : at->second;
}

std::optional<model::Condition> Resolving::condition(const JsonNode& node, AxisSlot slot,
                                                     std::string_view object) const {
  model::Condition out = condition_in(node);
  out.object = id(node.text(object), slot);
  if (out.object == model::kNoObject) return std::nullopt;
  const JsonNode compared = node[node.has("equals") ? "equals" : "not_equals"];
  if (!compared.is_object()) return out;
  const auto value = constants.find(compared.text("constant"));
  const auto number = value == constants.end() ? std::nullopt : value->second.scale(compared.whole("times", 1));
  if (!number) return std::nullopt;
  out.values = {*number};
  return out;
}

WriteValue Resolving::value_of(const JsonNode& write, AxisSlot slot) const {
  return value_in(of_axis(write["value"], profile.axes[motor(slot)]));
}

std::optional<Rational> Resolving::factor_of(const model::Amount& amount, const model::Unit& unit) const {
  const Rational per_rev(1);  // units per revolution cancel out here: any number will do
  const std::optional<Rational> registers = model::in_registers(amount, constants, per_rev);
  if (!registers) return std::nullopt;
  const Rational out = *registers * base_per_register(unit.base, per_rev);
  if (!unit.inverse) return out;
  return out.numerator() == 0 ? std::nullopt : std::optional(out.inverse());
}

std::optional<std::int64_t> Resolving::raw(const WriteValue& value, std::string_view name, AxisSlot slot) const {
  if (const auto* literal = std::get_if<std::int64_t>(&value)) return *literal;
  const Object* object = profile.find(name, motor(slot));
  const auto* amount = std::get_if<model::Amount>(&value);
  if (object == nullptr || amount == nullptr) return std::nullopt;
  const model::Unit& unit = profile.units.find(object->unit)->second;
  const std::optional<Rational> factor = factor_of(*amount, unit), scale = model::raw_per_base(unit, constants);
  if (!factor || !scale) return std::nullopt;
  const Rational raw = *factor * *scale;
  return object->is_real ? model::real_of(raw.numerator(), raw.denominator()) : raw.scale(1);
}

std::optional<model::ObjectWrite> Resolving::write(const JsonNode& node, AxisSlot slot) const {
  const model::ObjectId object = id(node.text("write"), slot);
  if (object == model::kNoObject) return std::nullopt;
  const std::optional<std::int64_t> value = raw(value_of(node, slot), node.text("write"), slot);
  if (!value) return std::nullopt;
  return model::ObjectWrite{object, *value, node.text("why")};
}

std::optional<model::FactoryWrite> Resolving::factory_write(const JsonNode& node, AxisSlot slot) {
  const Object* object = profile.find(node.text("write"), motor(slot));
  const model::ObjectId written = id(node.text("write"), slot);
  if (object == nullptr || written == model::kNoObject) return std::nullopt;
  model::FactoryWrite out{written, node.wholes("instead_of"), {}, {}, node.text("why")};
  const WriteValue value = value_of(node, slot);
  if (const auto* literal = std::get_if<std::int64_t>(&value)) {
    out.amount = Rational(*literal);
  } else {
    const model::Unit& unit = profile.units.find(object->unit)->second;
    const std::optional<Rational> factor = factor_of(std::get<model::Amount>(value), unit);
    const std::optional<model::ScaleRecipe> scale = recipe(unit);
    if (!factor || !scale) return std::nullopt;
    out.amount = *factor;
    out.recipe = *scale;
  }
  out.recipe.raw = object->numbers();
  return out;
}

std::optional<model::DriveConstant::Operand> Resolving::operand(const JsonNode& node) const {
  using Operand = model::DriveConstant::Operand;
  if (const std::optional<Rational> number = node.rational()) return Operand{model::kNoObject, *number};
  const std::string name = node.text();
  if (const auto known = constants.find(name); known != constants.end())
    return Operand{model::kNoObject, known->second};
  const model::ObjectId object = profile.constants.contains(name) ? model::kNoObject : id(name, 0);
  if (object == model::kNoObject) return std::nullopt;
  return Operand{object, Rational(1)};
}

/// False: a condition names what this protocol does not have, so that the rule cannot be judged. `never`: nor can it
/// hold.
bool Resolving::conditions(const JsonNode& node, model::DriveConstant::Rule& out, bool& never) const {
  using enum model::DriveConstant::Condition::Test;
  for (const JsonNode& each : conditions_of(node)) {
    const std::vector<JsonNode> words = each.elements();
    const auto test = words.size() == 2 ? present : words.at(1).text() == "==" ? equal : not_equal;
    const auto left = operand(words.at(0));
    const auto right = test == present ? left : operand(words.at(2));
    never = test == present && !left;
    if (never) return true;
    if (!left || !right) return false;
    out.conditions.push_back({test, *left, *right});
  }
  return true;
}

/// Position in the model, where it is put at its first need. None where it is not read from the drive, or a rule needs
/// what is not there: a rule left out could make another one true.
std::optional<std::size_t> Resolving::drive_constant(const std::string& name) {
  const auto at = std::ranges::find(model.constants, name, &model::DriveConstant::name);
  if (at != model.constants.end()) return static_cast<std::size_t>(at - model.constants.begin());
  const Constant& constant = profile.constants.find(name)->second;
  model::DriveConstant out{name, {}, constant.min, constant.max};
  for (const JsonNode& node : profile.section("constants")[name]["first"].elements()) {
    model::DriveConstant::Rule rule{{}, node["value"].is_string(), {}, {}};
    bool never = false;
    if (!conditions(node, rule, never)) return std::nullopt;
    if (never) continue;
    const std::vector<JsonNode> words =
        node["value"].elements();  // operands, and an operator before each but the first
    for (std::size_t k = 0; k < words.size(); k += 2) {
      const auto one = operand(words[k]);
      if (!one) return std::nullopt;
      (k > 0 && words[k - 1].text() == "/" ? rule.div : rule.mul).push_back(*one);
    }
    out.rules.push_back(std::move(rule));
  }
  if (out.rules.empty()) return std::nullopt;
  model.constants.push_back(std::move(out));
  return model.constants.size() - 1;
}

std::optional<model::ScaleRecipe> Resolving::recipe(const model::Unit& unit, std::vector<std::string>* missing) {
  model::ScaleRecipe out;
  bool known = true;
  for (const bool divides : {false, true})
    for (const model::Factor& factor : divides ? unit.div : unit.mul) {
      if (const std::optional<Rational> value = model::value_of(factor, constants)) {
        if (divides && value->numerator() == 0) return std::nullopt;
        out.fixed = divides ? out.fixed / *value : out.fixed * *value;
      } else if (const auto at = drive_constant(std::get<std::string>(factor))) {
        (divides ? out.div : out.mul).push_back(*at);
      } else {  // a constant nobody gave
        known = false;
        if (missing != nullptr) missing->push_back(std::get<std::string>(factor));
      }
    }
  return known ? std::optional(std::move(out)) : std::nullopt;
}

void resolve_constants(Resolving& r) {
  const std::vector<std::string> known = keys_in(r.profile.constants);
  for (const auto& [name, constant] : r.profile.constants) {
    if (constant.standard) r.constants.emplace(name, *constant.standard);
    if (constant.required && !r.input.constants.contains(name))
      r.fault(pointer_to("/constants", name),
              fmt::format("\"{}\" is required for profile \"{}\": {}", name, r.profile.name, constant.text));
  }
  for (const auto& [name, value] : r.input.constants) {
    const std::string pointer = pointer_to("/constants", name);
    const auto at = r.profile.constants.find(name);
    if (at == r.profile.constants.end()) {
      std::string instead = did_you_mean(name, known);
      if (instead.empty()) instead = ": it has " + (known.empty() ? "none" : listed(known));
      r.fault(pointer, fmt::format("profile \"{}\" has no constant \"{}\"{}", r.profile.name, name, instead));
      continue;
    }
    const Constant& constant = at->second;
    if (constant.min && constant.max &&
        (value.to_double() < constant.min->to_double() || value.to_double() > constant.max->to_double()))
      r.fault(pointer,
              fmt::format("must be {:.10g} to {:.10g}, is {:.10g}{}", constant.min->to_double(),
                          constant.max->to_double(), value.to_double(), why_no_more(r.profile, name, constant)));
    r.constants.insert_or_assign(name, value);
  }
}

void resolve_objects(Resolving& r) {
  for (const Object& object : r.profile.objects) {
    const Place* place = object.place(r.input.protocol);
    if (place == nullptr) continue;
    const AxisSlot axis = object.slot == kNoAxis ? kNoAxis : r.axis_of(object.slot);
    // Of a motor that is no axis only what travels with the others' is needed.
    if (object.slot != kNoAxis && axis == kNoAxis && !place->composed) continue;
    model::ObjectDef def = *place;
    def.slot = axis;
    def.printed = object.numbers();
    def.any_width = object.any_width && r.input.protocol == "canopen";
    r.ids.emplace(object.name, static_cast<model::ObjectId>(r.model.objects.size()));
    r.model.objects.push_back(std::move(def));
  }
  for (const Object& object : r.profile.objects) {
    const auto at = r.ids.find(object.name);
    if (!object.is_part() || at == r.ids.end()) continue;
    model::ObjectDef& part = r.model.objects[at->second];
    part.part.whole = r.ids.find(object.whole)->second;
    // A write of the whole would go past what holds for its part.
    if (object.writable) r.model.objects[part.part.whole].mailbox_reads_only = true;
    if (!part.is_directed()) continue;
    part.part.sign = r.ids.find(object.sign)->second;
    part.trigger = r.model.objects[part.part.sign].trigger;
    if (object.writable) r.model.objects[part.part.sign].mailbox_reads_only = true;
  }
}

std::variant<model::DriveModel, std::vector<Fault>> resolve(const LoadedProfile& loaded, const ResolveInput& input) {
  Resolving r(loaded.profile, input);
  if (!loaded.faults.empty()) {
    r.fault("/profile", fmt::format("profile \"{}\" has mistakes of its own", loaded.file));
    return r.faults;
  }
  check_protocol(r);
  check_identity(r);
  resolve_constants(r);
  if (input.axes.empty() || input.axes.size() > loaded.profile.axes.size())
    r.fault("/axes", fmt::format("profile \"{}\" is a drive of {} axes, {} are configured", loaded.profile.name,
                                 loaded.profile.axes.size(), input.axes.size()));
  if (!r.faults.empty()) return r.faults;
  resolve_motors(r);
  if (!r.faults.empty()) return r.faults;
  try {
    resolve_objects(r);
    for (std::size_t i = 0; i < input.axes.size(); ++i) {
      const auto slot = static_cast<AxisSlot>(i);
      r.model.axes.emplace_back();
      if (r.profile.state.is_virtual) make_objects(r, slot);
      resolve_quantities(r, slot);
      resolve_state(r, slot);
      resolve_commands(r, slot);
    }
    resolve_drive(r);
  } catch (const std::overflow_error& error) {
    r.fault("/constants", std::string(error.what()) + ": give constants and units_per_rev with fewer digits");
  }
  if (!r.faults.empty()) return r.faults;
  return std::move(r.model);
}

}  // namespace axisgate::profile
