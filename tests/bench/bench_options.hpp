// What every bench is told: which gateway, where to put its files, and whether only to show that it works.
// Promises a folder that exists. Never says how long a bench measures: each bench knows that itself.
// Never changes after the command line was read.
#pragma once

#include <chrono>
#include <string>

namespace axisgate::bench {

struct BenchOptions {
  std::string program;  ///< the gateway: `axisgate`
  std::string folder;   ///< for configuration, log and ports
  bool quick = false;   ///< fractions of a second: figures appear, but mean nothing

  [[nodiscard]] std::chrono::milliseconds lasting(std::chrono::milliseconds full) const {
    return quick ? std::chrono::milliseconds(200) : full;
  }
  [[nodiscard]] int times(int full) const { return quick ? 1 : full; }
};

}  // namespace axisgate::bench
