// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/map_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/commands/common/faults_told.hpp"
#include "gateway/config/config_loader.hpp"
#include "gateway/image/listing/map_listing.hpp"

namespace axisgate::app {
namespace {

ListedAxis listed(const AxisConfig& config, const drive::AxisModel& model, const std::string& bus) {
  ListedAxis axis;
  axis.number = config.number;
  axis.name = config.name;
  axis.bus = bus;
  static_cast<Capabilities&>(axis) = model;
  axis.position_unit = position_unit(config.units_per_rev.numerator(), config.units_per_rev.denominator());
  return axis;
}

ListedMap listed(const LoadedConfig& loaded) {
  ListedMap map;
  // Listeners may differ; the first one is what a configuration is made for.
  map.low_word_first = loaded.config.modbus_tcp.front().low_word_first;
  map.float_numbers = loaded.config.modbus_tcp.front().float_numbers;
  for (std::size_t b = 0; b < loaded.config.buses.size(); ++b) {
    const BusConfig& bus = loaded.config.buses[b];
    map.buses.push_back(bus.name);
    for (std::size_t d = 0; d < bus.drives.size(); ++d) {
      const drive::DriveModel& model = loaded.models[b][d];
      for (std::size_t a = 0; a < model.axes.size(); ++a)
        map.axes.push_back(listed(bus.drives[d].axes[a], model.axes[a], bus.name));
    }
  }
  std::sort(map.axes.begin(), map.axes.end(),
            [](const ListedAxis& a, const ListedAxis& b) { return a.number < b.number; });
  return map;
}

}  // namespace

int run(const MapOptions& options) {
  const LoadResult result = load_config(options.config, options.profile_folders);
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) return tell(*faults);
  // The command line has checked the name.
  const MapFormat format = map_format_named(options.format).value_or(MapFormat::table);
  fmt::print("{}", map_text(listed(std::get<LoadedConfig>(result)), format));
  return 0;
}

}  // namespace axisgate::app
