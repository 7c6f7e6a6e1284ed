// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/take_out.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

/// Keys whose text is a person's, or another name than an object's.
constexpr std::array kNoNames = std::to_array<std::string_view>(
    {"text", "source", "title", "name", "unit", "units", "why", "base", "by", "quantity", "ask", "else"});
/// Lists that are nothing without one of their entries.
constexpr std::array kWhole = std::to_array<std::string_view>({"steps", "value", "if", "mul", "div"});
/// What a profile says null of, where the drive does not have it.
constexpr std::string_view kLoss = "loss";

bool is_one_of(std::string_view key, const auto& keys) { return std::ranges::find(keys, key) != keys.end(); }

bool optional_step(const json& step) { return step.is_object() && step.value("optional", json(false)) == json(true); }

/// Whether keys of this object go by themselves: those of a section, of a protocol and of a constant.
bool goes_by_key(int depth, std::string_view parent) {
  return depth <= 1 || (depth == 2 && (parent == "protocols" || parent == "constants"));
}

/// False: nothing of it is left. `depth`: of the document, 0.
bool left(json& node, const std::string& object, std::string_view key, std::string_view parent, int depth);

bool names(const json& node, const std::string& object) {
  if (node.is_string()) return node == object;
  return node.is_structured() &&
         std::any_of(node.begin(), node.end(), [&](const json& part) { return names(part, object); });
}

/// Of a constant's "first": what can never be true goes; a product that cannot be had is not known, and hides the rules
/// behind it as before.
json left_of_rules(const json& rules, const std::string& object) {
  json out = json::array();
  for (json rule : rules) {
    if (rule.is_object() && names(rule.value("if", json()), object)) continue;
    if (rule.is_object() && names(rule.value("value", json()), object)) rule["value"] = "unknown";
    out.push_back(std::move(rule));
  }
  return out;
}

bool left_of_list(json& list, const std::string& object, std::string_view key, int depth) {
  if (key == "first") {
    list = left_of_rules(list, object);
    return !list.empty();
  }
  json out = json::array();
  for (json& entry : list) {
    if (left(entry, object, "", key, depth + 1))
      out.push_back(std::move(entry));
    else if (is_one_of(key, kWhole) && !optional_step(entry))
      return false;
  }
  const bool emptied = out.empty() && !list.empty();
  list = std::move(out);
  return !emptied;
}

bool left(json& node, const std::string& object, std::string_view key, std::string_view parent, int depth) {
  if (node.is_string()) return node.get_ref<const std::string&>() != object;
  if (node.is_array()) return left_of_list(node, object, key, depth);
  if (!node.is_object()) return true;
  std::vector<std::string> gone;
  for (auto& [name, value] : node.items())
    if (!is_one_of(name, kNoNames) && !left(value, object, name, key, depth + 1)) gone.push_back(name);
  if (gone.empty()) return true;
  if (!goes_by_key(depth, parent)) return false;
  for (const std::string& name : gone) {
    node.erase(name);
    if (name == kLoss) node[name] = nullptr;
  }
  return true;
}

/// A rule that says "unknown" is no way to know.
bool tells(const json& rule) { return rule.is_object() && rule.value("value", json()).is_array(); }

void drop_idle_rules(json& document) {
  if (!document.contains("constants")) return;
  for (json& constant : document["constants"])
    if (constant.is_object() && constant.contains("first") && std::ranges::none_of(constant["first"], tells))
      constant.erase("first");
}

}  // namespace

void take_out_object(json& document, const std::string& object) {
  document["objects"].erase(object);
  take_out_uses(document, object);
}

void take_out_uses(json& document, const std::string& object) {
  json objects = std::move(document["objects"]);
  document.erase("objects");
  left(document, object, "", "", 0);
  document["objects"] = std::move(objects);
  drop_idle_rules(document);
}

void hide_values(json& document, const std::string& object) {
  if (!document.contains("constants")) return;
  for (json& constant : document["constants"]) {
    if (!constant.is_object() || !constant.contains("first")) continue;
    for (json& rule : constant["first"])
      if (rule.is_object() && names(rule.value("value", json()), object)) rule["value"] = "unknown";
  }
  drop_idle_rules(document);
}

void drop_hidden_rules(json& document) {
  if (!document.contains("constants")) return;
  const json& objects = document["objects"];
  const auto holds = [&](const json& rule) {
    const json condition = rule.value("if", json());
    return condition.is_array() && condition.size() == 2 && condition[0].is_string() && condition[1] == "present" &&
           objects.contains(condition[0].get<std::string>());
  };
  for (json& constant : document["constants"]) {
    if (!constant.is_object() || !constant.contains("first")) continue;
    const json& rules = constant["first"];
    auto end = std::find_if(rules.begin(), rules.end(), holds);
    if (end != rules.end()) ++end;
    if (std::none_of(rules.begin(), end, tells)) constant.erase("first");
  }
}

void take_out_mode(json& document, const std::string& mode) {
  document["modes"].erase(mode);
  if (mode != "6") return;
  document.erase("homing");
  for (const char* const command : {"home", "set_position"})
    if (document.contains("commands")) document["commands"].erase(command);
}

void take_out_modes(json& document) {
  std::vector<std::string> gone;
  for (const auto& [mode, value] : document["modes"].items()) {
    const auto number = whole_number(mode);
    const auto setpoint = number ? setpoint_of(static_cast<std::int16_t>(*number)) : std::nullopt;
    if (setpoint && !document["quantities"].contains(row(*setpoint).name)) gone.push_back(mode);
  }
  for (const std::string& mode : gone) take_out_mode(document, mode);
}

}  // namespace axisgate::profile
