// axisgate-bench: the figures of the design's section 8, each as a ratio to a bare loop of the same run.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <exception>

#include "tests/bench/modbus_reads.hpp"

int main(int argc, char** argv) {
  using namespace axisgate::bench;
  ReadsOptions reads;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) {
      reads = {3, 100};
    } else {
      fmt::print("usage: axisgate-bench [--quick]\n");
      return std::strcmp(argv[i], "--help") == 0 ? 0 : 2;
    }
  }
  try {
    modbus_reads(reads);
  } catch (const std::exception& error) {
    fmt::print(stderr, "axisgate-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
