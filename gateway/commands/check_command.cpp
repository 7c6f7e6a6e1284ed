// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commands.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>

#include "gateway/check/check.hpp"
#include "gateway/commands/common/config_faults.hpp"
#include "gateway/process/descriptor_needs.hpp"
#include "gateway/upstream/dds_host/dds_program.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"
#include "gateway/upstream/web_host/web_program.hpp"

namespace axisgate::commands {

namespace {

/// The loader compares names; which line a name leads to only this machine knows.
void warn_of_lines_with_two_names(const config::Config& config) {
  constexpr std::string_view kSerialCan = "slcan:";
  std::map<std::filesystem::path, std::string> lines;
  for (const config::BusConfig& bus : config.buses) {
    std::error_code not_here;  // of another machine, or the name of a CAN interface
    const std::string path = bus.device.substr(bus.device.starts_with(kSerialCan) ? kSerialCan.size() : 0);
    const auto line = std::filesystem::canonical(path, not_here);
    if (not_here) continue;
    const auto [first, is_new] = lines.emplace(line, bus.device);
    if (!is_new)
      fmt::print("warning: {} and {} are one line, {}: put the drives of one line into one bus\n", first->second,
                 bus.device, line.string());
  }
}

/// The program is there, or what will be missing.
void say_where(const host::HostedProgram& program, std::string_view missing, std::string_view does) {
  const host::FoundProgram found = host::find_program(program);
  if (found.path.empty())
    fmt::print("warning: there will be no {}, {} is not installed: {}\n", missing, program.name, found.why_not);
  else
    fmt::print("{}, which {}: {}\n", program.name, does, found.path);
}

}  // namespace

int run(const CheckOptions& options) {
  const config::LoadResult result =
      config::load_config(options.config, options.profile_folders, profile::Pipes::allowed);
  if (const auto* faults = std::get_if<std::vector<config::ConfigFault>>(&result)) return tell(*faults);
  const auto& loaded = std::get<config::LoadedConfig>(result);
  const check::CheckReport report = check::report(loaded);
  fmt::print("{}", report.text);
  const auto descriptors =
      modbus_tcp::plan_descriptors(modbus_tcp::descriptor_limits(), process::descriptor_needs(loaded.config));
  // The limit belongs to a process, not to the file: a service may have another.
  if (descriptors.limited()) fmt::print("warning: started from here, {}\n", modbus_tcp::text(descriptors));
  warn_of_lines_with_two_names(loaded.config);
  if (loaded.config.dds) say_where(dds::kProgram, "DDS topics", "publishes the topics");
  if (loaded.config.web) say_where(web::kProgram, "page", "serves the page");
  if (!report.overloaded) return 0;
  std::fflush(stdout);
  fmt::print(stderr, "{}: a bus is planned over 100 %, see OVERLOADED above\n", options.config);
  return 1;
}

}  // namespace axisgate::commands
