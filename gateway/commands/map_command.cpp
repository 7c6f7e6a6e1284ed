// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "gateway/commands/common/config_faults.hpp"
#include "gateway/config/config_loader.hpp"
#include "gateway/listing/map_listing.hpp"

namespace axisgate::commands {
namespace {

listing::ListedAxis listed(const config::AxisConfig& config, const model::AxisModel& model, const std::string& bus) {
  listing::ListedAxis axis;
  axis.number = config.number;
  axis.name = config.name;
  axis.bus = bus;
  static_cast<Capabilities&>(axis) = model;
  axis.position_unit = listing::position_unit(config.units_per_rev.numerator(), config.units_per_rev.denominator());
  return axis;
}

using modbus_tcp::address_text;
using Listener = modbus_tcp::ListenerSettings;

bool shows_the_same(const Listener& a, const Listener& b) {
  return a.low_word_first == b.low_word_first && a.float_numbers == b.float_numbers &&
         a.per_axis_units == b.per_axis_units;
}

/// What this listing cannot show: stdout is for an import.
void tell_differences(const std::vector<Listener>& listeners, const Listener& shown) {
  const std::string name = address_text(shown.host, shown.port);
  if (shown.per_axis_units)
    fmt::print(
        stderr,
        "axisgate map: {} has \"unit_ids\": \"per-axis\": these addresses are those of unit 255; unit N shows axis N "
        "alone, from address 0 on\n",
        name);
  for (const Listener& other : listeners)
    if (!shows_the_same(shown, other))
      fmt::print(stderr, "axisgate map: this is the map of {}; {} shows it otherwise: --listener {}\n", name,
                 address_text(other.host, other.port), address_text(other.host, other.port));
}

/// Of standard output; 0: it is none.
std::size_t terminal_columns() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

listing::ListedMap listed(const config::LoadedConfig& loaded, const Listener& listener) {
  listing::ListedMap map;
  map.low_word_first = listener.low_word_first;
  map.float_numbers = listener.float_numbers;
  for (std::size_t b = 0; b < loaded.config.buses.size(); ++b) {
    const config::BusConfig& bus = loaded.config.buses[b];
    map.buses.push_back(bus.name);
    for (std::size_t d = 0; d < bus.drives.size(); ++d) {
      const model::DriveModel& model = loaded.models[b][d];
      for (std::size_t a = 0; a < model.axes.size(); ++a)
        map.axes.push_back(listed(bus.drives[d].axes[a], model.axes[a], bus.name));
    }
  }
  std::ranges::sort(map.axes,
                    [](const listing::ListedAxis& a, const listing::ListedAxis& b) { return a.number < b.number; });
  return map;
}

}  // namespace

int run(const MapOptions& options) {
  const config::LoadResult result =
      config::load_config(options.config, options.profile_folders, profile::Pipes::allowed);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
  const auto& loaded = std::get<config::LoadedConfig>(result);
  const std::vector<Listener>& listeners = loaded.config.modbus_tcp;
  const auto wanted = [&](const Listener& each) {
    return options.listener.empty() || address_text(each.host, each.port) == options.listener;
  };
  const auto listener = std::ranges::find_if(listeners, wanted);
  if (listener == listeners.end()) {
    fmt::print(stderr, "{}: /modbus_tcp: no listener has \"listen\": \"{}\": give one of the configuration's\n",
               options.config, options.listener);
    return 1;
  }
  tell_differences(listeners, *listener);
  // The command line has checked the name.
  const listing::MapFormat format = listing::map_format_named(options.format).value_or(listing::MapFormat::table);
  fmt::print("{}", listing::map_text(listed(loaded, *listener), format, terminal_columns()));
  return 0;
}

}  // namespace axisgate::commands
