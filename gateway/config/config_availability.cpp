// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_sections.hpp"

namespace axisgate::config {
namespace {

void warn_at_first_use(const JsonNode& root, std::string_view key, ConfigFaults& faults) {
  for (const JsonNode& bus : root["buses"].items()) {
    for (const JsonNode& drive : bus["drives"].items()) {
      for (const JsonNode& axis : drive["axes"].items()) {
        if (!axis.has(key)) continue;
        faults.warn(axis.pointer(key), "without the key \"dds\" this has no effect");
        return;
      }
    }
  }
}

}  // namespace

void warn_without_effect(const JsonNode& root, ConfigFaults& faults) {
  if (root.has("dds")) return;
  for (const std::string_view key : {"dds_unit", "metres_per_rev"}) warn_at_first_use(root, key, faults);
}

}  // namespace axisgate::config
