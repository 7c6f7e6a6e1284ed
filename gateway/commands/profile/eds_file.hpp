// SPDX-License-Identifier: Apache-2.0
// An EDS or DCF as a file, and what a command says of it.
// Promises a mistake with its file for whatever cannot be read. Never prints bytes of it that would spoil a terminal.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "gateway/config/config_fault.hpp"
#include "gateway/profile/eds/eds.hpp"

namespace axisgate::commands {

/// The content of any file, as far as `most` bytes and one more; a fault where there is none to be had.
[[nodiscard]] std::variant<std::string, config::ConfigFault> content_of(const std::string& file, std::size_t most);

[[nodiscard]] std::variant<profile::Eds, std::vector<config::ConfigFault>> load_eds(const std::string& file);

/// With the file's name, and their lines.
[[nodiscard]] std::vector<config::ConfigFault> faults_of(const std::string& file,
                                                         const std::vector<profile::EdsFault>& faults);

/// "Made for tests MD80, vendor 0x300"
[[nodiscard]] std::string identity_text(const profile::Eds& eds);
/// What was read otherwise than it is written, or left out.
void print_remarks(const profile::Eds& eds);
/// Control characters are shown as '?'.
[[nodiscard]] std::string printable(std::string text);

}  // namespace axisgate::commands
