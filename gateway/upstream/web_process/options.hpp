// SPDX-License-Identifier: Apache-2.0
// The command line of axisgate-web: the gateway's socket, and what to serve.
// Promises settings within their ranges, or a message that names the one and what it may be.
// Never opens anything.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "gateway/upstream/web_process/capture/capture_settings.hpp"
#include "gateway/upstream/web_process/http/settings.hpp"

namespace axisgate::web {

struct ServeOptions {
  int link_fd = -1;
  Settings settings{};
  CaptureSettings captures{};
};

/// An exit code where there is nothing to do: a message or the help was printed.
[[nodiscard]] std::variant<int, ServeOptions> parse_command_line(int argc, char** argv);

/// Settings, or what is wrong with them. @param json the resolved section "web"
[[nodiscard]] std::variant<Settings, std::string> parse_settings(std::string_view json);
/// What of it is of captures and triggers.
[[nodiscard]] std::variant<CaptureSettings, std::string> parse_captures(std::string_view json);

}  // namespace axisgate::web
