// SPDX-License-Identifier: Apache-2.0
// A profile that was made, as a new file, and what a person hears of it.
// Promises that no file is written over, and that what was made is read and judged before it is called good.
// Never asks anything.
#pragma once

#include <string>
#include <vector>

#include "gateway/profile/eds/eds.hpp"
#include "gateway/profile/make/from_eds.hpp"

namespace axisgate::commands {

struct MadeFile {
  std::string source;  ///< the file that it was made from
  std::string folder;  ///< where it goes
  std::string name;    ///< of the profile
  std::vector<std::string> profile_folders{};
  const profile::Eds* eds = nullptr;  ///< what must not contradict it; null: nothing to compare
};

/// The exit code: 0 where the file was written and is good.
[[nodiscard]] int write_made(const profile::MadeProfile& made, const MadeFile& file);

}  // namespace axisgate::commands
