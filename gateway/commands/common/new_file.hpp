// SPDX-License-Identifier: Apache-2.0
// A file that a command makes.
// Promises that it is there whole, or not at all. Never writes over a file.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>

namespace axisgate::commands {

/// As files are made, less what the umask takes away.
inline constexpr mode_t kForAll = 0666;
/// 0, or errno why not: EEXIST: something is there already, and stays as it is.
[[nodiscard]] int write_new_file(const std::string& path, std::string_view bytes, mode_t mode = kForAll);

}  // namespace axisgate::commands
