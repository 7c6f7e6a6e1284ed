// SPDX-License-Identifier: Apache-2.0
// The command line of the commands that save, compare and restore a drive's parameters: their options, and what their
// help says. Promises that each says whether it writes to the drive. Never does a command's work itself.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <string>

#include "gateway/commands/parameters/parameters_command.hpp"

namespace axisgate::commands {

/// One for each of save, compare and restore.
using ParametersCommands = std::array<ParametersOptions, 3>;

/// `profiles`: what --profiles gives. `chosen` is set when one of them is chosen. All live as long as `app`.
void add_parameters_commands(CLI::App& app, ParametersCommands& commands, std::string& profiles,
                             std::function<int()>& chosen);

}  // namespace axisgate::commands
