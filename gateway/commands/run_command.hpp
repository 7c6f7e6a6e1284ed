// SPDX-License-Identifier: Apache-2.0
// `axisgate run CONFIG`: the gateway itself.
// Promises to return only when it was asked to end (SIGINT, SIGTERM) or could not start, with the process's exit code.
// Never opens anything where the configuration is wrong.
#pragma once

#include <string>
#include <vector>

#include "gateway/core/log.hpp"

namespace axisgate::commands {

struct RunOptions {
  std::string config;
  std::vector<std::string> profile_folders;
  LogLevel log_level = LogLevel::info;
  std::vector<std::string> decode;  ///< names of buses whose frames are logged
};

[[nodiscard]] int run(const RunOptions& options);

}  // namespace axisgate::commands
