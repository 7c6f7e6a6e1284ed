// SPDX-License-Identifier: Apache-2.0
// A configuration of one bus with drives of the shipped profiles, loaded as the gateway loads its own.
// Never decides what is right: the tests do.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "gateway/config/bus_budget.hpp"
#include "gateway/config/config_loader.hpp"
#include "tests/places.hpp"

namespace axisgate::config {

/// `bus`: its members beside "drives", in JSON.
[[nodiscard]] inline LoadedConfig load_one_bus(const std::string& bus, const std::string& drives) {
  const auto file = std::filesystem::temp_directory_path() / ("axisgate-bus-" + std::to_string(getpid()) + ".json");
  std::ofstream(file) << R"({"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "buses": [{)" << bus << R"(, "drives": [)"
                      << drives << "]}]}";
  LoadResult result = load_config(file, {test::source_path("schemas/drives")});
  std::filesystem::remove(file);
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) {
    for (const ConfigFault& fault : *faults) ADD_FAILURE() << text(fault);
    std::abort();
  }
  return std::move(std::get<LoadedConfig>(result));
}

[[nodiscard]] inline const BusConfig& bus_of(const LoadedConfig& loaded) { return loaded.config.buses.at(0); }
[[nodiscard]] inline BusBudget plan_of(const LoadedConfig& loaded) {
  return plan_bus(timing_of(bus_of(loaded)), loaded.models.at(0));
}

}  // namespace axisgate::config
