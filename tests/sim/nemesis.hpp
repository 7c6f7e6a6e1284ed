// The nemesis: which faults a seed brings over the lines, how strong, and when (late, lost, noise, cut link, restart).
// Promises that its deeds follow from the seed alone, and that it leaves everything whole when it retires.
// Never does what no drive or cable does: a drive answers in order, and within its profile's worst_reply_ms.
#pragma once

#include <vector>

#include "gateway/core/random.hpp"
#include "tests/stage/sim_link.hpp"

namespace axisgate::test {

class Nemesis {
 public:
  Nemesis(std::vector<SimLink*> links, Runtime& runtime, std::uint64_t seed);

  [[nodiscard]] Instant next_deed() const { return next_deed_; }
  void act();
  /// All faults end, all cables are plugged in.
  void retire();

 private:
  void draw_rates();
  std::vector<SimLink*> links_;
  Runtime& runtime_;
  Random random_;
  Instant next_deed_;
  bool retired_ = false;
};

}  // namespace axisgate::test
