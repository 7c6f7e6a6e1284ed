// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/check_command.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "gateway/check/check.hpp"
#include "gateway/commands/common/faults_told.hpp"
#include "gateway/process/descriptor_needs.hpp"
#include "gateway/upstream/dds_host/program.hpp"
#include "gateway/upstream/modbus_tcp/server/descriptors.hpp"

namespace axisgate::app {

int run(const CheckOptions& options) {
  const LoadResult result = load_config(options.config, options.profile_folders);
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) return tell(*faults);
  const auto& loaded = std::get<LoadedConfig>(result);
  const CheckReport report = check(loaded);
  fmt::print("{}", report.text);
  const auto descriptors =
      modbus_tcp::plan_descriptors(modbus_tcp::descriptor_limits(), descriptor_needs(loaded.config));
  // The limit belongs to a process, not to the file: a service may have another.
  if (descriptors.limited()) fmt::print("warning: started from here, {}\n", modbus_tcp::text(descriptors));
  if (loaded.config.dds) {
    const dds::Program program = dds::find_program();
    if (program.path.empty())
      fmt::print("warning: there will be no DDS topics, axisgate-dds is not installed: {}\n", program.why_not);
    else
      fmt::print("axisgate-dds, which publishes the topics: {}\n", program.path);
  }
  if (!report.overloaded) return 0;
  std::fflush(stdout);
  fmt::print(stderr, "{}: a bus is planned over 100 %, see OVERLOADED above\n", options.config);
  return 1;
}

}  // namespace axisgate::app
