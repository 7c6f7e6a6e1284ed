// SPDX-License-Identifier: Apache-2.0
// Where shipped profiles lie: beside the build, beside the installed program, or in the system's place.
// Promises the folders in the order in which they are searched, the one given by the user first.
// Never creates one.
#pragma once

#include <string>
#include <vector>

#include "gateway/profile/read/profile.hpp"

namespace axisgate::commands {

/// What is wrong with a folder that --profiles names; empty: nothing.
[[nodiscard]] std::string no_folder(const std::string& given);

/// `given`: option --profiles, may be empty.
[[nodiscard]] std::vector<std::string> profile_folders(const std::string& given);

/// All profiles of the folders; of two with one name, the first. Bases are left out; one with mistakes as
/// well, and reported on stderr.
[[nodiscard]] std::vector<profile::Profile> profiles_in(const std::vector<std::string>& folders);

}  // namespace axisgate::commands
