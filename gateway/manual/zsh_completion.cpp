// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "gateway/manual/completion.hpp"

namespace axisgate::manual {
namespace {

/// Inside a specification of _arguments or _describe that stands in single quotes.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string action(const Option& option) {
  if (!option.words.empty()) return fmt::format("({})", fmt::join(option.words, " "));
  if (option.takes == Takes::file) return "_files";
  if (option.takes == Takes::folder) return "_files -/";
  return " ";
}

/// `words` of an _arguments call, one a line.
std::string specifications(const Command& command) {
  std::string out;
  for (const Option& option : command.options)
    for (const std::string& name : option.names) {
      const std::string value =
          option.value.empty() ? "" : fmt::format(":{}:{}", escaped(option.value), action(option));
      out += fmt::format(" \\\n    '{}{}[{}]{}'", option.repeated ? "*" : "", name, escaped(option.what), value);
    }
  return out;
}

std::string function_of(std::string way) {
  std::ranges::replace_if(
      way, [](char c) { return c == '-' || c == ' '; }, '_');
  return "_" + way;
}

void functions(const std::string& way, const Command& command, std::string& out) {
  const std::string name = function_of(way);
  if (command.commands.empty()) {
    std::string places;
    for (const Option& argument : command.arguments)
      places += fmt::format(" \\\n    '{}{}:{}'",
                            argument.repeated   ? "*:"
                            : argument.required ? ":"
                                                : "::",
                            escaped(argument.value), action(argument));
    out += fmt::format("{}() {{\n  _arguments -s{}{}\n}}\n", name, specifications(command), places);
    return;
  }
  std::string list;
  std::string cases;
  for (const Command& one : command.commands) {
    list += fmt::format("\n        '{}:{}'", one.name, escaped(one.what));
    cases += fmt::format("        {}) {} ;;\n", one.name, function_of(way + " " + one.name));
    functions(way + " " + one.name, one, out);
  }
  out += fmt::format(R"({0}() {{
  local context state state_descr line
  typeset -A opt_args
  local -a commands
  _arguments -C{1} \
    ': :->command' '*:: :->rest'
  case $state in
    command)
      commands=({2}
      )
      _describe -t commands command commands
      ;;
    rest)
      case $words[1] in
{3}      esac
      ;;
  esac
}}
)",
                     name, specifications(command), list, cases);
}

}  // namespace

std::string zsh_completion(const Command& program) {
  std::string out = fmt::format("#compdef {0}\n# zsh completion for {0}, made from its command line.\n", program.name);
  functions(program.name, program, out);
  return out + fmt::format("{} \"$@\"\n", function_of(program.name));
}

}  // namespace axisgate::manual
