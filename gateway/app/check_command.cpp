#include "gateway/app/check_command.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "gateway/app/check.hpp"
#include "gateway/app/faults_told.hpp"

namespace axisgate::app {

int run(const CheckOptions& options) {
  const LoadResult result = load_config(options.config, options.profile_folders);
  if (const auto* faults = std::get_if<std::vector<ConfigFault>>(&result)) return tell(*faults);
  const CheckReport report = check(std::get<LoadedConfig>(result));
  fmt::print("{}", report.text);
  if (!report.overloaded) return 0;
  std::fflush(stdout);
  fmt::print(stderr, "{}: a bus is planned over 100 %, see OVERLOADED above\n", options.config);
  return 1;
}

}  // namespace axisgate::app
