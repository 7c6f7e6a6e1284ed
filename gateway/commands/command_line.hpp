// SPDX-License-Identifier: Apache-2.0
// The command line: which command is meant, with which options.
// Promises that every command has --help with an example, and that a wrong option is named.
// Never does a command's work itself.
#pragma once

#include <functional>

namespace axisgate::commands {

/// What a command line asks for.
struct CommandLine {
  int exit_code = 0;         ///< where nothing is to be run: help was asked for and printed, or what is wrong was
  std::function<int()> run;  ///< carries the command out, and gives its exit code
};

/// Runs nothing.
[[nodiscard]] CommandLine parse_command_line(int argc, const char* const* argv);

/// Parses and runs; the exit code of the process. 0: done. 1: the command says no. 2: the command line is wrong.
[[nodiscard]] int run_command_line(int argc, const char* const* argv);

}  // namespace axisgate::commands
