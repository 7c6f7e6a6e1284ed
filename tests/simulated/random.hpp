// SPDX-License-Identifier: Apache-2.0
// The only source of chance in the simulated drives: xoshiro256** filled by splitmix64 (Blackman and Vigna).
// Promises the same numbers for the same seed on every machine and compiler, which std:: distributions do not.
// Never seeds itself and holds no state outside the object.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace axisgate::simulated {

class Random {
 public:
  explicit Random(std::uint64_t seed) {
    for (auto& word : state_) {
      seed += 0x9E3779B97F4A7C15U;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
      z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
      word = z ^ (z >> 31);
    }
  }

  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  // A number from 0 to bound - 1. The modulo's bias is below 2^-32 for the small bounds used here.
  std::uint64_t below(std::uint64_t bound) { return next() % bound; }

  // True with the given probability. 53 bits compare exactly in an IEEE double, so the answer is the same everywhere.
  bool chance(double probability) {
    if (probability <= 0) return false;
    return static_cast<double>(next() >> 11) < probability * 9007199254740992.0;
  }

  std::uint8_t byte() { return static_cast<std::uint8_t>(next() >> 56); }

 private:
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace axisgate::simulated
