// SPDX-License-Identifier: Apache-2.0
// Reads a configuration file and everything it needs: the profiles of its drives, resolved into models.
// Promises either a configuration that is right in every respect, or every mistake at once, each with its file,
// line and place. Never opens a port or creates anything: a wrong configuration leaves no trace.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "gateway/config/config.hpp"
#include "gateway/config/config_fault.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::config {

struct LoadedConfig {
  Config config;
  /// Nothing wrong, but worth knowing: one line each, with file and place.
  std::vector<std::string> warnings;
  /// models[bus][drive], in the order of `config`.
  std::vector<std::vector<model::DriveModel>> models;
};

using LoadResult = std::variant<LoadedConfig, std::vector<ConfigFault>>;

/// `profile_folders` are searched in their order for profiles that are given by name.
[[nodiscard]] LoadResult load_config(const std::string& file, const std::vector<std::string>& profile_folders,
                                     profile::Pipes pipes = profile::Pipes::refused,
                                     OpenAsks open_asks = OpenAsks::refused);

}  // namespace axisgate::config
