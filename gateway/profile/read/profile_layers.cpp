// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile_layers.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a base says of itself alone.
constexpr std::array kNotInherited{"$schema", "name", "base_only"};
/// Sections whose entries can be written once for all motors.
constexpr std::array kEachAxisSections{"constants", "units", "objects"};

/// A document, and where each of its places was written.
struct Layer {
  json document;
  WrittenPlaces written;
};

std::size_t end_of(const std::string& place, const std::string& parent) {
  return place.size() == parent.size() || place[parent.size()] == '/' ? parent.size() : std::string::npos;
}

/// The member, or null.
const json* member(const json& node, std::string_view key) {
  return node.is_object() && node.contains(key) ? &*node.find(key) : nullptr;
}

/// Everything at and under `pointer`.
void forget(WrittenPlaces& places, const std::string& pointer) {
  for (auto at = places.lower_bound(pointer); at != places.end() && at->first.starts_with(pointer);)
    at = end_of(at->first, pointer) == std::string::npos ? std::next(at) : places.erase(at);
}

void copy(const WrittenPlaces& from, const std::string& pointer, WrittenPlaces& to) {
  for (auto at = from.lower_bound(pointer); at != from.end() && at->first.starts_with(pointer); ++at)
    if (end_of(at->first, pointer) != std::string::npos) to[at->first] = at->second;
}

void note_places(const json& node, const std::string& pointer, const std::string& file, WrittenPlaces& out) {
  out[pointer] = {file, pointer};
  if (node.is_object())
    for (const auto& [key, value] : node.items()) note_places(value, pointer_to(pointer, key), file, out);
  if (node.is_array())
    for (std::size_t i = 0; i < node.size(); ++i) note_places(node[i], pointer_to(pointer, i), file, out);
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
bool is_one_for_each(const json& node) {
  if (!node.is_object() || node.empty()) return false;
  return std::ranges::all_of(node.items(), [](const auto& entry) {
    return entry.key().size() == 1 && entry.key()[0] >= 'A' && entry.key()[0] <= 'D';
  });
}

class Composer {
 public:
  explicit Composer(const std::vector<std::string>& folders) : folders_(folders) {}

  LayeredProfile result(const std::string& path) {
    Layer layer = compose(path);
    out_.document = std::make_shared<const json>(std::move(layer.document));
    out_.written = std::move(layer.written);
    return std::move(out_);
  }

 private:
  Layer compose(const std::string& file) {
    out_.files.push_back(file);
    std::variant<json, SchemaFault> loaded = load_json(file, out_.read);
    if (auto* wrong = std::get_if<SchemaFault>(&loaded)) {
      out_.faults.push_back({file, wrong->pointer, wrong->message});
      return {};
    }
    Layer own{std::get<json>(std::move(loaded)), {}};
    note_places(own.document, "", file, own.written);
    if (!own.document.is_object()) return own;  // the schema says so
    std::optional<Layer> base = base_of(own, file);
    if (base && !base->document.is_object()) {
      if (out_.faults.empty())
        out_.faults.push_back({out_.files.back(), "", "must be object, is " + std::string(base->document.type_name())});
      base.reset();
    }
    const std::vector<std::string> axes = axes_of(own, base);
    Layer alike = each_axis(own, axes);
    repeat_checks(own);
    for (const char* key : {"extends", "each_axis"}) {
      own.document.erase(key);
      forget(own.written, pointer_to("", key));
    }
    if (base) {
      for (const char* key : kNotInherited) {
        base->document.erase(key);
        forget(base->written, pointer_to("", key));
      }
      if (!alike.document.empty()) lay_over(*base, base->document, alike, alike.document, "");
      lay_over(*base, base->document, own, own.document, "");
      return std::move(*base);
    }
    if (alike.document.empty()) return own;
    lay_over(alike, alike.document, own, own.document, "");
    return alike;
  }

  std::optional<Layer> base_of(const Layer& own, const std::string& file) {
    const JsonNode extends = JsonNode(own.document, "")["extends"];
    if (!extends) return std::nullopt;
    const auto refuse = [&](std::string why) {
      out_.faults.push_back({file, "/extends", std::move(why)});
      return std::nullopt;
    };
    const std::string name = extends.text();
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

  static std::vector<std::string> axes_of(const Layer& own, const std::optional<Layer>& base) {
    std::vector<std::string> axes = JsonNode(own.document, "").names("axes");
    if (axes.empty() && base) axes = JsonNode(base->document, "").names("axes");
    if (axes.empty()) axes = {"A"};
    return axes;
  }

  /// Objects key by key, anything else as a whole; a null takes out what the base has.
  void lay_over(Layer& base, json& target, const Layer& over, const json& node, const std::string& pointer) {
    base.written[pointer] = over.written.at(pointer);
    for (const auto& [key, value] : node.items()) {
      const std::string at = pointer_to(pointer, key);
      const auto known = target.find(key);
      if (value.is_null() && !null_is_a_value(key)) {
        if (known == target.end())
          fault(over, at, "would take out what this profile does not have from the one it extends");
        target.erase(key);
        forget(base.written, at);
      } else if (value.is_object() && known != target.end() && known->is_object()) {
        lay_over(base, *known, over, value, at);
      } else {
        target[key] = value;
        forget(base.written, at);
        copy(over.written, at, base.written);
      }
    }
  }

  void fault(const Layer& own, const std::string& pointer, std::string message) {
    const Written& written = own.written.at(pointer);
    out_.faults.push_back({written.file, written.pointer, std::move(message)});
  }

  /// Every entry of "each_axis", once for each axis.
  Layer each_axis(const Layer& own, const std::vector<std::string>& axes) {
    Layer out{json::object(), {}};
    const json* sections = member(own.document, "each_axis");
    if (sections == nullptr) return out;
    out.written[""] = own.written.at("");
    if (!sections->is_object()) {
      fault(own, "/each_axis", "must be object, is " + std::string(sections->type_name()));
      return out;
    }
    for (const auto& [section, entries] : sections->items()) {
      const std::string at = pointer_to("/each_axis", section);
      if (std::ranges::find(kEachAxisSections, section) == kEachAxisSections.end() || !entries.is_object()) {
        fault(own, at, "is not for each axis: only objects \"constants\", \"units\" and \"objects\" can be");
        continue;
      }
      for (const auto& [key, entry] : entries.items()) {
        const std::string from = pointer_to(at, key);
        if (key.find("$axis") == std::string::npos && key.find("$AXIS") == std::string::npos) {
          fault(own, from,
                "would be one name for all axes: write \"$AXIS.\" before an object's name, \"$axis\" elsewhere");
          continue;
        }
        for (const std::string& axis : axes) {
          std::string small = axis;
          std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return std::tolower(c); });
          const Replacements with{{{{"$axis", small}, {"$AXIS", axis}}}, axis};
          const std::string name = with.in(key);
          out.written[pointer_to("", section)] = own.written.at(at);
          json made = copied(own, entry, from, with, out, pointer_to(pointer_to("", section), name));
          out.document[section][name] = std::move(made);
        }
      }
    }
    return out;
  }

  /// `node`, which stands at `from`, with the words replaced; where its places come from is noted under `to`.
  json copied(const Layer& own, const json& node, const std::string& from, const Replacements& with, Layer& out,
              const std::string& to) {
    out.written[to] = own.written.at(from);
    if (node.is_string()) return with.in(node.get<std::string>());
    if (node.is_array()) {
      json list = json::array();
      for (std::size_t i = 0; i < node.size(); ++i)
        list.push_back(copied(own, node[i], pointer_to(from, i), with, out, pointer_to(to, i)));
      return list;
    }
    if (!node.is_object()) return node;
    if (!with.axis.empty() && is_one_for_each(node)) {
      const auto value = node.find(with.axis);
      if (value != node.end()) return copied(own, *value, pointer_to(from, with.axis), with, out, to);
      fault(own, from, "a value for axis \"" + with.axis + "\" is missing");
      return nullptr;
    }
    json made = json::object();
    for (const auto& [key, value] : node.items()) {
      const std::string name = with.in(key);
      made[name] = copied(own, value, pointer_to(from, key), with, out, pointer_to(to, name));
    }
    return made;
  }

  /// A check with "each" stands for as many checks.
  void repeat_checks(Layer& own) {
    const json* checks = member(own.document, "checks");
    if (checks == nullptr || !checks->is_array()) return;
    if (std::none_of(checks->begin(), checks->end(),
                     [](const json& check) { return member(check, "each") != nullptr; }))
      return;
    Layer out{json::array(), {}};
    for (std::size_t i = 0; i < checks->size(); ++i) {
      const std::string from = pointer_to("/checks", i);
      for (const std::string& name : repeated(own, (*checks)[i], from)) {
        std::string large = name;
        std::transform(large.begin(), large.end(), large.begin(), [](unsigned char c) { return std::toupper(c); });
        const Replacements with{{{{"$each", name}, {"$EACH", large}}}, ""};
        json entry = (*checks)[i];
        if (entry.is_object() && !name.empty()) entry.erase("each");
        const std::string to = pointer_to("/checks", out.document.size());
        json made = name.empty() ? entry : copied(own, entry, from, with, out, to);
        if (name.empty()) copy_under(own.written, from, out.written, to);
        out.document.push_back(std::move(made));
      }
    }
    const Written here = own.written.at("/checks");
    forget(own.written, "/checks");
    own.written["/checks"] = here;
    own.written.merge(out.written);
    own.document["checks"] = std::move(out.document);
  }

  /// The names to repeat it with; one without letters: as it is.
  std::vector<std::string> repeated(const Layer& own, const json& check, const std::string& at) {
    const json* each = member(check, "each");
    if (each == nullptr) return {""};
    const auto is_name = [](const json& entry) {
      if (!entry.is_string()) return false;
      const std::string& name = entry.get_ref<const std::string&>();
      return !name.empty() && name.size() <= 48 && std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
      });
    };
    if (each->is_array() && !each->empty() && each->size() <= kMaxEach &&
        std::all_of(each->begin(), each->end(), is_name))
      return each->get<std::vector<std::string>>();
    fault(own, pointer_to(at, "each"),
          "must be 1 to " + std::to_string(kMaxEach) + " names of small letters, digits and '_'");
    return {};
  }

  static void copy_under(const WrittenPlaces& from, const std::string& pointer, WrittenPlaces& to,
                         const std::string& under) {
    WrittenPlaces found;
    copy(from, pointer, found);
    for (const auto& [place, written] : found) to[under + place.substr(pointer.size())] = written;
  }

  const std::vector<std::string>& folders_;
  LayeredProfile out_;
};

}  // namespace

LayeredProfile layered_profile(const std::string& path, const std::vector<std::string>& folders) {
  return Composer(folders).result(path);
}

}  // namespace axisgate::profile
