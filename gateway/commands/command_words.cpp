// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/command_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "gateway/core/nearest.hpp"

namespace axisgate::commands {
namespace {

std::string none_of(const std::string& value, const std::vector<std::string>& words) {
  return fmt::format("'{}' is none of: {}{}", value, fmt::join(words, ", "), did_you_mean(value, words));
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::App* command : app.get_subcommands({})) out.push_back(command->get_name());
  return out;
}

/// "--interval", "-h": as they are typed.
std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
    for (const std::string& name : option->get_snames()) out.push_back("-" + name);
  }
  return out;
}

}  // namespace

CLI::Validator one_of(std::vector<std::string> words) {
  const auto judged = [words = std::move(words)](const std::string& value) {
    const bool known = std::ranges::find(words, value) != words.end();
    return known ? std::string() : none_of(value, words);
  };
  return CLI::Validator(judged, "");
}

CLI::Validator number_of_one(std::vector<std::pair<std::string, int>> words) {
  const auto judged = [words = std::move(words)](std::string& value) {
    std::vector<std::string> names;
    for (const auto& [name, number] : words) {
      if (name == value) {
        value = std::to_string(number);
        return std::string();
      }
      names.push_back(name);
    }
    return none_of(value, names);
  };
  return CLI::Validator(judged, "");
}

std::string wrong_command(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* at = &app;
  std::string path = app.get_name();
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    const std::vector<std::string> known = commands_of(*at);
    if (known.empty()) break;
    const std::string word = argv[i];
    if (std::ranges::find(known, word) == known.end())
      return fmt::format("{0}: there is no command '{1}'{2} {0} --help lists them", path, word,
                         nearest(word, known) ? did_you_mean(word, known) : ";");
    at = at->get_subcommand(word);
    path += " " + word;
  }
  return {};
}

std::string nearest_options(const CLI::App& app) {
  std::string out;
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  const std::vector<std::string> known = options_of(*at);
  for (const std::string& word : app.remaining(true)) {
    if (!word.starts_with('-')) continue;
    const std::string name = word.substr(0, word.find('='));
    if (const auto near = nearest(name, known); near && *near != name)
      out += fmt::format("{}: did you mean \"{}\"?\n", name, *near);
  }
  return out;
}

}  // namespace axisgate::commands
