#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gateway/app/config_sections.hpp"

namespace axisgate::app {
namespace {

/// Adapters that the schema knows and this version has not.
constexpr std::array<std::string_view, 3> kMissingAdapters{"keya-can", "keya-rs232", "keya-rs485"};

struct IdleKey {
  std::string_view key;
  std::string_view why;
};
constexpr std::array kIdleAxisKeys{
    IdleKey{"jog_timeout_ms", "jog is not available in this version, so this has no effect"},
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
  for (const ConfigNode& bus : root.items("buses")) {
    const auto adapter = bus.string("adapter").value_or("");
    if (std::find(kMissingAdapters.begin(), kMissingAdapters.end(), adapter) != kMissingAdapters.end()) {
      faults.add(bus.pointer("adapter"),
                 fmt::format("{} is not available in this version, which has canopen, kinco-serial and modbus-rtu: "
                             "remove this bus",
                             adapter));
    }
  }
}

void warn_without_effect(const ConfigNode& root, ConfigFaults& faults) {
  for (const IdleKey& idle : kIdleAxisKeys) warn_at_first_use(root, idle, faults);
}

}  // namespace axisgate::app
