// The nemesis: which faults a seed brings over the lines, how strong, and when (late, lost, noise, cut link, restart).
// Promises that its deeds follow from the seed alone, and that it leaves everything whole when it retires.
// Never does what no drive or cable does: a drive answers in order, and within its profile's worst_reply_ms.
#pragma once

#include <functional>
#include <vector>

#include "gateway/core/random.hpp"
#include "tests/stage/rtu_link_sim.hpp"
#include "tests/stage/sim_link.hpp"

namespace axisgate::test {

/// One line as the nemesis sees it, whatever is spoken on it.
struct Victim {
  simulated::DriveLine* line = nullptr;
  std::function<void()> unplug, plug;
  std::function<bool()> plugged;
  std::function<simulated::Time()> now;
  std::function<void(std::size_t)> faulted;  ///< this drive has a fault whose cause is gone already
};
[[nodiscard]] Victim victim(SimLink& link, Runtime& runtime);
[[nodiscard]] Victim victim(RtuLinkSim& link, Runtime& runtime);

class Nemesis {
 public:
  Nemesis(std::vector<Victim> victims, Runtime& runtime, std::uint64_t seed);

  [[nodiscard]] Instant next_deed() const { return next_deed_; }
  void act();
  /// All faults end, all cables are plugged in.
  void retire();

 private:
  void draw_rates();
  void draw_rates(const simulated::DriveLine& line, simulated::DriveFaults& faults);
  std::vector<Victim> victims_;
  Runtime& runtime_;
  Random random_;
  Instant next_deed_;
  bool retired_ = false;
};

}  // namespace axisgate::test
