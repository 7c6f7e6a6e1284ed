// SPDX-License-Identifier: Apache-2.0
// The shipped Keya profile in tests: configured for one or two motors, and what its model says in short words.
// Promises a model, or a failed test that shows every fault.
// Never knows what is right: the tests say it, from the manual's own tables.
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>

#include "tests/profiles/resolving.hpp"

namespace axisgate::profile::keya {

inline constexpr std::array<const char*, 4> kProtocols{"canopen", "keya-can", "keya-rs232", "keya-rs485"};
inline constexpr std::array<const char*, 3> kFixed{"keya-can", "keya-rs232", "keya-rs485"};
inline constexpr std::int64_t kSpeed = 1, kTorque = 2, kAbsolute = 3;  ///< parameters 0020 and 0050

/// Axes for these motors; "": by their place in the list.
inline ResolveInput drive(const std::string& protocol, const std::vector<std::string>& motors = {"A", "B"}) {
  ResolveInput input;
  input.protocol = protocol;
  for (const std::string& motor : motors) {
    input.axes.emplace_back();
    input.axes.back().number = static_cast<AxisNumber>(input.axes.size());
    input.axes.back().motor = motor;
  }
  return input;
}

/// Both motors in this mode, their currents known.
inline ResolveInput in_mode(const std::string& protocol, std::int64_t mode,
                            const std::vector<std::string>& motors = {"A", "B"}) {
  ResolveInput input = drive(protocol, motors);
  for (const char* motor : {"a", "b"}) {
    const std::string name = motor;
    input.constants["control_mode_" + name] = Rational(mode);
    input.constants["rated_current_" + name + "_arms"] = Rational(15);
    input.constants["configured_current_" + name + "_arms"] = Rational(15);
  }
  return input;
}

inline model::DriveModel model(const ResolveInput& input) { return resolved(shipped("keya-kydas4860-2e"), input); }

inline nlohmann::json vectors(const std::string& part) { return manual("keya-kydas4860-2e").at(part); }

inline model::ObjectId id(const model::DriveModel& model, const std::string& name) {
  const auto at = std::find_if(model.objects.begin(), model.objects.end(),
                               [&](const model::ObjectDef& o) { return o.name == name; });
  return at == model.objects.end() ? model::kNoObject : static_cast<model::ObjectId>(at - model.objects.begin());
}

inline const model::ObjectDef& object(const model::DriveModel& model, const std::string& name) {
  const model::ObjectId found = id(model, name);
  if (found == model::kNoObject) throw std::runtime_error("no object " + name);
  return model.object(found);
}

/// The steps of a command in a mode; "none" where it is not supported.
inline std::string steps(const model::DriveModel& model, std::size_t axis, Command command, std::int16_t mode) {
  const auto& def = model.axes.at(axis).command(command);
  if (!def) return "none";
  for (const model::CommandDef::Variant& variant : def->variants)
    if (std::find(variant.modes.begin(), variant.modes.end(), mode) != variant.modes.end())
      return profile::text(model, variant.steps);
  return def->quick_stop_otherwise ? "quick_stop" : profile::text(model, def->steps);
}

}  // namespace axisgate::profile::keya
