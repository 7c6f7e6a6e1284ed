// resolve(): what this version can do, constants, objects, and what belongs to the whole drive.
#include <algorithm>
#include <stdexcept>

#include "gateway/drive/json_schema.hpp"
#include "gateway/drive/profile_resolving.hpp"

namespace axisgate::drive {
namespace {

/// The protocols whose adapters this version has.
constexpr std::array<std::string_view, 1> kAvailable{"kinco-serial"};

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// Parts of a profile that are checked but have nothing behind them yet are refused by name, never half carried out.
void refuse_unavailable(Resolving& r) {
  const auto refuse = [&](const std::string& what) {
    r.fault("", what + " is not available in this version of axisgate");
  };
  const std::string& protocol = r.input.protocol;
  if (!r.profile.protocols.contains(protocol)) {
    std::vector<std::string> known;
    for (const auto& [name, spec] : r.profile.protocols) known.push_back(name);
    r.fault("/profile",
            "profile \"" + r.profile.name + "\" has no protocol \"" + protocol + "\": it has " + listed(known));
    return;
  }
  if (std::find(kAvailable.begin(), kAvailable.end(), protocol) == kAvailable.end())
    refuse("protocol \"" + protocol + "\"");
  if (r.profile.state.is_virtual) refuse("state model \"virtual\", which profile \"" + r.profile.name + "\" needs,");
  if (r.profile.keepalive) refuse("\"keepalive\", which profile \"" + r.profile.name + "\" needs,");
  for (const auto& [name, constant] : r.profile.constants)
    if (constant.from_drive) refuse("constant \"" + name + "\" read from the drive (\"first\")");
  if (std::any_of(r.profile.alarms.begin(), r.profile.alarms.end(),
                  [](const AlarmSpec& row) { return row.value.has_value(); }))
    refuse("an alarm table by \"value\"");
  const auto sets_position = [](const StepSpec& step) {
    return std::any_of(step.values.begin(), step.values.end(),
                       [](const ValueSpec& value) { return std::holds_alternative<SetPositionValue>(value); });
  };
  for (const CommandSpec& command : r.profile.commands)
    if (std::any_of(command.steps.begin(), command.steps.end(), sets_position))
      refuse("\"set_position_value\" in a step");
  if (std::any_of(r.profile.homing.methods.begin(), r.profile.homing.methods.end(),
                  [](const auto& row) { return row.first != row.second; }))
    refuse("a translation of homing methods");
}

}  // namespace

ObjectId Resolving::id(std::string_view name, bus::AxisSlot slot) const {
  const Object* object = profile.find(name, slot);
  if (object == nullptr) return kNoObject;
  const auto at = ids.find(object->name);
  return at == ids.end() ? kNoObject : at->second;
}

std::optional<Condition> Resolving::condition(const ConditionSpec& spec, bus::AxisSlot slot) const {
  Condition out;
  out.object = id(spec.object, slot);
  if (out.object == kNoObject) return std::nullopt;
  out.mask = spec.mask;
  out.test = spec.test;
  out.values = spec.values;
  return out;
}

std::optional<std::int64_t> Resolving::raw(const std::vector<ValueSpec>& values, std::string_view name,
                                           bus::AxisSlot slot) const {
  const std::size_t which = values.size() > 1 && slot < values.size() ? slot : 0;
  const ValueSpec& value = values.at(which);
  if (const auto* literal = std::get_if<std::int64_t>(&value)) return *literal;
  const Object* object = profile.find(name, slot);
  if (object == nullptr || !std::holds_alternative<Amount>(value)) return std::nullopt;
  // Units per revolution cancel out here: any number will do.
  const Rational per_rev(1);
  const Unit& unit = profile.units.find(object->unit)->second;
  const std::optional<Rational> registers = in_registers(std::get<Amount>(value), constants, per_rev);
  const std::optional<Rational> scale = raw_per_base(unit, constants);
  if (!registers || !scale) return std::nullopt;
  return (*registers * base_per_register(unit.base, per_rev) * *scale).scale(1);
}

std::optional<ObjectWrite> Resolving::write(const WriteSpec& spec, bus::AxisSlot slot) const {
  const ObjectId object = id(spec.object, slot);
  if (object == kNoObject) return std::nullopt;
  const std::optional<std::int64_t> value = raw(spec.values, spec.object, slot);
  if (!value) return std::nullopt;
  return ObjectWrite{object, *value, spec.why};
}

void resolve_constants(Resolving& r) {
  std::vector<std::string> known;
  for (const auto& [name, constant] : r.profile.constants) {
    known.push_back(name);
    if (constant.standard) r.constants.emplace(name, *constant.standard);
    if (constant.required && !r.input.constants.contains(name))
      r.fault(pointer_to("/constants", name),
              "\"" + name + "\" is required for profile \"" + r.profile.name + "\": " + constant.text);
  }
  for (const auto& [name, value] : r.input.constants) {
    const std::string pointer = pointer_to("/constants", name);
    const auto at = r.profile.constants.find(name);
    if (at == r.profile.constants.end()) {
      const std::optional<std::string> near = nearest(name, known);
      r.fault(pointer, "profile \"" + r.profile.name + "\" has no constant \"" + name + "\"" +
                           (near ? "; did you mean \"" + *near + "\"?"
                                 : ": it has " + (known.empty() ? "none" : listed(known))));
      continue;
    }
    const Constant& constant = at->second;
    const auto decimal = [](const Rational& number) {
      std::string text = std::to_string(number.to_double());
      text.erase(text.find_last_not_of('0') + 1);
      return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
    };
    if (constant.min && constant.max &&
        (value.to_double() < constant.min->to_double() || value.to_double() > constant.max->to_double()))
      r.fault(pointer,
              "must be " + decimal(*constant.min) + " to " + decimal(*constant.max) + ", is " + decimal(value));
    r.constants.insert_or_assign(name, value);
  }
}

void resolve_objects(Resolving& r) {
  for (const Object& object : r.profile.objects) {
    const auto place = object.places.find(r.input.protocol);
    if (place == object.places.end()) continue;
    const DataType type = place->second.type.value_or(object.type);
    ObjectDef def;
    def.name = object.name;
    def.slot = object.slot;
    def.address = place->second.address;
    def.size = type.size;
    def.is_signed = type.is_signed;
    def.readable = object.readable;
    def.writable = object.writable;
    def.trigger = object.trigger;
    def.nvm = object.nvm;
    r.ids.emplace(object.name, static_cast<ObjectId>(r.model.objects.size()));
    r.model.objects.push_back(std::move(def));
  }
}

std::variant<DriveModel, std::vector<Fault>> resolve(const LoadedProfile& loaded, const ResolveInput& input) {
  Resolving r(loaded.profile, input);
  if (!loaded.faults.empty()) {
    r.fault("/profile", "profile \"" + loaded.file + "\" has mistakes of its own");
    return r.faults;
  }
  refuse_unavailable(r);
  resolve_constants(r);
  if (input.axes.empty() || input.axes.size() > loaded.profile.axes.size())
    r.fault("/axes", "profile \"" + loaded.profile.name + "\" is a drive of " +
                         std::to_string(loaded.profile.axes.size()) + " axes, " + std::to_string(input.axes.size()) +
                         " are configured");
  if (!r.faults.empty()) return r.faults;
  try {
    resolve_objects(r);
    for (std::size_t i = 0; i < input.axes.size(); ++i) {
      const auto slot = static_cast<bus::AxisSlot>(i);
      r.model.axes.emplace_back();
      resolve_quantities(r, slot);
      resolve_modes(r, slot);
      resolve_commands(r, slot);
    }
    resolve_drive(r);
  } catch (const std::overflow_error& error) {
    r.fault("/constants", std::string(error.what()) + ": give constants and units_per_rev with fewer digits");
  }
  if (!r.faults.empty()) return r.faults;
  return std::move(r.model);
}

}  // namespace axisgate::drive
