// SPDX-License-Identifier: Apache-2.0
// The program axisgate-web: what it is to whoever starts it, and its command line.
// Promises that run and check look in the same places.
// Never starts it.
#pragma once

#include <string>
#include <vector>

#include "gateway/upstream/host/hosted_program.hpp"
#include "gateway/upstream/web/web_settings.hpp"

namespace axisgate::web {

inline constexpr host::HostedProgram kProgram{
    "axisgate-web",
    "AXISGATE_WEB_PROGRAM",
    "the CMake option AXISGATE_WEB=ON (Debian packages libseccomp-dev and prometheus-cpp-dev)",
    "web",
    10,
    "cannot listen on the address of `web`: it is in use, or needs rights, which its own line of the log names",
    "has no such address yet on this computer as `listen` of `web` names"};

[[nodiscard]] std::vector<std::string> serve_arguments(const WebSettings& settings, int link_descriptor);

}  // namespace axisgate::web
