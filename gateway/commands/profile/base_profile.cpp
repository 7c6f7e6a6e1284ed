// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/profile/base_profile.hpp"

#include "gateway/profile/read/profile_loader.hpp"

namespace axisgate::commands {

BaseProfile base_profile(const std::string& name, const std::vector<std::string>& folders) {
  const auto path = profile::find_profile(name, folders);
  if (!path) return {nullptr, {{name, "", "there is no such profile in the folders of profiles"}}};
  return {profile::layered_profile(*path, folders).document, profile::load_profile(*path, folders).faults};
}

}  // namespace axisgate::commands
