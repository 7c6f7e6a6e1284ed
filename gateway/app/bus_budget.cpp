#include "gateway/app/bus_budget.hpp"

#include <algorithm>

#include "adapters/kinco/kinco_exchange.hpp"
#include "gateway/drive/poll_plan.hpp"

namespace axisgate::app {
namespace {

using std::chrono::milliseconds;

/// Share of the time, in 0.1 %, rounded up: a plan is never made to look better than it is.
int load_permille(const std::array<BusBudget::Polled, 3>& classes, Duration exchange) {
  double share = 0;
  for (const auto& polled : classes) {
    if (polled.period <= Duration{}) continue;
    share += static_cast<double>(polled.reads) * static_cast<double>(exchange.count()) /
             static_cast<double>(polled.period.count());
  }
  constexpr double kMost = 1000000;
  const double permille = std::min(share * 1000, kMost);
  const int whole = static_cast<int>(permille);
  return permille > whole ? whole + 1 : whole;
}

Duration stretched(Duration period, int permille) {
  return permille <= 1000 ? period : Duration(period.count() / 1000 * permille);
}

}  // namespace

BusTiming timing_of(const BusConfig& bus) {
  // kinco-serial is the only adapter so far; the loader refuses every other.
  return BusTiming{kinco::wire_time(bus.baud, bus.cascade), bus.min_gap, bus.settle, bus.timeout, bus.poll};
}

BusBudget plan_bus(const BusTiming& timing, const std::vector<drive::DriveModel>& drives) {
  BusBudget budget;
  for (std::size_t i = 0; i < budget.classes.size(); ++i) budget.classes[i].period = timing.poll[i];
  for (const drive::DriveModel& model : drives) {
    for (const drive::PollItem& item : drive::poll_items(model)) {
      if (item.poll_class == drive::PollClass::once) continue;  // read at bring-up and after writes only
      ++budget.classes[static_cast<std::size_t>(item.poll_class)].reads;
    }
  }
  budget.exchange = timing.on_wire + kAssumedAnswer;
  budget.load_on_wire = load_permille(budget.classes, timing.on_wire + timing.min_gap);
  budget.load_answered = load_permille(budget.classes, budget.exchange + timing.min_gap);
  budget.cycle = stretched(timing.poll[0], budget.load_answered);

  budget.stop_wait = budget.exchange + timing.min_gap;
  budget.command_wait = 2 * budget.stop_wait;
  // A drive that does not answer holds the line for its timeout; nothing may be sent while a late talker could collide.
  budget.stop_wait_mute = timing.timeout + std::max(timing.settle, timing.min_gap);
  budget.command_wait_mute = budget.stop_wait_mute + budget.stop_wait;
  return budget;
}

std::array<Duration, 3> comfortable_periods(const BusBudget& budget) {
  std::array<Duration, 3> periods{};
  for (std::size_t i = 0; i < periods.size(); ++i) {
    periods[i] = budget.classes[i].period;
    if (budget.load_answered <= kComfortablePermille) continue;
    constexpr Duration kStep = milliseconds(10);
    const Duration needed = periods[i] / kComfortablePermille * budget.load_answered;
    periods[i] = (needed + kStep - Duration(1)) / kStep * kStep;
  }
  return periods;
}

}  // namespace axisgate::app
