// SPDX-License-Identifier: Apache-2.0
// What befalls a judged run all the time of a phase of it, beside its steps: how likely each fault is and how strong,
// as plain data drawn from a seed; and how often each has struck. Promises that outside the phase nothing of it
// happens, so that each run ends quietly. Never makes a client write what could move a motor.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/obey/plant.hpp"

namespace axisgate::test::judged {

/// Probabilities; 0: never.
struct Nemesis {
  std::int64_t from_ms = 0;                             ///< of the run
  std::int64_t until_ms = 0;                            ///< none: there is none
  std::array<double, obey::kStrikes.size()> strikes{};  ///< of each exchange with axis 1's drive
  Duration late_by{};
  // Of each 5 ms:
  double soup = 0;   ///< a further client says what is no request, or none that may be carried out
  double storm = 0;  ///< connections are made, and most of them left
  double stall = 0;  ///< the event loop stands
  std::int64_t longest_stall_ms = 0;

  [[nodiscard]] double strike(obey::Strike how) const { return strikes.at(static_cast<std::size_t>(how)); }
  /// What a drive says may come a second time, or with more around it.
  [[nodiscard]] bool says_twice() const;
  /// Itself without one of its kinds, for each that it has.
  [[nodiscard]] std::vector<Nemesis> with_one_kind_less() const;
  /// Only what both have.
  [[nodiscard]] Nemesis common(const Nemesis& other) const;
};

/// Of the seed alone.
[[nodiscard]] Nemesis draw_nemesis(Subject subject, std::uint64_t seed);
[[nodiscard]] std::string text(const Nemesis& nemesis);

/// So often each has struck, by steps and by the nemesis.
struct Injected {
  std::array<std::uint64_t, obey::kStrikes.size()> strikes{};
  std::uint64_t soup = 0, storm = 0, stall = 0;
  void add(const Injected& more);
};
/// " lost 12, late 3"
[[nodiscard]] std::string text(const Injected& injected);

}  // namespace axisgate::test::judged
