// SPDX-License-Identifier: Apache-2.0
// axisgate: motor drives on fieldbuses as one Modbus-TCP register map.
#include <cstdio>
#include <exception>

#include "gateway/commands/command_line.hpp"

int main(int argc, char** argv) {
  try {
    return axisgate::commands::run_command_line(argc, argv);
  } catch (const std::exception& error) {
    // Only start-up throws, and it says in its message what to change.
    std::fprintf(stderr, "axisgate: %s\n", error.what());
    return 1;
  }
}
