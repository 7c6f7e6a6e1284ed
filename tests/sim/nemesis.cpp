#include "tests/sim/nemesis.hpp"

namespace axisgate::test {

using simulated::DriveFault;

namespace {

template <class Link>
Victim cable(Link& link, Runtime& runtime) {
  Victim out;
  out.line = &link.line();
  out.unplug = [&link] { link.unplug(); };
  out.plug = [&link] { link.plug(); };
  out.plugged = [&link] { return link.plugged(); };
  out.now = [&link, &runtime] { return link.time_of(runtime.now()); };
  return out;
}

void fault(simulated::KincoDrive& drive) {
  drive.inject_fault(1, 0x0020);  // bus voltage too high
  drive.clear_fault_cause(1, 0x0020);
}

}  // namespace

Victim victim(SimLink& link, Runtime& runtime) {
  Victim out = cable(link, runtime);
  out.faulted = [&link](std::size_t drive) { fault(link.line().drive(drive)); };
  return out;
}

Victim victim(RtuLinkSim& link, Runtime& runtime) {
  Victim out = cable(link, runtime);
  out.faulted = [&link](std::size_t drive) {
    if (simulated::KincoDrive* kinco = link.line().kinco(drive)) return fault(*kinco);
    link.line().id286pro(drive)->inject_fault(14);  // supply above 90 V
    link.line().id286pro(drive)->clear_fault_cause();
  };
  return out;
}

Nemesis::Nemesis(std::vector<Victim> victims, Runtime& runtime, std::uint64_t seed)
    : victims_(std::move(victims)),
      runtime_(runtime),
      random_(seed),
      next_deed_(runtime.now() + std::chrono::seconds(2)) {
  draw_rates();
}

void Nemesis::draw_rates() {
  for (const Victim& victim : victims_)
    for (std::size_t d = 0; d < victim.line->size(); ++d) draw_rates(*victim.line, victim.line->faults(d));
}

// Each seed draws which faults there are at all, and how often they strike: between one in 25 and one in 1000 replies.
void Nemesis::draw_rates(const simulated::DriveLine& line, simulated::DriveFaults& faults) {
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
  if (!line.has(DriveFault::half)) return;
  maybe(DriveFault::half);
  // The length is all that tells a late reply from the fence's: a drive may break one of both rules.
  if (!faults.armed(DriveFault::late)) maybe(DriveFault::wrong_length);
  maybe(DriveFault::glued);
  // Not now, but perhaps later: no drive says at random that it has no such register.
  constexpr std::array<std::uint8_t, 5> kForNow{4, 5, 6, 8, 11};
  faults.exception_code = kForNow[static_cast<std::size_t>(random_.below(kForNow.size()))];
  maybe(DriveFault::exception);
}

void Nemesis::act() {
  next_deed_ = runtime_.now() + std::chrono::milliseconds(500 + random_.below(6000));
  if (retired_) return;
  Victim& victim = victims_[static_cast<std::size_t>(random_.below(victims_.size()))];
  const auto drive = static_cast<std::size_t>(random_.below(victim.line->size()));
  switch (random_.below(4)) {
    case 0:
      if (victim.plugged())
        victim.unplug();
      else
        victim.plug();
      break;
    case 1:
      victim.line->restart(drive, victim.now());
      break;
    case 2:
      victim.faulted(drive);
      break;
    default:
      for (Victim& v : victims_) v.plug();
      break;
  }
}

void Nemesis::retire() {
  retired_ = true;
  for (Victim& victim : victims_) {
    victim.plug();
    for (std::size_t d = 0; d < victim.line->size(); ++d) victim.line->faults(d).clear();
  }
}

}  // namespace axisgate::test
