// SPDX-License-Identifier: Apache-2.0
// The profile that a made one extends, put together from its files.
// Promises the document of a profile without a mistake, or why there is none. Never changes it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/config/config_fault.hpp"

namespace axisgate::commands {

struct BaseProfile {
  std::shared_ptr<const nlohmann::json> document;
  std::vector<config::ConfigFault> faults;
};

[[nodiscard]] BaseProfile base_profile(const std::string& name, const std::vector<std::string>& folders);

}  // namespace axisgate::commands
