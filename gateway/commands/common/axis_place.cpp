// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/common/axis_place.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace axisgate::commands {

std::optional<AxisPlace> find_axis(const config::LoadedConfig& loaded, const std::string& file, AxisNumber number) {
  const auto& models = loaded.models;
  for (std::size_t b = 0; b < models.size(); ++b)
    for (std::size_t d = 0; d < models[b].size(); ++d)
      for (std::size_t a = 0; a < models[b][d].axes.size(); ++a)
        if (models[b][d].axes[a].number == number) return AxisPlace{b, d, static_cast<AxisSlot>(a)};
  fmt::print(stderr, "{}: no axis {} in it\n", file, number);
  return std::nullopt;
}

std::string text(const config::LoadedConfig& loaded, const AxisPlace& place) {
  const auto& model = loaded.models[place.bus][place.drive];
  const config::BusConfig& bus = loaded.config.buses[place.bus];
  return fmt::format("axis {} \"{}\": {}, node {} on {} ({})", model.axes[place.slot].number,
                     model.axes[place.slot].name, model.title, model.node, bus.name, bus.device);
}

bool keep_stdin_taken() { return ::fcntl(STDIN_FILENO, F_GETFD) >= 0 || ::open("/dev/null", O_RDONLY) == STDIN_FILENO; }

}  // namespace axisgate::commands
