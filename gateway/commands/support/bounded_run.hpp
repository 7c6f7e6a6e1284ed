// SPDX-License-Identifier: Apache-2.0
// Another program, run for what it prints.
// Promises that it ends within its time, killed where it does not, and that no more is kept than may be. Its standard
// input is empty. Never runs a shell, and never leaves it behind.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace axisgate::commands::support {

struct RunLimits {
  std::chrono::milliseconds patience{10000};
  std::size_t bytes = 0;
  bool newest_is_last = false;  ///< of more than `bytes` the end is kept, else the beginning
};
struct RunEnd {
  std::string text;       ///< of its standard output and standard error, as they came
  std::string problem{};  ///< it is not there, was killed, or more came than was kept; in words
  int exit_code = -1;     ///< -1: it has not come to its end
};
/// @param words the program, looked for as a shell does, and its arguments
[[nodiscard]] RunEnd run_program(const std::vector<std::string>& words, const RunLimits& limits);

}  // namespace axisgate::commands::support
