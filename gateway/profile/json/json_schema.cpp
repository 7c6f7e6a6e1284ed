// SPDX-License-Identifier: Apache-2.0
// The only file that sees valijson.
#include "gateway/profile/json/json_schema.hpp"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cctype>
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

/// What numbers count: the schema's own key "unit", or by how the name of theirs ends.
std::string unit_of(const std::string& key, const json* said) {
  if (const json* unit = said == nullptr || !said->is_object() ? nullptr : find(*said, "unit")) return text_of(*unit);
  for (const auto& [ending, unit] : {std::pair{"_ms", "ms"}, {"_us", "µs"}, {"_s", "s"}, {"_mb", "MiB"}})
    if (key.ends_with(ending)) return unit;
  return "";
}

bool wants(const json& said, const char* type) {
  const json* const types = find(said, "type");
  return types != nullptr && (types->is_array() ? std::ranges::find(*types, type) != types->end() : *types == type);
}

/// 0.5 where a whole number stands.
bool has_a_rest(const json& value, const json& said) {
  return value.is_number_float() && wants(said, "integer") && !wants(said, "number");
}

/// "2 s", "27.5A": what stands behind the number is for people.
bool is_number_with_a_unit(const std::string& text) {
  const std::size_t digits = text.find_first_not_of("-.0123456789");
  if (digits == 0 || digits == std::string::npos || !json::accept(text.substr(0, digits))) return false;
  const std::size_t unit = text.find_first_not_of(' ', digits);
  return unit != std::string::npos && (std::isalpha(static_cast<unsigned char>(text[unit])) != 0 || text[unit] == '%');
}

/// The key of which this is a part, or which is a part of this, where half of the longer is both.
std::string same_beginning(const std::string& key, const std::vector<std::string>& known) {
  for (const std::string& each : known) {
    const auto [shorter, longer] =
        std::minmax(key, each, [](const auto& a, const auto& b) { return a.size() < b.size(); });
    if (longer.starts_with(shorter) && 2 * shorter.size() >= longer.size()) return each;
  }
  return "";
}

/// Behind a key that is not known.
std::string instead_of_key(const std::string& key, const std::vector<std::string>& known) {
  constexpr std::size_t kMostListed = 16;
  if (const std::string near = did_you_mean(key, known); !near.empty() || known.empty()) return near;
  if (const std::string near = same_beginning(key, known); !near.empty()) return "; did you mean \"" + near + "\"?";
  std::string out = ": the keys here are ";
  for (std::size_t i = 0; i < std::min(kMostListed, known.size()); ++i) out += (i == 0 ? "" : ", ") + known[i];
  return known.size() <= kMostListed ? out : out + " and " + std::to_string(known.size() - kMostListed) + " more";
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
    unit_ = unit_of(keys.empty() ? "" : keys.back(), rule);
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
    if (description.find("'type'") != std::string::npos && has_a_rest(value, said) && !said.contains("instead"))
      return put(pointer, "must be a whole number" + range_text(said) + in_unit() + ", is " + value.dump());
    if (description.find("'type'") != std::string::npos && said.contains("type"))
      return put(pointer, "must be " + types_text(said["type"]) + ", is " + std::string(value.type_name()) +
                              what_to_write(value, said));
    if (description.find("'pattern'") != std::string::npos && expects != nullptr)
      return put(pointer, value.dump() + " is not " + text_of(*expects));
    if (expects != nullptr) return put(pointer, description + " (expected: " + text_of(*expects) + ")");
    if (!bound(pointer, value, said)) put(pointer, description);
  }

  void put(const std::string& pointer, std::string message) {
    const SchemaFault fault{pointer, std::move(message)};
    if (std::ranges::find(faults, fault) == faults.end()) faults.push_back(fault);
  }

  [[nodiscard]] std::string in_unit() const { return unit_.empty() ? "" : ", in " + unit_; }

  static std::string range_text(const json& said) {
    const json *least = find(said, "minimum"), *most = find(said, "maximum");
    if (least != nullptr && most != nullptr) return " of " + least->dump() + " to " + most->dump();
    if (least != nullptr) return " of at least " + least->dump();
    return most == nullptr ? "" : " of at most " + most->dump();
  }

  /// Sizes and limits, in fewer words than the validator's.
  bool bound(const std::string& pointer, const json& value, const json& said) {
    if (has_a_rest(value, said)) return true;  // told with its type
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
        put(at, "unknown key " + name + instead_of_key(key, known));
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

  /// The likely thing, where one can tell it from what stands there.
  [[nodiscard]] std::string what_to_write(const json& value, const json& said) const {
    if (const json* instead = find(said, "instead"))
      if (const json* words = find(*instead, value.type_name()))
        return ": write " + boost::replace_all_copy(text_of(*words), "$", value.dump());
    const std::string text = text_of(value);
    const bool is_number = !text.empty() && text.find_first_not_of("-.0123456789") == std::string::npos;
    const bool wants_number = wants(said, "integer") || wants(said, "number");
    if (value.is_string() && wants_number && is_number && json::accept(text))
      return ": write " + text + ", without quotes";
    if (value.is_string() && wants_number && is_number_with_a_unit(text))
      return ": a number stands alone" + in_unit() + ", without quotes";
    if (value.is_number() && wants(said, "string")) return ": write \"" + value.dump() + "\", in quotes";
    if (wants(said, "boolean")) return ": write true or false, without quotes";
    if (wants(said, "array") && !value.is_null())
      return ": write [" + std::string(value.is_object() ? "{...}" : value.dump()) + "], a list even of one";
    return "";
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
  std::string unit_{};  ///< of the value that is spoken of
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
