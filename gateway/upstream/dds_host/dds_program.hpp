// SPDX-License-Identifier: Apache-2.0
// The program axisgate-dds: what it is to whoever starts it, and its command line.
// Promises that run, check and topics name the same network.
// Never starts it.
#pragma once

#include <string>
#include <vector>

#include "gateway/upstream/dds/dds_settings.hpp"
#include "gateway/upstream/host/hosted_program.hpp"

namespace axisgate::dds {

inline constexpr host::HostedProgram kProgram{
    "axisgate-dds",
    "AXISGATE_DDS_PROGRAM",
    "the CMake option AXISGATE_DDS=ON (Debian packages libfastrtps-dev, fastddsgen and default-jre-headless)",
    "dds",
    5,
    "could not create its participant: look at `domain` and `qos_file`, and at its own lines of the log",
    "has no address yet on one of its `interfaces`, which its own line of the log names"};

/// Domain, interfaces and discovery, as `serve` and `topics` of axisgate-dds take them.
[[nodiscard]] std::vector<std::string> participant_arguments(const DdsSettings& settings);
[[nodiscard]] std::vector<std::string> serve_arguments(const DdsSettings& settings, int link_descriptor);

}  // namespace axisgate::dds
