// SPDX-License-Identifier: Apache-2.0
// The commands that move an axis manually, as the command line has them: enable, move, jog and stop.
// Promises that every option says its unit. Never does a command's work itself.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "gateway/commands/manual/manual_command.hpp"

namespace axisgate::commands {

/// One set of options for each command, for each is filled while the line is parsed.
struct ManualCommands {
  ManualOptions enable, move, jog, stop;
};

/// HOST:PORT, which may be left out: a word is one where it has a colon, else it is the next argument.
CLI::Option* add_endpoint(CLI::App& command, std::string& endpoint);
/// What there is to say of a command line that has a word too many: its first one was meant as HOST:PORT. Empty: not
/// so.
[[nodiscard]] std::string meant_as_endpoint(const CLI::App& app);

/// `chosen` is set to what carries the command out; `commands` outlives it.
void add_manual_commands(CLI::App& app, ManualCommands& commands, std::function<int()>& chosen);

}  // namespace axisgate::commands
