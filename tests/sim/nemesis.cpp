#include "tests/sim/nemesis.hpp"

namespace axisgate::test {

using simulated::DriveFault;

namespace {

template <class Link>
Victim cable(Link& link, Runtime& runtime) {
  Victim out;
  out.drives = link.line().size();
  out.faults = [&link](std::size_t drive) -> simulated::DriveFaults& { return link.line().faults(drive); };
  out.has = [&link](DriveFault fault) { return link.line().has(fault); };
  out.unplug = [&link] { link.unplug(); };
  out.plug = [&link] { link.plug(); };
  out.plugged = [&link] { return link.plugged(); };
  out.restart = [&link, &runtime](std::size_t drive) { link.line().restart(drive, link.time_of(runtime.now())); };
  return out;
}

void fault(simulated::KincoDrive& drive) {
  drive.inject_fault(1, 0x0020);  // bus voltage too high
  drive.clear_fault_cause(1, 0x0020);
}

/// Storms come as often as this, so that a slow bus is loaded and not choked for good.
constexpr std::uint64_t kShortestBabble = 2, kBabbles = 20;  // ms

void calm_can(CanLinkSim& link) {
  for (std::size_t d = 0; d < link.line().size(); ++d) {
    link.line().connect(d, true);
    link.line().faults(d).set_rate(DriveFault::babble, 0);
    link.line().faults(d).set_rate(DriveFault::emergencies, 0);
  }
}

/// Whose frames a node gone mad sends: those of its own error control, EMCY or SDO server, or of nobody.
std::uint32_t babble_id(std::uint8_t node, Random& random) {
  namespace cob = simulated::cob;
  constexpr std::uint32_t kNobodys = 0x7E4;
  const std::array<std::uint32_t, 4> ids{cob::error_control + node, cob::emergency + node, cob::sdo_reply + node,
                                         kNobodys};
  return ids[static_cast<std::size_t>(random.below(ids.size()))];
}

void suffer(CanLinkSim& link, std::size_t drive, Random& random) {
  simulated::DriveFaults& faults = link.line().faults(drive);
  faults.babble_period = std::chrono::milliseconds(kShortestBabble + random.below(kBabbles));
  switch (random.below(8)) {
    case 0:
    case 1:
      return link.line().connect(drive, random.chance(1, 3));
    case 2:
      return link.bus_off();
    case 3:
      return faults.next(DriveFault::restart);
    case 4:
      return faults.next(DriveFault::mute, 1 + random.below(20));
    case 5:
      faults.emergency_code = static_cast<std::uint16_t>(0x8100 + random.below(0x100));
      return faults.set_rate(DriveFault::emergencies, random.chance(1, 2) ? 1.0 : 0.1);
    case 6:
      faults.babble_id = babble_id(link.line().node(drive).node(), random);
      return faults.set_rate(DriveFault::babble, random.chance(1, 2) ? 1.0 : 0.1);
    default:
      return calm_can(link);
  }
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

Victim victim(CanLinkSim& link, Runtime& runtime) {
  Victim out = cable(link, runtime);
  out.faulted = [&link](std::size_t drive) {
    if (simulated::KincoDrive* kinco = link.line().kinco(drive)) return fault(*kinco);
    link.line().leadshine(drive)->inject_fault(0x3211);  // supply too high
    link.line().leadshine(drive)->clear_fault_cause();
  };
  out.own_deed = [&link](std::size_t drive, Random& random) { suffer(link, drive, random); };
  out.calm = [&link] { calm_can(link); };
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
    for (std::size_t d = 0; d < victim.drives; ++d) draw_rates(victim, victim.faults(d));
}

// Each seed draws which faults there are at all, and how often they strike: between one in 25 and one in 1000 replies.
void Nemesis::draw_rates(const Victim& victim, simulated::DriveFaults& faults) {
  const auto maybe = [&](DriveFault fault) {
    if (random_.chance(1, 2)) faults.set_rate(fault, 1.0 / static_cast<double>(25 + random_.below(975)));
  };
  // Late beyond the timeout of 100 ms, within the worst_reply_ms of 500.
  faults.late_by = std::chrono::milliseconds(101 + random_.below(390));
  maybe(DriveFault::late);
  maybe(DriveFault::lose);
  maybe(DriveFault::mute);
  maybe(DriveFault::wrong_station);
  if (victim.has(DriveFault::emergencies)) {
    maybe(DriveFault::duplicate);
    maybe(DriveFault::wrong_length);
    // For now, and for good: the codes of a busy drive, of local control, and of none that says more.
    constexpr std::array<std::uint32_t, 3> kAborts{0x08000022, 0x08000021, 0x08000000};
    faults.abort_code = kAborts[static_cast<std::size_t>(random_.below(kAborts.size()))];
    maybe(DriveFault::exception);
    return;
  }
  maybe(DriveFault::noise_before);
  maybe(DriveFault::noise_after);
  maybe(DriveFault::corrupt);
  maybe(DriveFault::split);
  if (!victim.has(DriveFault::half)) return;
  maybe(DriveFault::half);
  // The length is all that tells a late reply from the fence's: a drive may break one of both rules.
  if (!faults.armed(DriveFault::late)) maybe(DriveFault::wrong_length);
  maybe(DriveFault::glued);
  // Not now, but perhaps later: no drive says at random that it has no such register.
  constexpr std::array<std::uint8_t, 5> kForNow{4, 5, 6, 8, 11};
  faults.exception_code = kForNow[static_cast<std::size_t>(random_.below(kForNow.size()))];
  maybe(DriveFault::exception);
}

void Nemesis::mend_all() {
  for (Victim& victim : victims_) {
    victim.plug();
    victim.calm();
  }
}

void Nemesis::act() {
  next_deed_ = runtime_.now() + std::chrono::milliseconds(500 + random_.below(6000));
  if (retired_) return;
  Victim& victim = victims_[static_cast<std::size_t>(random_.below(victims_.size()))];
  const auto drive = static_cast<std::size_t>(random_.below(victim.drives));
  switch (random_.below(victim.own_deed ? 8 : 4)) {
    case 0:
      if (victim.plugged())
        victim.unplug();
      else
        victim.plug();
      break;
    case 1:
      victim.restart(drive);
      break;
    case 2:
      victim.faulted(drive);
      break;
    case 3:
      mend_all();
      break;
    default:
      victim.own_deed(drive, random_);
      break;
  }
}

void Nemesis::retire() {
  retired_ = true;
  mend_all();
  for (Victim& victim : victims_)
    for (std::size_t d = 0; d < victim.drives; ++d) victim.faults(d).clear();
}

}  // namespace axisgate::test
