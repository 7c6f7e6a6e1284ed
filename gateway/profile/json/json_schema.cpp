// SPDX-License-Identifier: Apache-2.0
// The only file that sees valijson.
#include "gateway/profile/json/json_schema.hpp"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <nlohmann/json.hpp>
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
  while (node != nullptr && node->is_object() && node->contains("$ref"))
    node = &root.at(json::json_pointer(node->at("$ref").get_ref<const std::string&>().substr(1)));
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

std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// A parent only repeats that something below it is wrong: the fault below has its own line.
bool is_echo(std::string_view description) {
  return description.starts_with("Failed to validate ") || description.starts_with("Failed to any values") ||
         description.find("child schema") != std::string_view::npos;
}

class Wording {
 public:
  Wording(const json& document, const json& schema) : document_(document), schema_(schema) {}

  /// `context`: valijson's "<root>", "[a]", "[0]".
  void add(const std::vector<std::string>& context, const std::string& description) {
    std::vector<std::string> keys;
    json::json_pointer place;
    for (std::size_t i = 1; i < context.size(); ++i) {
      keys.push_back(context[i].substr(1, context[i].size() - 2));
      place /= keys.back();
    }
    const json* rule = schema_at(schema_, keys);
    put(place.to_string(), document_.at(place), rule == nullptr ? json::object() : *rule, description);
  }

  std::vector<SchemaFault> faults;

 private:
  void put(const std::string& pointer, const json& value, const json& said, const std::string& description) {
    const json* const expects = find(said, "expects");
    if (description.starts_with("Object contains a property")) return unknown_keys(pointer, value, said);
    if (description.starts_with("Missing required property"))
      return put(pointer, "key \"" + quoted(description) + "\" is missing");
    if (description.starts_with("Missing dependency"))
      return put(pointer, "key \"" + quoted(description) + "\" is missing beside this");
    if (description.find("enum") != std::string::npos && said.contains("enum"))
      return put(pointer, value.dump() + " is none of: " + choice(value, said["enum"]));
    if (description.find("'type'") != std::string::npos && said.contains("type"))
      return put(pointer, "must be " + types_text(said["type"]) + ", is " + std::string(value.type_name()));
    if (description.find("'pattern'") != std::string::npos && expects != nullptr)
      return put(pointer, value.dump() + " is not " + text_of(*expects));
    if (expects != nullptr) return put(pointer, description + " (expected: " + text_of(*expects) + ")");
    if (!bound(pointer, value, said)) put(pointer, description);
  }

  void put(const std::string& pointer, std::string message) {
    const SchemaFault fault{pointer, std::move(message)};
    if (std::ranges::find(faults, fault) == faults.end()) faults.push_back(fault);
  }

  /// Sizes and limits, in fewer words than the validator's.
  bool bound(const std::string& pointer, const json& value, const json& said) {
    struct Keys {
      const char *least, *most, *noun;
    };
    const Keys keys = value.is_number()   ? Keys{"minimum", "maximum", ""}
                      : value.is_array()  ? Keys{"minItems", "maxItems", " entries"}
                      : value.is_object() ? Keys{"minProperties", "maxProperties", " keys"}
                                          : Keys{"minLength", "maxLength", " characters"};
    const json measure = value.is_number()   ? value
                         : value.is_string() ? json(value.get_ref<const std::string&>().size())
                                             : json(value.size());
    for (const bool least : {true, false}) {
      const json* limit = find(said, least ? keys.least : keys.most);
      if (limit == nullptr || (least ? measure >= *limit : measure <= *limit)) continue;
      put(pointer, std::string(value.is_number() ? "must be " : "must have ") + (least ? "at least " : "at most ") +
                       limit->dump() + keys.noun + ", " + (value.is_number() ? "is " : "has ") + measure.dump());
      return true;
    }
    return false;
  }

  /// The validator names the first unknown key only; a person wants them all.
  void unknown_keys(const std::string& pointer, const json& value, const json& said) {
    std::vector<std::string> known;
    if (const json* properties = find(said, "properties"))
      for (const auto& [key, schema] : properties->items()) known.push_back(key);
    const json renamed = said.value("renamed", json::object());
    for (const auto& [key, unused] : value.items()) {
      if (property(said, key) != nullptr) continue;
      const std::string at = pointer_to(pointer, key), name = "\"" + key + "\"";
      if (renamed.contains(key))
        put(at, "key " + name + " is called " + renamed[key].dump() + " now");
      else if (said.contains("expects"))
        put(at, name + " is not " + text_of(said["expects"]));
      else
        put(at, "unknown key " + name + did_you_mean(key, known));
    }
  }

  static std::string choice(const json& value, const json& choices) {
    std::string out;
    std::vector<std::string> words;
    for (const json& each : choices) {
      out += (out.empty() ? "" : ", ") + text_of(each);
      if (each.is_string()) words.push_back(each);
    }
    return out + did_you_mean(value.is_string() ? text_of(value) : "", words);
  }

  static std::string quoted(const std::string& description) {
    const std::size_t first = description.find('\'');
    return description.substr(first + 1, description.rfind('\'') - first - 1);
  }

  static std::string types_text(const json& said) {
    const json types = said.is_array() ? said : json::array({said});
    std::string out;
    for (std::size_t i = 0; i < types.size(); ++i)
      out += (i == 0 ? "" : i + 1 == types.size() ? " or " : ", ") + text_of(types[i]);
    return out;
  }

  const json& document_;
  const json& schema_;
};

}  // namespace

struct JsonSchema::Rules {
  json text;
  valijson::Schema rules;
  valijson::Validator validator{valijson::Validator::kStrongTypes};  // keeps its regular expressions
};

JsonSchema::JsonSchema(std::string_view text) : rules_(std::make_shared<Rules>()) {
  rules_->text = json::parse(text);
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(rules_->text), rules_->rules);
}

std::vector<SchemaFault> JsonSchema::faults_in(const json& document) const {
  valijson::ValidationResults results;
  const valijson::adapters::NlohmannJsonAdapter target(document);
  if (rules_->validator.validate(rules_->rules, target, &results)) return {};

  std::vector<valijson::ValidationResults::Error> echoes;
  Wording wording(document, rules_->text);
  for (const valijson::ValidationResults::Error& error : results) {
    if (is_echo(error.description))
      echoes.push_back(error);
    else
      wording.add(error.context, error.description);
  }
  // Never pass in silence what the validator has refused.
  if (wording.faults.empty())
    for (const auto& error : echoes) wording.add(error.context, error.description);
  if (wording.faults.empty()) wording.faults.push_back({"", "does not fit the schema"});
  return wording.faults;
}

std::string pointer_to(std::string_view parent, std::string_view key) {
  const std::string tilde = boost::replace_all_copy(std::string(key), "~", "~0");
  return std::string(parent) + "/" + boost::replace_all_copy(tilde, "/", "~1");
}

std::string pointer_to(std::string_view parent, std::size_t index) { return pointer_to(parent, std::to_string(index)); }

}  // namespace axisgate::profile
