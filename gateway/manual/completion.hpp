// SPDX-License-Identifier: Apache-2.0
// What lets a shell complete a program's command line: bash and zsh functions made from its commands.
// Promises each command and each option at its place, the words that an option takes, and files where it takes a file.
// Never needs more than the shell itself, and never runs the program.
#pragma once

#include <string>

#include "gateway/manual/command_tree.hpp"

namespace axisgate::manual {

[[nodiscard]] std::string bash_completion(const Command& program);
[[nodiscard]] std::string zsh_completion(const Command& program);

}  // namespace axisgate::manual
