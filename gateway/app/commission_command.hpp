// `axisgate commission CONFIG AXIS`: shows the settings of a drive that a person must decide, and applies the remedies.
// Promises to change nothing before a yes.
// Never enables or moves an axis.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace axisgate::app {

struct CommissionOptions {
  std::string config;
  std::uint16_t axis = 0;
  std::vector<std::string> profile_folders;
  bool yes = false;  ///< apply the remedies without asking
};

[[nodiscard]] int run(const CommissionOptions& options);

}  // namespace axisgate::app
