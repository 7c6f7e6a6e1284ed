// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/read/profile_loader.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

void read_head(Reading& reading, const std::string& file) {
  Profile& out = reading.profile;
  out.name = reading.document.text("name");
  out.title = reading.document.text("title");
  out.nvm = nvm_named(reading.document.text("nvm"));
  out.axes = reading.document.names("axes");
  out.only_simulated = reading.document.text("tried") == "simulated";
  if (out.axes.empty()) out.axes = {"A"};
  for (const JsonNode& protocol : reading.document["protocols"].members()) out.protocols[protocol.key()];
  if (std::set<std::string>(out.axes.begin(), out.axes.end()).size() != out.axes.size())
    reading.fault("/axes", "an axis is named twice");
  const std::string stem = std::filesystem::path(file).stem().string();
  // Configurations find a profile by its file's name, logs and maps show its own: they must be one.
  if (!out.name.empty() && out.name != stem)
    reading.fault("/name", "is \"{}\", but the file is called \"{}.json\"", out.name, stem);
}

void read_identity(Reading& reading) {
  const JsonNode node = reading.document["identity"];
  if (!node.is_object()) return;
  if (!reading.profile.protocols.contains("canopen"))
    reading.fault(node.pointer(), "belongs to canopen, which this drive does not speak: no other protocol has 1018h");
  IdentitySpec& out = reading.profile.identity.emplace();
  for (std::size_t i = 0; i < IdentitySpec::kNames.size(); ++i) {
    for (const std::int64_t number : node.wholes(IdentitySpec::kNames[i])) {
      if (number < 0 || number > UINT32_MAX)
        reading.fault(node.pointer(IdentitySpec::kNames[i]), "{} is no number of 32 bits", number);
      out.numbers[i].push_back(static_cast<std::uint32_t>(number));
    }
  }
}

void read_asks(Reading& reading) {
  for (const JsonNode& node : reading.document["ask"].elements()) {
    Ask ask{node.text("of"), node.text("text"), node.text("where"), node.names("before"), node.pointer()};
    if (!ask.of.starts_with('/')) static_cast<void>(reading.constant_named(ask.of, node.pointer("of")));
    reading.profile.asks.push_back(std::move(ask));
  }
}

}  // namespace

Written written_at(const WrittenPlaces& places, const std::string& pointer) {
  for (std::size_t end = pointer.size();; end = pointer.rfind('/', end - 1)) {
    const auto known = places.find(std::string_view(pointer).substr(0, end));
    if (known != places.end()) return {known->second.file, known->second.pointer + pointer.substr(end)};
    if (end == 0) return {"", pointer};
  }
}

namespace {

LoadedProfile judged(const std::string& path, const std::vector<std::string>& folders) {
  LoadedProfile out{layered_profile(path, folders), path, {}, {}, {}};
  if (!out.faults.empty()) return out;
  const json& document = *out.document;
  out.text = document.dump();
  out.base_only = JsonNode(document, "").flag("base_only", false);
  if (out.base_only) {
    out.faults.push_back({path, "/base_only", "is no drive but a base: name or check a profile that extends it"});
    return out;
  }
  out.profile.document = out.document;
  static const JsonSchema kSchema(profile_schema_text());
  std::vector<SchemaFault> faults = kSchema.faults_in(document);
  Reading reading(document, out.profile, faults);
  read_head(reading, path);
  read_constants(reading);
  read_asks(reading);
  read_units(reading);
  read_identity(reading);
  read_objects(reading);
  read_quantities(reading);
  read_modes(reading);
  check_configured_mode(reading);
  read_state(reading);
  read_homing(reading);
  read_commands(reading);
  check_setup(reading);
  check_checks(reading);
  read_alarms(reading);
  read_protocols(reading);
  check_keepalive(reading);
  check_unsolicited_writes(reading);
  check_stops_start_nothing(reading);
  check_shared(reading);
  check_constant_rules(reading);
  for (SchemaFault& fault : faults) {
    Written written = written_at(out.written, fault.pointer);
    Fault told{std::move(written.file), std::move(written.pointer), std::move(fault.message)};
    // It may be right by itself: what is missing there may have been taken out here.
    if (told.file != path) told.message += " (as extended by " + std::filesystem::path(path).filename().string() + ")";
    // What is written once for all axes is wrong once.
    if (std::ranges::find(out.faults, told) == out.faults.end()) out.faults.push_back(std::move(told));
  }
  return out;
}

}  // namespace

LoadedProfile load_profile(const std::string& path, const std::vector<std::string>& folders) {
  LoadedProfile out = judged(path, folders);
  locate(out.faults, out.read);
  return out;
}

std::optional<std::string> find_profile(const std::string& name_or_path, const std::vector<std::string>& folders,
                                        std::vector<FileRead>* missed) {
  std::error_code error;
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".json"))
    return std::filesystem::is_regular_file(name_or_path, error) ? std::optional(name_or_path) : std::nullopt;
  for (const std::string& folder : folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / (name_or_path + ".json");
    if (std::filesystem::is_regular_file(path, error)) return path.string();
    if (missed != nullptr) missed->push_back({path.string()});
  }
  return std::nullopt;
}

}  // namespace axisgate::profile
