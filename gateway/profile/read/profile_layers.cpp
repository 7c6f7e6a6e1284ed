// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile_layers.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a base says of itself alone.
constexpr std::array kNotInherited{"$schema", "name", "base_only", "tried"};
/// Sections whose entries can be written once for all motors.
constexpr std::array kEachAxisSections{"constants", "units", "objects"};

/// A value of a document, and where it was written.
struct Node {
  std::string key;
  json value;  ///< of a list or an object: an empty one
  Written from;
  std::vector<Node> children;
};

Node tree(std::string key, const json& value, const std::string& file, const std::string& pointer) {
  Node out{std::move(key), value.is_structured() ? json(value.type()) : value, {file, pointer}, {}};
  if (value.is_structured())
    for (const auto& [name, child] : value.items())
      out.children.push_back(tree(name, child, file, pointer_to(pointer, name)));
  return out;
}

json document_of(const Node& node, const std::string& pointer, WrittenPlaces& written) {
  written[pointer] = node.from;
  json out = node.value;
  for (const Node& child : node.children) {
    const std::string key = out.is_array() ? std::to_string(out.size()) : child.key;
    json value = document_of(child, pointer_to(pointer, key), written);
    if (out.is_array())
      out.push_back(std::move(value));
    else
      out[key] = std::move(value);
  }
  return out;
}

/// The member, or null.
template <class ItsNode>
auto* member(ItsNode& node, std::string_view key) {
  const auto at = std::ranges::find(node.children, key, &Node::key);
  return node.value.is_object() && at != node.children.end() ? &*at : nullptr;
}

void take_out(Node& node, std::string_view key) {
  std::erase_if(node.children, [&](const Node& child) { return child.key == key; });
}

/// Keys of which null says what the drive does not have. Of "loss" leaving it out would not say that.
constexpr std::array kNullable{"loss", "heartbeat_ms", "broadcast"};
bool null_is_a_value(const std::string& key) { return std::ranges::find(kNullable, key) != kNullable.end(); }

/// What takes the place of words in one copy of an entry: "$axis" -> "a", "$AXIS" -> "A".
struct Replacements {
  std::array<std::pair<std::string, std::string>, 2> words;
  std::string axis;  ///< "A": its values are taken where there is one for each axis; empty: there are none

  [[nodiscard]] std::string in(std::string text) const {
    for (const auto& [word, with] : words)
      for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + with.size()))
        text.replace(at, word.size(), with);
    return text;
  }
};

/// {"A": 4, "B": 6}
bool is_one_for_each(const Node& node) {
  return node.value.is_object() && !node.children.empty() && std::ranges::all_of(node.children, [](const Node& child) {
           return child.key.size() == 1 && child.key[0] >= 'A' && child.key[0] <= 'D';
         });
}

template <class Change>
std::string in_letters(std::string text, Change change) {
  for (char& c : text) c = static_cast<char>(change(static_cast<unsigned char>(c)));
  return text;
}

class Composer {
 public:
  explicit Composer(const std::vector<std::string>& folders) : folders_(folders) {}

  LayeredProfile result(const std::string& path) {
    const Node root = compose(path);
    out_.document = std::make_shared<const json>(document_of(root, "", out_.written));
    return std::move(out_);
  }

 private:
  Node compose(const std::string& file) {
    out_.files.push_back(file);
    std::variant<json, SchemaFault> loaded = load_json(file, out_.read);
    if (auto* wrong = std::get_if<SchemaFault>(&loaded)) {
      out_.faults.push_back({file, wrong->pointer, wrong->message});
      return {};
    }
    Node own = tree("", std::get<json>(loaded), file, "");
    if (!own.value.is_object()) return own;  // the schema says so
    std::optional<Node> base = base_of(own, file);
    if (base && !base->value.is_object()) {
      if (out_.faults.empty())
        out_.faults.push_back({out_.files.back(), "", "must be object, is " + std::string(base->value.type_name())});
      base.reset();
    }
    Node alike = each_axis(own, axes_of(own, base));
    repeat_checks(own);
    for (const char* key : {"extends", "each_axis"}) take_out(own, key);
    if (!base && alike.children.empty()) return own;
    Node out = base ? std::move(*base) : Node{"", json::object(), {}, {}};
    for (const char* key : kNotInherited) take_out(out, key);
    lay_over(out, std::move(alike));
    lay_over(out, std::move(own));
    return out;
  }

  std::optional<Node> base_of(const Node& own, const std::string& file) {
    const Node* extends = member(own, "extends");
    if (extends == nullptr) return std::nullopt;
    const auto refuse = [&](std::string why) {
      out_.faults.push_back({file, "/extends", std::move(why)});
      return std::nullopt;
    };
    const std::string name = extends->value.is_string() ? extends->value.get<std::string>() : "";
    if (name.empty() || name.find('/') != std::string::npos || name.ends_with(".json"))
      return refuse("must be the name of another profile, as \"kinco-jd\": without a folder and without \".json\"");
    const std::optional<std::string> base = find_base(file, name);
    if (!base)
      return refuse(fmt::format("there is no other {}.json beside this file{}{}", name,
                                folders_.empty() ? "" : " or in ", listed(folders_)));
    std::error_code error;
    const auto same = [&](const std::string& known) { return fs::equivalent(known, *base, error); };
    if (std::ranges::any_of(out_.files, same))
      return refuse(
          fmt::format("\"{}\" extends this profile itself, directly or by others: one of them must stand alone", name));
    if (out_.files.size() > kMaxBases)
      return refuse(fmt::format("\"{}\" would be base number {}, and at most {} may stand behind one another", name,
                                out_.files.size(), kMaxBases));
    return compose(*base);
  }

  /// A profile may extend one of its own name in another folder: it is never its own base.
  [[nodiscard]] std::optional<std::string> find_base(const std::string& file, const std::string& name) {
    std::vector<std::string> folders{fs::path(file).parent_path().string()};
    folders.insert(folders.end(), folders_.begin(), folders_.end());
    for (const std::string& folder : folders) {
      std::optional<std::string> found = find_profile((fs::path(folder) / (name + ".json")).string(), {});
      if (!found && folder.empty()) found = find_profile("./" + name + ".json", {});
      if (!found) out_.read.push_back({(fs::path(folder) / (name + ".json")).string()});
      std::error_code error;
      if (found && !fs::equivalent(*found, file, error)) return found;
    }
    return std::nullopt;
  }

  static std::vector<std::string> axes_of(const Node& own, const std::optional<Node>& base) {
    const Node* axes = member(own, "axes");
    if (axes == nullptr && base) axes = member(*base, "axes");
    std::vector<std::string> out;
    if (axes != nullptr)
      for (const Node& axis : axes->children)
        if (axis.value.is_string()) out.push_back(axis.value);
    return out.empty() ? std::vector<std::string>{"A"} : out;
  }

  /// Objects key by key, anything else as a whole; a null takes out what the base has.
  void lay_over(Node& target, Node over) {
    target.from = over.from;
    for (Node& node : over.children) {
      Node* known = member(target, node.key);
      if (node.value.is_null() && !null_is_a_value(node.key)) {
        if (known == nullptr) fault(node, "would take out what this profile does not have from the one it extends");
        take_out(target, node.key);
      } else if (known == nullptr) {
        target.children.push_back(std::move(node));
      } else if (node.value.is_object() && known->value.is_object()) {
        lay_over(*known, std::move(node));
      } else {
        *known = std::move(node);
      }
    }
  }

  void fault(const Node& node, std::string message) {
    out_.faults.push_back({node.from.file, node.from.pointer, std::move(message)});
  }

  /// Every entry of "each_axis", once for each axis.
  Node each_axis(const Node& own, const std::vector<std::string>& axes) {
    Node out{"", json::object(), own.from, {}};
    const Node* sections = member(own, "each_axis");
    if (sections == nullptr) return out;
    if (!sections->value.is_object())
      fault(*sections, "must be object, is " + std::string(sections->value.type_name()));
    for (const Node& section : sections->value.is_object() ? sections->children : std::vector<Node>{}) {
      if (std::ranges::find(kEachAxisSections, section.key) == kEachAxisSections.end() || !section.value.is_object()) {
        fault(section, "is not for each axis: only objects \"constants\", \"units\" and \"objects\" can be");
        continue;
      }
      Node made{section.key, json::object(), section.from, {}};
      for (const Node& entry : section.children) {
        if (entry.key.find("$axis") == std::string::npos && entry.key.find("$AXIS") == std::string::npos) {
          fault(entry, "would be one name for all axes: write \"$AXIS.\" before an object's name, \"$axis\" elsewhere");
          continue;
        }
        for (const std::string& axis : axes)
          made.children.push_back(copied(entry, {{{{"$axis", in_letters(axis, tolower)}, {"$AXIS", axis}}}, axis}));
      }
      if (!made.children.empty()) out.children.push_back(std::move(made));
    }
    return out;
  }

  Node copied(const Node& node, const Replacements& with) {
    if (!with.axis.empty() && is_one_for_each(node)) {
      const Node* value = member(node, with.axis);
      if (value == nullptr) fault(node, "a value for axis \"" + with.axis + "\" is missing");
      Node out = value == nullptr ? Node{"", nullptr, node.from, {}} : copied(*value, with);
      out.key = with.in(node.key);
      return out;
    }
    Node out{with.in(node.key), node.value, node.from, {}};
    if (node.value.is_string()) out.value = with.in(node.value.get<std::string>());
    for (const Node& child : node.children) out.children.push_back(copied(child, with));
    return out;
  }

  /// A check with "each" stands for as many checks.
  void repeat_checks(Node& own) {
    Node* checks = member(own, "checks");
    if (checks == nullptr || !checks->value.is_array()) return;
    std::vector<Node> out;
    for (Node& check : checks->children) {
      const Node* each = member(check, "each");
      const std::vector<std::string> names = each == nullptr ? std::vector<std::string>{} : names_in(*each);
      if (each == nullptr) out.push_back(check);
      take_out(check, "each");
      for (const std::string& name : names)
        out.push_back(copied(check, {{{{"$each", name}, {"$EACH", in_letters(name, toupper)}}}, ""}));
    }
    checks->children = std::move(out);
  }

  std::vector<std::string> names_in(const Node& each) {
    std::vector<std::string> out;
    for (const Node& name : each.children)
      if (name.value.is_string()) out.push_back(name.value);
    const auto is_name = [](const std::string& name) {
      return !name.empty() && name.size() <= 48 && std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
      });
    };
    if (each.value.is_array() && !out.empty() && out.size() == each.children.size() && out.size() <= kMaxEach &&
        std::ranges::all_of(out, is_name))
      return out;
    fault(each, "must be 1 to " + std::to_string(kMaxEach) + " names of small letters, digits and '_'");
    return {};
  }

  const std::vector<std::string>& folders_;
  LayeredProfile out_;
};

}  // namespace

LayeredProfile layered_profile(const std::string& path, const std::vector<std::string>& folders) {
  return Composer(folders).result(path);
}

}  // namespace axisgate::profile
