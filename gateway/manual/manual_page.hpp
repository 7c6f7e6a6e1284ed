// SPDX-License-Identifier: Apache-2.0
// The manual page of a program, in roff, made from its commands.
// Promises every word that --help says of each command, in the same order, and no other of them.
// Never asks for the time or the machine: one version of a program has one page.
#pragma once

#include <string>

#include "gateway/manual/command_tree.hpp"

namespace axisgate::manual {

[[nodiscard]] std::string manual_page(const Command& program, const std::string& version);

}  // namespace axisgate::manual
