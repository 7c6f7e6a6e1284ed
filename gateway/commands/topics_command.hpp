// SPDX-License-Identifier: Apache-2.0
// `axisgate topics [CONFIG]`: shows all axes live, as DDS subscribers see them. It becomes axisgate-dds.
// Promises to listen where the configuration says that the gateway speaks, and a clear word where it cannot.
// Never returns once that program runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace axisgate::commands {

struct TopicsOptions {
  std::string config;  ///< empty: none
  std::vector<std::string> profile_folders;
  std::optional<std::uint32_t> domain;  ///< goes before the configuration's
  std::vector<std::string> interfaces;  ///< the same
  bool all = false;                     ///< every gateway of the domain, not that of the configuration alone
  bool once = false;
  bool json = false;
};

[[nodiscard]] int run(const TopicsOptions& options);

}  // namespace axisgate::commands
