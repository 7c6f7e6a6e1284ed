// SPDX-License-Identifier: Apache-2.0
// The only file that sees valijson.
#include "gateway/profile/json/json_schema.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "gateway/core/nearest.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

const json* find(const json& object, const char* key) {
  const auto at = object.find(key);
  return at == object.end() ? nullptr : &*at;
}

/// Follows "$ref": "#/definitions/..." to what it names.
const json* dereferenced(const json& root, const json* node) {
  while (node != nullptr && node->is_object()) {
    const json* reference = find(*node, "$ref");
    if (reference == nullptr) break;
    node = &root.at(json::json_pointer(reference->get_ref<const std::string&>().substr(1)));
  }
  return node;
}

const json* property(const json& node, const std::string& key) {
  if (const json* properties = find(node, "properties"); properties != nullptr && properties->contains(key))
    return &properties->at(key);
  if (const json* patterns = find(node, "patternProperties")) {
    for (const auto& [pattern, schema] : patterns->items())
      if (std::regex_search(key, std::regex(pattern))) return &schema;
  }
  const json* others = find(node, "additionalProperties");
  return others != nullptr && others->is_object() ? others : nullptr;
}

/// The part of the schema that speaks of this place, or null where that cannot be told (a choice of schemas).
const json* schema_at(const json& root, const std::vector<std::string>& keys) {
  const json* node = dereferenced(root, &root);
  for (const std::string& key : keys) {
    if (node == nullptr || !node->is_object()) return nullptr;
    const json* items = find(*node, "items");
    const bool is_index = items != nullptr && key.find_first_not_of("0123456789") == std::string::npos;
    node = dereferenced(root, is_index ? items : property(*node, key));
  }
  return node;
}

/// The keys of valijson's "<root>[a][0]".
std::vector<std::string> keys_of(const std::vector<std::string>& context) {
  std::vector<std::string> keys;
  for (std::size_t i = 1; i < context.size(); ++i) keys.push_back(context[i].substr(1, context[i].size() - 2));
  return keys;
}

std::string pointer_of(const std::vector<std::string>& keys) {
  return std::accumulate(keys.begin(), keys.end(), std::string(),
                         [](const std::string& pointer, const std::string& key) { return pointer_to(pointer, key); });
}

std::string listed(const json& values) {
  std::string out;
  for (const json& value : values)
    out += (out.empty() ? "" : ", ") + (value.is_string() ? value.get<std::string>() : value.dump());
  return out;
}

std::vector<std::string> texts(const json* values) {
  std::vector<std::string> out;
  if (values != nullptr)
    for (const json& value : *values)
      if (value.is_string()) out.push_back(value);
  return out;
}

/// A parent only repeats that something below it is wrong: the fault below has its own line.
bool is_echo(std::string_view description) {
  return description.starts_with("Failed to validate ") || description.starts_with("Failed to any values") ||
         description.find("child schema") != std::string_view::npos;
}

class Wording {
 public:
  Wording(const json& document, const json& schema, std::vector<SchemaFault>& out)
      : document_(document), schema_(schema), out_(out) {}

  void add(const std::vector<std::string>& keys, const std::string& description) {
    const std::string pointer = pointer_of(keys);
    const json& value = document_.at(json::json_pointer(pointer));
    const json* rule = schema_at(schema_, keys);
    const json none = json::object();
    const json& said = rule == nullptr ? none : *rule;
    if (description.starts_with("Object contains a property")) return unknown_keys(pointer, value, said);
    if (description.starts_with("Missing required property"))
      return put(pointer, "key \"" + quoted(description) + "\" is missing");
    if (description.starts_with("Missing dependency"))
      return put(pointer, "key \"" + quoted(description) + "\" is missing beside this");
    if (description.find("enum") != std::string::npos && said.contains("enum")) {
      const std::string given = value.is_string() ? value.get<std::string>() : std::string();
      return put(pointer, value.dump() + " is none of: " + listed(said["enum"]) +
                              did_you_mean(given, texts(find(said, "enum"))));
    }
    if (description.find("'type'") != std::string::npos && said.contains("type")) {
      const json types = said["type"].is_array() ? said["type"] : json::array({said["type"]});
      return put(pointer, "must be " + types_text(types) + ", is " + std::string(value.type_name()));
    }
    if (description.find("'pattern'") != std::string::npos && said.contains("expects"))
      return put(pointer, value.dump() + " is not " + said["expects"].get<std::string>());
    if (const json* expects = find(said, "expects"))
      return put(pointer, description + " (expected: " + expects->get<std::string>() + ")");
    if (bound(pointer, value, said)) return;
    put(pointer, description);
  }

 private:
  /// Sizes and limits, in fewer words than the validator's.
  bool bound(const std::string& pointer, const json& value, const json& said) {
    const auto beyond = [&](const char* key, const json& measure, bool least, const char* noun) {
      const json* limit = find(said, key);
      if (limit == nullptr || !limit->is_number() || (least ? measure >= *limit : measure <= *limit)) return false;
      put(pointer, std::string(value.is_number() ? "must be " : "must have ") + (least ? "at least " : "at most ") +
                       limit->dump() + noun + ", " + (value.is_number() ? "is " : "has ") + measure.dump());
      return true;
    };
    if (value.is_number()) return beyond("minimum", value, true, "") || beyond("maximum", value, false, "");
    const std::size_t size = value.is_string() ? value.get_ref<const std::string&>().size() : value.size();
    if (value.is_array())
      return beyond("minItems", size, true, " entries") || beyond("maxItems", size, false, " entries");
    if (value.is_object())
      return beyond("minProperties", size, true, " keys") || beyond("maxProperties", size, false, " keys");
    return beyond("minLength", size, true, " characters") || beyond("maxLength", size, false, " characters");
  }

  void put(const std::string& pointer, std::string message) {
    const SchemaFault fault{pointer, std::move(message)};
    if (std::ranges::find(out_, fault) == out_.end()) out_.push_back(fault);
  }

  /// The validator names the first unknown key only; a person wants them all.
  void unknown_keys(const std::string& pointer, const json& value, const json& said) {
    std::vector<std::string> known;
    if (const json* properties = find(said, "properties"))
      for (const auto& [key, schema] : properties->items()) known.push_back(key);
    for (const auto& [key, unused] : value.items())
      if (property(said, key) == nullptr) put(pointer_to(pointer, key), unknown_key(key, said, known));
  }

  static std::string unknown_key(const std::string& key, const json& said, const std::vector<std::string>& known) {
    const json* renamed = find(said, "renamed");
    if (renamed != nullptr && renamed->contains(key))
      return "key \"" + key + "\" is called \"" + renamed->at(key).get<std::string>() + "\" now";
    if (said.contains("expects")) return "\"" + key + "\" is not " + said["expects"].get<std::string>();
    return "unknown key \"" + key + "\"" + did_you_mean(key, known);
  }

  static std::string quoted(const std::string& description) {
    const std::size_t first = description.find('\'');
    return description.substr(first + 1, description.rfind('\'') - first - 1);
  }

  static std::string types_text(const json& types) {
    std::string out;
    for (std::size_t i = 0; i < types.size(); ++i)
      out += (i == 0 ? "" : i + 1 == types.size() ? " or " : ", ") + types[i].get<std::string>();
    return out;
  }

  const json& document_;
  const json& schema_;
  std::vector<SchemaFault>& out_;
};

}  // namespace

std::vector<SchemaFault> validate(const json& document, const json& schema) {
  valijson::Schema rules;
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema), rules);
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  const valijson::adapters::NlohmannJsonAdapter target(document);
  if (validator.validate(rules, target, &results)) return {};

  std::vector<SchemaFault> faults;
  std::vector<std::pair<std::vector<std::string>, std::string>> echoes;
  Wording wording(document, schema, faults);
  for (const valijson::ValidationResults::Error& error : results) {
    if (is_echo(error.description))
      echoes.emplace_back(keys_of(error.context), error.description);
    else
      wording.add(keys_of(error.context), error.description);
  }
  // Never pass in silence what the validator has refused.
  if (faults.empty())
    for (const auto& [keys, description] : echoes) wording.add(keys, description);
  if (faults.empty()) faults.push_back({"", "does not fit the schema"});
  return faults;
}

std::string pointer_to(std::string_view parent, std::string_view key) {
  return (json::json_pointer(std::string(parent)) / std::string(key)).to_string();
}

std::string pointer_to(std::string_view parent, std::size_t index) { return pointer_to(parent, std::to_string(index)); }

}  // namespace axisgate::profile
