// SPDX-License-Identifier: Apache-2.0
// The commands that move an axis manually, as the command line has them: enable, move, jog and stop.
// Promises that every option says its unit. Never does a command's work itself.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "gateway/commands/manual/manual_command.hpp"

namespace axisgate::commands {

/// One set of options for each command, for each is filled while the line is parsed.
struct ManualCommands {
  ManualOptions enable, move, jog, stop;
};

/// `chosen` is set to what carries the command out; `commands` outlives it.
void add_manual_commands(CLI::App& app, ManualCommands& commands, std::function<int()>& chosen);

}  // namespace axisgate::commands
