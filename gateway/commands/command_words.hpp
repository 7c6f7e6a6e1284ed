// SPDX-License-Identifier: Apache-2.0
// What is said of words on the command line that are none of ours: the nearest right one.
// Promises that a wrong command, option or value of a choice is named together with what was probably meant. Never
// runs anything.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace axisgate::commands {

/// A value that is one of these words; the message about another names the nearest one.
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);

/// The same for words that stand for numbers of an enumeration: the word is replaced by its number.
[[nodiscard]] CLI::Validator number_of_one(std::vector<std::pair<std::string, int>> words);

/// What is wrong with the first words of a command line that name no command; empty: they do.
[[nodiscard]] std::string wrong_command(const CLI::App& app, int argc, const char* const* argv);

/// After a parse that failed, a line for each option that the command does not have and that is near one of its own.
[[nodiscard]] std::string nearest_options(const CLI::App& app);

}  // namespace axisgate::commands
