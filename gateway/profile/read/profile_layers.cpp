// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "gateway/profile/read/profile_loader.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a base says of itself alone.
constexpr std::array kNotInherited{"$schema", "name", "base_only", "tried"};
/// Sections whose entries can be written once for all motors.
constexpr std::array kEachAxisSections{"constants", "units", "objects"};

/// Keys of which null says what the drive does not have. Of "loss" leaving it out would not say that.
constexpr std::array kNullable{"loss", "heartbeat_ms", "broadcast"};
bool null_is_a_value(const std::string& key) { return std::ranges::find(kNullable, key) != kNullable.end(); }

/// What takes the place of words in one copy of an entry: "$axis" -> "a", "$AXIS" -> "A".
struct Replacements {
  std::vector<std::pair<std::string, std::string>> words;
  std::string axis;  ///< "A": its values are taken where there is one for each axis; empty: there are none

  [[nodiscard]] std::string in(std::string text) const {
    for (const auto& [word, with] : words) boost::replace_all(text, word, with);
    return text;
  }
  /// One of the values of {"A": 4, "B": 6}.
  [[nodiscard]] bool chooses_in(const json& value) const {
    if (axis.empty() || !value.is_object() || value.empty()) return false;
    for (const auto& [key, one] : value.items())
      if (key.size() != 1 || key[0] < 'A' || key[0] > 'D') return false;
    return true;
  }
};

class Composer {
 public:
  explicit Composer(const std::vector<std::string>& folders) : folders_(folders) {}

  LayeredProfile result(const std::string& path) {
    compose(path);
    out_.document = std::make_shared<const json>(std::move(document_));
    return std::move(out_);
  }

 private:
  /// Lays a file over what it extends.
  void compose(const std::string& file) {
    out_.files.push_back(file);
    std::variant<json, SchemaFault> loaded = load_json(file, out_.read);
    if (auto* wrong = std::get_if<SchemaFault>(&loaded)) {
      out_.faults.push_back({file, wrong->pointer, wrong->message, wrong->place});
      return;
    }
    const json& own = std::get<json>(loaded);
    if (!own.is_object()) {  // the schema says so
      document_ = copied(own, "", {file, ""}, {});
      return;
    }
    if (own.contains("extends")) extend(own["extends"], file);
    for (const char* key : kNotInherited) document_.erase(key);
    out_.written[""] = {file, ""};
    has_base_ = !document_.empty();
    if (own.contains("each_axis")) each_axis(own["each_axis"], {file, "/each_axis"}, axes_in(own));
    has_base_ = !document_.empty();
    for (const auto& [key, value] : own.items()) {
      const Written from{file, pointer_to("", key)};
      if (key == "checks" && value.is_array())
        repeat_checks(value, from);
      else if (key != "extends" && key != "each_axis")
        lay(document_, "", key, value, from, {});
    }
  }

  void extend(const json& extends, const std::string& file) {
    const auto refuse = [&](std::string why) { out_.faults.push_back({file, "/extends", std::move(why)}); };
    const std::string name = extends.is_string() ? extends.get<std::string>() : "";
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
    compose(*base);
    if (document_.is_object()) return;
    fault({*base, ""}, "must be object, is " + std::string(document_.type_name()));
    document_ = json::object();
  }

  /// A profile may extend one of its own name in another folder: it is never its own base.
  [[nodiscard]] std::optional<std::string> find_base(const std::string& file, const std::string& name) {
    std::vector<std::string> folders{fs::path(file).parent_path().string()};
    folders.insert(folders.end(), folders_.begin(), folders_.end());
    for (const std::string& folder : folders) {
      const std::optional<std::string> found = find_profile(name, {folder}, &out_.read);
      std::error_code error;
      if (found && !fs::equivalent(*found, file, error)) return found;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::string> axes_in(const json& own) const {
    std::vector<std::string> axes = JsonNode(own.contains("axes") ? own : document_, "").names("axes");
    return axes.empty() ? std::vector<std::string>{"A"} : axes;
  }

  /// Objects key by key, anything else as a whole; a null takes out what the base has.
  void lay(json& target, const std::string& parent, const std::string& key, const json& value, const Written& from,
           const Replacements& with) {
    const std::string name = with.in(key), at = pointer_to(parent, name);
    if (target.contains(name) && target[name].is_object() && value.is_object() && !with.chooses_in(value)) {
      out_.written[at] = from;
      for (const auto& [inner, part] : value.items())
        lay(target[name], at, inner, part, {from.file, pointer_to(from.pointer, inner)}, with);
      return;
    }
    if (!value.is_null() || !has_base_ || null_is_a_value(name)) {
      target[name] = copied(value, at, from, with);
    } else if (target.contains(name)) {
      target.erase(name);
      std::erase_if(out_.written, [&](const auto& known) { return (known.first + "/").starts_with(at + "/"); });
    } else {
      fault(from, "would take out what this profile does not have from the one it extends");
    }
  }

  void fault(const Written& at, std::string message) {
    out_.faults.push_back({at.file, at.pointer, std::move(message)});
  }

  /// Every entry of "each_axis", once for each axis.
  void each_axis(const json& sections, const Written& from, const std::vector<std::string>& axes) {
    if (!sections.is_object()) return fault(from, "must be object, is " + std::string(sections.type_name()));
    for (const auto& [section, entries] : sections.items()) {
      const Written here{from.file, pointer_to(from.pointer, section)};
      if (std::ranges::find(kEachAxisSections, section) == kEachAxisSections.end() || !entries.is_object()) {
        fault(here, "is not for each axis: only objects \"constants\", \"units\" and \"objects\" can be");
        continue;
      }
      out_.written["/" + section] = here;
      for (const auto& [key, value] : entries.items()) {
        const Written entry{from.file, pointer_to(here.pointer, key)};
        if (key.find("$axis") == std::string::npos && key.find("$AXIS") == std::string::npos) {
          fault(entry, "would be one name for all axes: write \"$AXIS.\" before an object's name, \"$axis\" elsewhere");
          continue;
        }
        json& target = document_[section];
        if (!target.is_object()) target = json::object();
        for (const std::string& axis : axes)
          lay(target, "/" + section, key, value, entry,
              {{{"$axis", boost::to_lower_copy(axis)}, {"$AXIS", axis}}, axis});
      }
    }
  }

  json copied(const json& value, const std::string& at, const Written& from, const Replacements& with) {
    if (with.chooses_in(value)) {
      if (!value.contains(with.axis)) fault(from, "a value for axis \"" + with.axis + "\" is missing");
      return value.contains(with.axis)
                 ? copied(value[with.axis], at, {from.file, pointer_to(from.pointer, with.axis)}, with)
                 : json();
    }
    out_.written[at] = from;
    if (value.is_string()) return with.in(value.get<std::string>());
    if (!value.is_structured()) return value;
    json out(value.type());
    for (const auto& [key, part] : value.items()) {
      const std::string name = with.in(key);
      json copy = copied(part, pointer_to(at, name), {from.file, pointer_to(from.pointer, key)}, with);
      if (value.is_array())
        out.push_back(std::move(copy));
      else
        out[name] = std::move(copy);
    }
    return out;
  }

  /// A check with "each" stands for as many checks.
  void repeat_checks(const json& checks, const Written& from) {
    json out = json::array();
    out_.written["/checks"] = from;
    for (std::size_t i = 0; i < checks.size(); ++i) {
      json check = checks[i];
      const Written here{from.file, pointer_to(from.pointer, i)};
      const auto add = [&](const Replacements& with) {
        out.push_back(copied(check, pointer_to("/checks", out.size()), here, with));
      };
      if (!check.is_object() || !check.contains("each")) {
        add({});
        continue;
      }
      const std::vector<std::string> names = names_in(check["each"], {from.file, here.pointer + "/each"});
      check.erase("each");
      for (const std::string& name : names) add({{{"$each", name}, {"$EACH", boost::to_upper_copy(name)}}, ""});
    }
    document_["checks"] = std::move(out);
  }

  std::vector<std::string> names_in(const json& each, const Written& from) {
    const auto is_name = [](const json& name) {
      const std::string text = name.is_string() ? name.get<std::string>() : "";
      return !text.empty() && text.size() <= 48 && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
      });
    };
    if (each.is_array() && !each.empty() && each.size() <= kMaxEach && std::ranges::all_of(each, is_name))
      return each.get<std::vector<std::string>>();
    fault(from, "must be 1 to " + std::to_string(kMaxEach) + " names of small letters, digits and '_'");
    return {};
  }

  const std::vector<std::string>& folders_;
  LayeredProfile out_;
  json document_ = json::object();
  bool has_base_ = false;  ///< what is laid over `document_` changes it
};

}  // namespace

LayeredProfile layered_profile(const std::string& path, const std::vector<std::string>& folders) {
  return Composer(folders).result(path);
}

}  // namespace axisgate::profile
