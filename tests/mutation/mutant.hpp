// SPDX-License-Identifier: Apache-2.0
#pragma once

// Put before the first line of a source that holds mutants (tests/mutation/run), never part of a build that ships.
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"
#pragma GCC diagnostic ignored "-Wreturn-type"
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wparentheses"

/// Which mutants a program came to, left for the tool when the program ends.
struct AxisgateMutantsReached {
  std::array<bool, 1000> at{};

  ~AxisgateMutantsReached() {
    const char* path = std::getenv("AXISGATE_MUTANTS_REACHED");
    std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "a");
    if (file == nullptr) return;
    for (std::size_t id = 0; id < at.size(); ++id)
      if (at[id]) std::fprintf(file, "%zu\n", id);
    std::fclose(file);
  }
};

/// Whether the environment chooses this one.
inline bool axisgate_mutant(int id) {
  static AxisgateMutantsReached reached;
  static const int chosen = [] {
    const char* text = std::getenv("AXISGATE_MUTANT");
    return text == nullptr ? 0 : std::atoi(text);
  }();
  reached.at[static_cast<std::size_t>(id)] = true;
  return chosen == id;
}
