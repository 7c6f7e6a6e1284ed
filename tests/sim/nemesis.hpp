// The nemesis: which faults a seed brings over the lines, how strong, and when (late, lost, noise, cut link, restart).
// Promises that its deeds follow from the seed alone, and that it leaves everything whole when it retires.
// Never does what no drive or cable does: a drive answers in order, and within its profile's worst_reply_ms.
#pragma once

#include <functional>
#include <vector>

#include "gateway/core/random.hpp"
#include "tests/stage/can_link_sim.hpp"
#include "tests/stage/rtu_link_sim.hpp"
#include "tests/stage/sim_link.hpp"

namespace axisgate::test {

/// One line as the nemesis sees it, whatever is spoken on it.
struct Victim {
  std::size_t drives = 0;
  std::function<simulated::DriveFaults&(std::size_t)> faults;
  std::function<bool(simulated::DriveFault)> has;
  std::function<void()> unplug, plug;
  std::function<bool()> plugged;
  std::function<void(std::size_t)> restart;
  std::function<void(std::size_t)> faulted;  ///< this drive has a fault whose cause is gone already
  /// What only this kind of line can suffer, and its end; none: there is nothing.
  std::function<void(std::size_t, Random&)> own_deed;
  std::function<void()> calm = [] {};
};
[[nodiscard]] Victim victim(SimLink& link, Runtime& runtime);
[[nodiscard]] Victim victim(RtuLinkSim& link, Runtime& runtime);
[[nodiscard]] Victim victim(CanLinkSim& link, Runtime& runtime);

class Nemesis {
 public:
  Nemesis(std::vector<Victim> victims, Runtime& runtime, std::uint64_t seed);

  [[nodiscard]] Instant next_deed() const { return next_deed_; }
  void act();
  /// All faults end, all cables are plugged in.
  void retire();

 private:
  void draw_rates();
  void draw_rates(const Victim& victim, simulated::DriveFaults& faults);
  void mend_all();
  std::vector<Victim> victims_;
  Runtime& runtime_;
  Random random_;
  Instant next_deed_;
  bool retired_ = false;
};

}  // namespace axisgate::test
