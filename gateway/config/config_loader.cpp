// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_loader.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/config/config_schema.hpp"
#include "gateway/config/config_sections.hpp"
#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::config {
namespace {

void check_schema(const nlohmann::json& document, ConfigFaults& faults) {
  static const profile::JsonSchema kSchema(gateway_schema_text());
  for (const profile::SchemaFault& fault : kSchema.faults_in(document)) faults.add(fault.pointer, fault.message);
}

/// Per-axis unit ids have room for 254 axes.
void warn_about_unit_ids(const Config& config, ConfigFaults& faults) {
  constexpr AxisNumber kLastUnit = 254;
  for (std::size_t i = 0; i < config.modbus_tcp.size(); ++i) {
    if (!config.modbus_tcp[i].per_axis_units) continue;
    each_axis(config.buses, [&](const AxisConfig& axis) {
      if (axis.number > kLastUnit)
        faults.warn(axis.pointer + "/axis",
                    fmt::format("/modbus_tcp/{} gives each axis a unit id, which reach axes 1 to 254: axis {} is seen "
                                "through unit 255 only",
                                i, axis.number));
    });
  }
}

}  // namespace

LoadResult load_config(const std::string& file, const std::vector<std::string>& profile_folders, profile::Pipes pipes,
                       OpenAsks open_asks) {
  ConfigFaults faults(file);
  LoadedConfig loaded;
  auto read = profile::load_json(file, loaded.config.read, pipes);
  if (const auto* fault = std::get_if<profile::SchemaFault>(&read)) {
    faults.add(ConfigFault{file, fault->pointer, fault->message, fault->place});
    return faults.faults();
  }
  const auto& document = std::get<nlohmann::json>(read);
  check_schema(document, faults);

  const JsonNode root(document, "");
  loaded.config.file = file;
  if (root.is_object()) {
    loaded.config.modbus_tcp = read_listeners(root, faults);
    loaded.config.buses = read_buses(root, faults);
    loaded.config.dds = read_dds(root, loaded.config.buses, faults);
    if (loaded.config.dds) loaded.config.read_by_dds = read_files_of_dds(*loaded.config.dds);
    loaded.config.web = read_web(root, loaded.config, faults);
    check_unique(loaded.config, faults);
    warn_about_unit_ids(loaded.config, faults);
    loaded.models = load_models(loaded.config, profile_folders, open_asks, faults);
    if (faults.faults().empty()) {
      settle_rtu_buses(loaded.config, loaded.models, faults);
      settle_can_buses(loaded.config, loaded.models, faults);
      settle_keya_buses(loaded.config, loaded.models, faults);
    }
  }
  faults.locate(loaded.config.read);
  if (!faults.faults().empty()) return faults.faults();
  for (const ConfigFault& warning : faults.warnings()) loaded.warnings.push_back(text(warning));
  return loaded;
}

}  // namespace axisgate::config
