// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/common/axis_place.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <vector>

namespace axisgate::commands {

std::optional<AxisPlace> find_axis(const config::LoadedConfig& loaded, const std::string& file,
                                   const std::string& called) {
  std::vector<AxisPlace> found;
  std::string all;
  const auto& models = loaded.models;
  for (std::size_t b = 0; b < models.size(); ++b)
    for (std::size_t d = 0; d < models[b].size(); ++d)
      for (std::size_t a = 0; a < models[b][d].axes.size(); ++a) {
        const model::AxisModel& axis = models[b][d].axes[a];
        if (called == std::to_string(axis.number) || called == axis.name)
          found.push_back({b, d, static_cast<AxisSlot>(a)});
        all += fmt::format("{}{} \"{}\"", all.empty() ? "" : ", ", axis.number, axis.name);
      }
  if (found.size() == 1) return found.front();
  fmt::print(stderr, "{}: {} axis {} in it: there are {}\n", file, found.empty() ? "no" : "more than one", called, all);
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
