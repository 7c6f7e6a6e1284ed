// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/host/hosted_program.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace axisgate::host {
namespace {

namespace fs = std::filesystem;

bool can_run(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

}  // namespace

FoundProgram find_program(const HostedProgram& program) {
  if (const char* const named = std::getenv(program.variable); named != nullptr && *named != '\0') {
    if (can_run(named)) return {named, {}};
    return {{}, std::string(program.variable) + " names " + named + ", which is no program"};
  }
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path beside = folder / program.name;
  const fs::path libexec = folder.parent_path() / "libexec/axisgate" / program.name;
  for (const fs::path& file : {beside, libexec})
    if (can_run(file)) return {file.string(), {}};
  return {{},
          "there is neither " + beside.string() + " nor " + libexec.string() + "; it is built with " +
              std::string(program.how_built)};
}

}  // namespace axisgate::host
