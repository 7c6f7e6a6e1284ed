// SPDX-License-Identifier: Apache-2.0
// A program's commands as its command line declares them: names, options, what each is for. It is what its --help, its
// manual page and its completion are all made from. Promises that nothing shown by --help is left out of it, and that
// it keeps the order of the declarations. Never parses, and knows nothing of what a command does.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace axisgate::manual {

/// What may stand for an option or an argument, as far as a shell can help with it.
enum class Takes { nothing, text, file, folder };

/// An option (with its dashes), or an argument that has a place instead (`names` holds its one name then).
struct Option {
  std::vector<std::string> names;
  std::string value;  // what its value is called, "FILE"; empty: it takes none
  Takes takes = Takes::nothing;
  std::vector<std::string> words;  // the only values that it takes, where these are words
  std::string initial;             // what it is without being given; empty: not shown
  std::string what;
  bool required = false;
  bool repeated = false;
};

struct Command {
  std::string name;
  std::string what;
  std::string footer;
  std::vector<Option> arguments;
  std::vector<Option> options;
  std::vector<Command> commands;
};

/// Changes nothing of `app`: CLI11 tries values by an option that could be changed alone.
[[nodiscard]] Command command_tree(CLI::App& app);

}  // namespace axisgate::manual
