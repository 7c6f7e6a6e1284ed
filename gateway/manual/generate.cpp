// SPDX-License-Identifier: Apache-2.0
#include "gateway/manual/generate.hpp"

#include <string_view>

#include "gateway/manual/command_tree.hpp"
#include "gateway/manual/completion.hpp"
#include "gateway/manual/manual_page.hpp"

namespace axisgate::manual {

std::optional<std::string> generated(CLI::App& app, int argc, const char* const* argv) {
  if (argc != 3 || std::string_view(argv[1]) != "--generate") return std::nullopt;
  const std::string_view form = argv[2];
  if (form == "man") return manual_page(command_tree(app), AXISGATE_VERSION);
  if (form == "bash") return bash_completion(command_tree(app));
  if (form == "zsh") return zsh_completion(command_tree(app));
  return std::nullopt;
}

}  // namespace axisgate::manual
