// SPDX-License-Identifier: Apache-2.0
// `axisgate explain [WORD|CODE]`: what a state, alarm, result, exception, abort code or a drive's fault code means,
// what usually causes it and what to do. Promises to answer from the table that the program itself uses and from the
// drive profiles. Never asks a gateway or a drive.
#pragma once

#include <string>
#include <vector>

namespace axisgate::commands {

struct ExplainOptions {
  std::vector<std::string> words;  ///< "result 9" comes as two; empty: all there is
  bool page = false;               ///< docs/troubleshooting.md
  std::vector<std::string> profile_folders{};
};

/// What there is to say; empty: nothing is called so.
[[nodiscard]] std::string explanation(const std::string& typed, const std::vector<std::string>& profile_folders);

/// Exit code 1: nothing is called so.
[[nodiscard]] int run(const ExplainOptions& options);

}  // namespace axisgate::commands
