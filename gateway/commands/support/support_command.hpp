// SPDX-License-Identifier: Apache-2.0
// `axisgate support CONFIG`: one archive for whoever helps, of all that this computer knows of a gateway.
// Promises that its list is shown and agreed to before anything is written, that no file is written over, and that the
// archive can be read by its owner alone. Never sends anything anywhere, never writes a register and never owns an
// axis.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace axisgate::commands {

struct SupportOptions {
  std::string config;
  std::vector<std::string> profile_folders{};
  std::string output;                         ///< the archive; empty: axisgate-support-TIME.tar.gz in this folder
  bool yes = false;                           ///< write it without a question
  std::string axisgate = "/proc/self/exe";    ///< the program that is asked for what `check` and `top` say
  std::chrono::milliseconds patience{10000};  ///< with each program that is asked, and each answer of the page
};

/// Exit status: 0 written, also where something could not be had; 1 not written.
[[nodiscard]] int run(const SupportOptions& options);

}  // namespace axisgate::commands
