// SPDX-License-Identifier: Apache-2.0
// `PROGRAM --generate man|bash|zsh`: what a package ships beside a program, printed by the program itself.
// Promises the text from the commands that the program really has.
// Never shows in --help: it is for whoever makes a package.
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace axisgate::manual {

/// The text that is asked for; nothing where the command line asks for something else.
[[nodiscard]] std::optional<std::string> generated(CLI::App& app, int argc, const char* const* argv);

}  // namespace axisgate::manual
