// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "gateway/manual/completion.hpp"

namespace axisgate::manual {
namespace {

std::string function_name(std::string program) {
  std::ranges::replace(program, '-', '_');
  return "_" + program;
}

/// The commands below `command`, each with its way from the program ("/profile/check"); the program's own way is empty.
void all_commands(const std::string& way, const Command& command,
                  std::vector<std::pair<std::string, const Command*>>& out) {
  out.emplace_back(way, &command);
  for (const Command& one : command.commands) all_commands(way + "/" + one.name, one, out);
}

std::string value_line(const std::string& way, const Option& option) {
  std::string patterns;
  for (const std::string& name : option.names)
    patterns += fmt::format("{}'{} {}'", patterns.empty() ? "" : " | ", way, name);
  std::string candidates = ":";  // a number, a name: nothing that a shell could know
  if (!option.words.empty())
    candidates = fmt::format("mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$word\")", fmt::join(option.words, " "));
  if (option.takes == Takes::file || option.takes == Takes::folder)
    candidates = fmt::format("compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen {} -- \"$word\")",
                             option.takes == Takes::file ? "-f" : "-d");
  return fmt::format("    {}) {}; return ;;\n", patterns, candidates);
}

std::string command_line(const std::string& way, const Command& command) {
  std::string options;
  std::string below;
  for (const Option& option : command.options)
    for (const std::string& name : option.names) options += (options.empty() ? "" : " ") + name;
  for (const Command& one : command.commands) below += (below.empty() ? "" : " ") + one.name;
  const bool files =
      std::ranges::any_of(command.arguments, [](const Option& argument) { return argument.takes == Takes::file; });
  return fmt::format("    '{}') options='{}' commands='{}' files={} ;;\n", way, options, below, files ? "yes" : "no");
}

}  // namespace

std::string bash_completion(const Command& program) {
  std::vector<std::pair<std::string, const Command*>> commands;
  all_commands("", program, commands);
  std::string ways;
  std::string values;
  std::string lists;
  for (const auto& [way, command] : commands) {
    if (!way.empty()) ways += (ways.empty() ? "" : " | ") + way;
    for (const Option& option : command->options)
      if (!option.value.empty()) values += value_line(way, option);
    lists += command_line(way, *command);
  }
  const std::string way_lines = ways.empty() ? ""
                                             : fmt::format(R"(  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$way/${{COMP_WORDS[i]}}" in {}) way+=/${{COMP_WORDS[i]}} ;; esac
  done
)",
                                                           ways);
  return fmt::format(R"(# bash completion for {0}, made from its command line.
{1}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} way='' options='' commands='' files=no i
  COMPREPLY=()
  # bash takes "--option=value" for three words.
  if [ "$word" = = ]; then
    word=''
  elif [ "$before" = = ]; then
    before=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
{2}  case "$way $before" in
{3}  esac
  case "$way" in
{4}  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$word")
  if [ "$files" = yes ]; then
    compopt -o filenames 2>/dev/null
    mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -f -- "$word")
  fi
}}
complete -F {1} {0}
)",
                     program.name, function_name(program.name), way_lines, values, lists);
}

}  // namespace axisgate::manual
