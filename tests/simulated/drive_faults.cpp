// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/drive_faults.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::array<std::string_view, drive_fault_count> names{
    "unresponsive", "late",      "lose",          "noise-before", "noise-after",     "corrupt",
    "split",        "duplicate", "wrong-station", "restart",      "babble",          "half",
    "wrong-length", "glued",     "exception",     "emergencies",  "heartbeat-twice", "glitch"};

}  // namespace

std::string_view name_of(DriveFault fault) { return names[static_cast<std::size_t>(fault)]; }

std::optional<DriveFault> drive_fault_named(std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<DriveFault>(i);
  }
  return std::nullopt;
}

}  // namespace axisgate::simulated
