#include "gateway/drive/profile_loader.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/drive/profile_reading.hpp"
#include "gateway/drive/profile_schema.hpp"

namespace axisgate::drive {

using nlohmann::json;

namespace {

/// Parsed once; a schema that does not parse is a mistake of the build.
const json& profile_schema() {
  static const json schema = json::parse(profile_schema_text());
  return schema;
}

void read_head(Reading& reading, const std::string& file) {
  Profile& out = reading.profile;
  out.name = text_in(reading.document, "name");
  out.title = text_in(reading.document, "title");
  out.nvm = nvm_named(text_in(reading.document, "nvm"));
  out.axes = names_in(reading.document, "axes");
  if (out.axes.empty()) out.axes = {"A"};
  if (std::set<std::string>(out.axes.begin(), out.axes.end()).size() != out.axes.size())
    reading.fault("/axes", "an axis is named twice");
  const std::string stem = std::filesystem::path(file).stem().string();
  // Configurations find a profile by its file's name, logs and maps show its own: they must be one.
  if (!out.name.empty() && out.name != stem)
    reading.fault("/name", "is \"" + out.name + "\", but the file is called \"" + stem + ".json\"");
}

}  // namespace

std::string text(const Fault& fault) {
  return fault.file + ": " + (fault.pointer.empty() ? std::string() : fault.pointer + ": ") + fault.message;
}

LoadedProfile load_profile(const std::string& path) {
  LoadedProfile out;
  out.file = path;
  std::variant<json, SchemaFault> loaded = load_json(path);
  if (const auto* fault = std::get_if<SchemaFault>(&loaded)) {
    out.faults.push_back({path, fault->pointer, fault->message});
    return out;
  }
  const json& document = std::get<json>(loaded);
  out.text = document.dump();
  std::vector<SchemaFault> faults = validate(document, profile_schema());
  Reading reading(document, out.profile, faults);
  read_head(reading, path);
  read_constants(reading);
  read_units(reading);
  read_protocols(reading);
  read_objects(reading);
  read_quantities(reading);
  read_modes(reading);
  read_configured_mode(reading);
  read_state(reading);
  read_homing(reading);
  read_commands(reading);
  read_setup(reading);
  read_checks(reading);
  read_alarms(reading);
  read_keepalive(reading);
  check_protocols(reading);
  check_keepalive(reading);
  read_constant_rules(reading);
  check_state_places(reading);
  for (SchemaFault& fault : faults) out.faults.push_back({path, std::move(fault.pointer), std::move(fault.message)});
  return out;
}

std::optional<std::string> find_profile(const std::string& name_or_path, const std::vector<std::string>& folders) {
  const auto is_file = [](const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
  };
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".json"))
    return is_file(name_or_path) ? std::optional(name_or_path) : std::nullopt;
  for (const std::string& folder : folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / (name_or_path + ".json");
    if (is_file(path)) return path.string();
  }
  return std::nullopt;
}

}  // namespace axisgate::drive
