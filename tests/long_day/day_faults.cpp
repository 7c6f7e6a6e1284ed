// SPDX-License-Identifier: Apache-2.0
#include "tests/long_day/day_faults.hpp"

namespace axisgate::test::long_day {
namespace {

using simulated::DriveFault;

constexpr std::array<const char*, kKinds> kNames{"unplugged", "cut",       "restarted", "lost",   "late",
                                                 "doubled",   "corrupted", "noise",     "stalled"};

}  // namespace

void DayFaults::begin() {
  line_ = random_.below(lines_.size());
  drive_ = random_.below(drives_on(lines_[line_]));
  const auto kind = static_cast<Kind>(random_.below(kKinds));
  ++count_.at(static_cast<std::size_t>(kind));
  switch (kind) {
    case Kind::unplugged:
      stage_.at_link(line_, [](auto& link) { link.unplug(); });
      break;
    case Kind::cut:
      stage_.at_link(line_, [](auto& link) { link.cut_wire(); });
      break;
    case Kind::restarted:
      stage_.at_link(line_, [this](auto& link) { link.restart(drive_); });
      break;
    case Kind::lost:
      strike_often(DriveFault::lose);
      break;
    case Kind::late:
      strike_often(DriveFault::late);
      break;
    case Kind::doubled:
      strike_often(DriveFault::duplicate);
      break;
    case Kind::corrupted:
      strike_often(DriveFault::corrupt);
      break;
    case Kind::noise:
      strike_often(DriveFault::noise_before);
      break;
    case Kind::stalled:
      stage_.runtime().stall(std::chrono::milliseconds(500 + random_.below(2'500)));
      break;
  }
  // Of each it may be some: a link that goes, and what the drives of a line say when they are back.
  lost_links_[line_] += 2 + drives_on(lines_[line_]);
}

void DayFaults::strike_often(DriveFault fault) {
  constexpr std::array kRates{0.01, 0.1, 0.5};
  constexpr std::array<std::int64_t, 4> kLateMs{20, 80, 200, 600};
  const double rate = kRates.at(random_.below(kRates.size()));
  const auto late_by = std::chrono::milliseconds(kLateMs.at(random_.below(kLateMs.size())));
  stage_.at_link(line_, [&](auto& link) {
    if (!link.line().has(fault)) return;
    link.line().faults(drive_).late_by = late_by;
    link.line().faults(drive_).set_rate(fault, rate);
  });
}

void DayFaults::end() {
  stage_.at_link(line_, [this](auto& link) {
    link.line().faults(drive_).clear();
    link.plug();
    link.mend_wire();
  });
}

std::string DayFaults::told() const {
  std::string out;
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    out += std::string(out.empty() ? " " : ", ") + kNames.at(kind) + " " + std::to_string(count_.at(kind));
  return out;
}

}  // namespace axisgate::test::long_day
