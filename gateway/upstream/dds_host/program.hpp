// SPDX-License-Identifier: Apache-2.0
// The program axisgate-dds: where it is looked for, and its command line.
// Promises that run, check and topics look in the same places and name the same network.
// Never starts it.
#pragma once

#include <string>
#include <vector>

#include "gateway/upstream/dds/dds_settings.hpp"

namespace axisgate::dds {

struct Program {
  std::string path{};     ///< empty: not there
  std::string why_not{};  ///< where it was looked for, and how it comes there
};
/// The file that AXISGATE_DDS_PROGRAM names; else beside this program, else in ../libexec/axisgate from there.
[[nodiscard]] Program find_program();

/// Domain, interfaces and discovery, as `serve` and `topics` of axisgate-dds take them.
[[nodiscard]] std::vector<std::string> participant_arguments(const DdsSettings& settings);
[[nodiscard]] std::vector<std::string> serve_arguments(const DdsSettings& settings, int link_descriptor);

}  // namespace axisgate::dds
