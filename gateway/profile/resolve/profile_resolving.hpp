// SPDX-License-Identifier: Apache-2.0
// What the parts of resolve() share: the profile, the configured drive, the model being built and the faults found.
// Promises that names become ids here and nowhere else.
// Never decides what a quantity or a command means: the parts do.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/model/scale.hpp"
#include "gateway/profile/resolve/profile_resolve.hpp"

namespace axisgate::profile {

class Resolving {
 public:
  Resolving(const Profile& loaded, const ResolveInput& configured) : profile(loaded), input(configured) {}

  const Profile& profile;
  const ResolveInput& input;
  model::DriveModel model;
  model::Constants constants;
  std::vector<Fault> faults;

  void fault(std::string pointer, std::string message) {
    faults.push_back({"", std::move(pointer), std::move(message)});
  }

  // Each is absent where the protocol, or a constant nobody gave, leaves something out.
  [[nodiscard]] model::ObjectId id(std::string_view name, AxisSlot slot) const;
  /// Calls `use(id, slot)` for what the name means on each axis, each object once.
  template <class Use>
  void each_object(std::string_view name, Use&& use) const {
    std::vector<model::ObjectId> seen;
    for (std::size_t i = 0; i < model.axes.size(); ++i) {
      const model::ObjectId object = id(name, static_cast<AxisSlot>(i));
      if (object == model::kNoObject || std::ranges::find(seen, object) != seen.end()) continue;
      seen.push_back(object);
      use(object, static_cast<AxisSlot>(i));
    }
  }
  [[nodiscard]] std::optional<model::Condition> condition(const JsonNode& node, AxisSlot slot,
                                                          std::string_view object = "object") const;
  /// Of a number or an amount.
  [[nodiscard]] std::optional<std::int64_t> raw(const WriteValue& value, std::string_view object, AxisSlot slot) const;
  [[nodiscard]] std::optional<model::ObjectWrite> write(const JsonNode& node, AxisSlot slot) const;
  [[nodiscard]] std::optional<model::FactoryWrite> factory_write(const JsonNode& node, AxisSlot slot);
  /// What a unit makes of a number, before the axis's own factors: known now, or once constants of the drive are. Adds
  /// to `missing` the constants that it lacks for that.
  [[nodiscard]] std::optional<model::ScaleRecipe> recipe(const model::Unit& unit,
                                                         std::vector<std::string>* missing = nullptr);

  /// The motor that an axis is, and the axis that a motor is (kNoAxis: none).
  [[nodiscard]] AxisSlot motor(AxisSlot slot) const;
  [[nodiscard]] AxisSlot axis_of(AxisSlot motor) const;
  /// What a write gives the axis's motor.
  [[nodiscard]] WriteValue value_of(const JsonNode& write, AxisSlot slot) const;
  /// The constant that tells the mode of a motor; empty: none does.
  [[nodiscard]] std::string mode_constant(AxisSlot motor) const;
  /// The mode that the maker's tool has given this axis's motor; none where the drive is simply sent one.
  [[nodiscard]] std::optional<std::int16_t> configured_mode(AxisSlot slot) const;
  /// Whether the axis can have a mode, and follow a set-point in one of its modes.
  [[nodiscard]] bool can_have(AxisSlot slot, std::int16_t mode) const;
  [[nodiscard]] bool can_follow(AxisSlot slot, Quantity setpoint) const;

  std::vector<AxisSlot> motors;                             ///< of each axis: position in Profile::axes
  std::map<std::string, model::ObjectId, std::less<>> ids;  ///< by full name

 private:
  /// What the scale of `unit` is multiplied by: the amount in its base, or the inverse of that. None: not known, or 0.
  [[nodiscard]] std::optional<Rational> factor_of(const model::Amount& amount, const model::Unit& unit) const;
  [[nodiscard]] std::optional<std::size_t> drive_constant(const std::string& name);
  [[nodiscard]] std::optional<model::DriveConstant::Operand> operand(const JsonNode& node) const;
  [[nodiscard]] bool conditions(const JsonNode& rule, model::DriveConstant::Rule& out, bool& never) const;
};

// The parts, in their order.
void resolve_constants(Resolving& resolving);
/// Which motor each axis is, and that its mode is known.
void resolve_motors(Resolving& resolving);
void resolve_objects(Resolving& resolving);
/// The objects that the gateway makes for a virtual axis.
void make_objects(Resolving& resolving, AxisSlot slot);
/// Bindings and limits of the axis at `slot`.
void resolve_quantities(Resolving& resolving, AxisSlot slot);
/// How its state is known, its modes and its homing.
void resolve_state(Resolving& resolving, AxisSlot slot);
void resolve_modes(Resolving& resolving, AxisSlot slot);
void resolve_commands(Resolving& resolving, AxisSlot slot);
void resolve_drive(Resolving& resolving);

}  // namespace axisgate::profile
