// SPDX-License-Identifier: Apache-2.0
// The command line of `axisgate support`: its options, and what its help says.
// Promises what CommandLine does of every command. Never does its work itself.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "gateway/commands/support/support_command.hpp"

namespace axisgate::commands {

/// `profiles`: what --profiles gives. `chosen` is set when it is chosen. All live as long as `app`.
void add_support_command(CLI::App& app, SupportOptions& options, std::string& profiles, std::function<int()>& chosen);

}  // namespace axisgate::commands
