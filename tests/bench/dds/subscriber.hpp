// SPDX-License-Identifier: Apache-2.0
// A subscriber of axisgate/axis_state in a process of its own, and how the bench speaks to it.
// Promises that each latency is from the stamp of a sample to the call of its listener, on this computer's clock.
// Never counts samples that were published before it was asked to begin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/dds/other_self.hpp"

namespace axisgate::bench {

/// The subscriber's side: runs until its standard input ends. Returns the exit code.
int subscribe(std::uint32_t domain);

/// The bench's side.
class Subscriber {
 public:
  /// Starts /proc/self/exe as `subscribe DOMAIN`.
  explicit Subscriber(std::uint32_t domain);

  /// Returns when a sample has been received: discovery is over.
  void await_first_sample();
  void forget();
  /// Microseconds of each sample since forget().
  [[nodiscard]] std::vector<double> latencies();

 private:
  std::string ask(const std::string& question);

  OtherSelf other_;
};

}  // namespace axisgate::bench
