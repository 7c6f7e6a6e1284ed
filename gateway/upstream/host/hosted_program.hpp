// SPDX-License-Identifier: Apache-2.0
// A program of the gateway's own, as whoever starts it knows it: its names, its words, and where it is looked for.
// Promises that run and check look in the same places. Never starts it.
#pragma once

#include <string>
#include <string_view>

namespace axisgate::host {

struct HostedProgram {
  std::string_view name;          ///< "axisgate-dds"
  const char* variable;           ///< of the environment: names its file where it is elsewhere
  std::string_view how_built;     ///< where it comes from
  std::string_view log_source;    ///< "dds"
  int nicer;                      ///< below the gateway's own priority, so that the core gets the processor first
  std::string_view cannot_serve;  ///< what it could not do where it ends with kExitCannotServe
  std::string_view no_address;    ///< and with kExitNoAddress
};

struct FoundProgram {
  std::string path{};     ///< empty: not there
  std::string why_not{};  ///< where it was looked for, and how it comes there
};
/// The file that its variable names; else beside this program, else in ../libexec/axisgate from there.
[[nodiscard]] FoundProgram find_program(const HostedProgram& program);

}  // namespace axisgate::host
