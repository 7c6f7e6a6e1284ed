// SPDX-License-Identifier: Apache-2.0
// Profiles for tests, read and checked once for each process, however many rigs and tests use them.
// Promises what load_profile() gives, of files in the source folder alone: no test writes those.
// Never reads what a test has made.
#pragma once

#include <string>

#include "gateway/profile/read/profile_loader.hpp"

namespace axisgate::test {

[[nodiscard]] const profile::LoadedProfile& profile_once(const std::string& path);

/// The one that is shipped under this name.
[[nodiscard]] const profile::LoadedProfile& shipped_profile(const std::string& name);

}  // namespace axisgate::test
