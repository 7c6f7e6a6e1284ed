// SPDX-License-Identifier: Apache-2.0
// The gateway's only randomness: a small generator whose sequence is the same on every platform.
// Promises that equal seeds give equal sequences for ever (it is part of what makes a simulation seed replayable).
// Never used for secrets.
#pragma once

#include <cstdint>

namespace axisgate {

/// splitmix64 (Steele, Lea, Flood 2014): one word of state, full period.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) : state_(seed) {}

  constexpr std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  /// Uniform in 0..bound-1 but for a bias below 2^-32; `bound` 1..2^32.
  constexpr std::uint64_t below(std::uint64_t bound) { return ((next() >> 32) * bound) >> 32; }
  constexpr bool chance(std::uint64_t numerator, std::uint64_t denominator) { return below(denominator) < numerator; }

 private:
  std::uint64_t state_;
};

}  // namespace axisgate
