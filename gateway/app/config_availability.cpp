#include <fmt/format.h>

#include <array>

#include "gateway/app/config_sections.hpp"

namespace axisgate::app {
namespace {

struct IdleKey {
  std::string_view key;
  std::string_view why;
};
constexpr std::array kIdleAxisKeys{
    IdleKey{"dds_unit", "DDS is not available in this version, so this has no effect"},
    IdleKey{"metres_per_rev", "DDS is not available in this version, so this has no effect"},
};

void warn_at_first_use(const ConfigNode& root, const IdleKey& idle, ConfigFaults& faults) {
  for (const ConfigNode& bus : root.items("buses")) {
    for (const ConfigNode& drive : bus.items("drives")) {
      for (const ConfigNode& axis : drive.items("axes")) {
        if (!axis.has(idle.key)) continue;
        faults.warn(axis.pointer(idle.key), idle.why);
        return;
      }
    }
  }
}

}  // namespace

void refuse_unavailable(const ConfigNode& root, ConfigFaults& faults) {
  for (const std::string_view face : {"dds", "http"}) {
    if (root.has(face)) {
      faults.add(root.pointer(face), fmt::format("{} is not available in this version: remove the key", face));
    }
  }
}

void warn_without_effect(const ConfigNode& root, ConfigFaults& faults) {
  for (const IdleKey& idle : kIdleAxisKeys) warn_at_first_use(root, idle, faults);
}

}  // namespace axisgate::app
