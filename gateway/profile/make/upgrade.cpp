// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/upgrade.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

void rename_resynchronisation(json& document, std::vector<std::string>& changes) {
  if (!document.contains("protocols") || !document["protocols"].is_object()) return;
  for (auto& [protocol, facts] : document["protocols"].items()) {
    if (!facts.is_object() || !facts.contains("fence")) continue;
    json list = std::move(facts["fence"]);
    facts.erase("fence");
    if (!facts.contains("resynchronisation")) facts["resynchronisation"] = std::move(list);
    changes.push_back(
        fmt::format("{}: is called resynchronisation", pointer_to(pointer_to("/protocols", protocol), "fence")));
  }
}

/// Names of what chooses the mode: by the quantity, or by the name that cia402 and kinco give it.
bool chooses_mode(const json& document, const json& step) {
  if (!step.is_object() || !step.contains("write")) return false;
  json mode = "mode";
  if (document.contains("quantities") && document["quantities"].is_object() &&
      document["quantities"].contains("mode") && document["quantities"]["mode"].is_object())
    mode = document["quantities"]["mode"].value("object", mode);
  return step["write"] == mode;
}

/// The gateway goes to homing mode and back by itself.
void leave_out_modes(json& document, std::vector<std::string>& changes) {
  if (!document.contains("commands") || !document["commands"].is_object()) return;
  for (auto& [command, entry] : document["commands"].items()) {
    const bool it = command == "set_position" || command.starts_with("set_position@");
    if (!it || !entry.is_object() || !entry.contains("steps") || !entry["steps"].is_array()) continue;
    json kept = json::array();
    for (std::size_t i = 0; i < entry["steps"].size(); ++i) {
      if (chooses_mode(document, entry["steps"][i]))
        changes.push_back(fmt::format("{}: is left out: the gateway chooses homing mode and goes back by itself",
                                      pointer_to(pointer_to(pointer_to("/commands", command), "steps"), i)));
      else
        kept.push_back(entry["steps"][i]);
    }
    entry["steps"] = std::move(kept);
  }
}

std::string text_of(const json& node, const char* key) {
  const bool there = node.is_object() && node.contains(key) && node[key].is_string();
  return there ? node[key].get<std::string>() : std::string();
}

/// That mode -3 follows a velocity at once has to be said since 0.2; of a Kinco it is.
void say_velocity_modes(json& document, std::vector<std::string>& changes) {
  const bool has_mode = document.contains("modes") && document["modes"].is_object() && document["modes"].contains("-3");
  if (!has_mode || text_of(document, "extends").starts_with("kinco")) return;
  json state = document.value("state", json::object());
  if (!state.is_object() || text_of(state, "model") == "virtual" || state.contains("velocity_modes")) return;
  state["velocity_modes"] = {-3};
  document["state"] = std::move(state);
  changes.emplace_back("/state/velocity_modes: mode -3 follows a velocity at once: is that so of this drive?");
}

}  // namespace

Upgraded upgraded(const json& document) {
  Upgraded out;
  if (!document.is_object() || !document.contains("name") || !document["name"].is_string()) {
    out.fault = "is no profile: it has no name";
    return out;
  }
  json now = document;
  out.name = profile_name(document["name"].get<std::string>());
  rename_resynchronisation(now, out.changes);
  leave_out_modes(now, out.changes);
  say_velocity_modes(now, out.changes);
  out.text = profile_text(now);
  return out;
}

}  // namespace axisgate::profile
