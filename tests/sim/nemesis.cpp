#include "tests/sim/nemesis.hpp"

namespace axisgate::test {

using simulated::DriveFault;

Nemesis::Nemesis(std::vector<SimLink*> links, Runtime& runtime, std::uint64_t seed)
    : links_(std::move(links)), runtime_(runtime), random_(seed), next_deed_(runtime.now() + std::chrono::seconds(2)) {
  draw_rates();
}

// Each seed draws which faults there are at all, and how often they strike: between one in 25 and one in 1000 replies.
void Nemesis::draw_rates() {
  for (SimLink* link : links_) {
    for (std::size_t d = 0; d < link->line().size(); ++d) {
      simulated::DriveFaults& faults = link->line().faults(d);
      const auto maybe = [&](DriveFault fault) {
        if (random_.chance(1, 2)) faults.set_rate(fault, 1.0 / static_cast<double>(25 + random_.below(975)));
      };
      // Late beyond the timeout of 100 ms, within the worst_reply_ms of 500.
      faults.late_by = std::chrono::milliseconds(101 + random_.below(390));
      maybe(DriveFault::late);
      maybe(DriveFault::lose);
      maybe(DriveFault::mute);
      maybe(DriveFault::noise_before);
      maybe(DriveFault::noise_after);
      maybe(DriveFault::corrupt);
      maybe(DriveFault::split);
      maybe(DriveFault::wrong_station);
    }
  }
}

void Nemesis::act() {
  next_deed_ = runtime_.now() + std::chrono::milliseconds(500 + random_.below(6000));
  if (retired_) return;
  SimLink& link = *links_[static_cast<std::size_t>(random_.below(links_.size()))];
  const auto drive = static_cast<std::size_t>(random_.below(link.line().size()));
  switch (random_.below(4)) {
    case 0:
      if (link.plugged())
        link.unplug();
      else
        link.plug();
      break;
    case 1:
      link.line().restart(drive, link.time_of(runtime_.now()));
      break;
    case 2:
      link.line().drive(drive).inject_fault(1, 0x0020);  // bus voltage too high
      link.line().drive(drive).clear_fault_cause(1, 0x0020);
      break;
    default:
      for (SimLink* l : links_) l->plug();
      break;
  }
}

void Nemesis::retire() {
  retired_ = true;
  for (SimLink* link : links_) {
    link->plug();
    for (std::size_t d = 0; d < link->line().size(); ++d) link->line().faults(d).clear();
  }
}

}  // namespace axisgate::test
