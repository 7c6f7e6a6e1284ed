// SPDX-License-Identifier: Apache-2.0
// `axisgate profile check FILE [--eds FILE]`: validates a drive profile, says what it gives on each protocol, and holds
// it against the maker's EDS. Promises every mistake at once, each with its file and place.
// Never asks a drive.
#pragma once

#include <string>
#include <vector>

namespace axisgate::commands {

struct ProfileCheckOptions {
  std::string file;
  std::string eds;  ///< empty: none
  std::vector<std::string> profile_folders{};
};

[[nodiscard]] int run(const ProfileCheckOptions& options);

}  // namespace axisgate::commands
