// SPDX-License-Identifier: Apache-2.0
// The command line of the commands that check a profile, and of those that make one: their options, and what their help
// says. Promises that no file is written over by any of them. Never does a command's work itself.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "gateway/commands/commands.hpp"
#include "gateway/commands/profile/making_commands.hpp"
#include "gateway/commands/try/try_command.hpp"

namespace axisgate::commands {

/// What their options are read into.
struct ProfileCommands {
  ProfileCheckOptions check;
  ProfileFromEdsOptions from_eds;
  ProfileNewOptions make;
  ProfileUpgradeOptions upgrade;
  TryOptions trial;
};

/// `profiles`: what --profiles gives. `chosen` is set when one of them is chosen. All live as long as `app`.
void add_profile_commands(CLI::App& app, ProfileCommands& commands, std::string& profiles,
                          std::function<int()>& chosen);

}  // namespace axisgate::commands
