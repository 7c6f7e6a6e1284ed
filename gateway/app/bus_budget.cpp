#include "gateway/app/bus_budget.hpp"

#include <algorithm>

#include "adapters/kinco/kinco_exchange.hpp"
#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "adapters/modbus_rtu/rtu_timing.hpp"
#include "gateway/drive/read_blocks.hpp"

namespace axisgate::app {
namespace {

using std::chrono::milliseconds;

/// Share of the time, in 0.1 %, rounded up: a plan is never made to look better than it is.
int load_permille(const std::array<BusBudget::Polled, 3>& classes, Duration BusBudget::Polled::*taken) {
  double share = 0;
  for (const auto& polled : classes) {
    if (polled.period <= Duration{}) continue;
    share += static_cast<double>((polled.*taken).count()) / static_cast<double>(polled.period.count());
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

Duration answer_of(const drive::DriveModel& model) { return std::max(kAssumedAnswer, model.rtu.answer); }

BusTiming timing_of(const BusConfig& bus) {
  BusTiming timing{{}, bus.min_gap, bus.settle, bus.timeout, bus.poll};
  if (bus.adapter == "modbus-rtu") {
    timing.rtu_baud = bus.baud;
    timing.parity_bits = bus.parity == "none" ? 0 : 1;
    timing.on_wire = wire_time_of(timing, {0, bus::Access::write, {}, 4, 0});
  } else {
    timing.on_wire = kinco::wire_time(bus.baud, bus.cascade);
  }
  return timing;
}

Duration wire_time_of(const BusTiming& timing, const bus::Exchange& exchange) {
  if (timing.rtu_baud == 0) return timing.on_wire;
  return modbus_rtu::wire_time(timing.rtu_baud, timing.parity_bits, modbus_rtu::request_bytes(exchange),
                               modbus_rtu::reply_bytes(exchange));
}

BusBudget plan_bus(const BusTiming& timing, const std::vector<drive::DriveModel>& drives) {
  BusBudget budget;
  for (std::size_t i = 0; i < budget.classes.size(); ++i) budget.classes[i].period = timing.poll[i];
  Duration longest = timing.on_wire;
  Duration answer = kAssumedAnswer;
  for (const drive::DriveModel& model : drives) {
    answer = std::max(answer, answer_of(model));
    for (const drive::PlannedRead& read : drive::planned_reads(model)) {
      const Duration on_wire = wire_time_of(timing, read.exchange);
      longest = std::max(longest, on_wire);
      if (read.poll_class == drive::PollClass::once) continue;  // at bring-up and after writes, but a stop may meet it
      BusBudget::Polled& polled = budget.classes[static_cast<std::size_t>(read.poll_class)];
      ++polled.reads;
      polled.on_wire += on_wire + timing.min_gap;
      polled.answered += on_wire + timing.min_gap + answer_of(model);
    }
  }
  budget.exchange = longest + answer;
  budget.load_on_wire = load_permille(budget.classes, &BusBudget::Polled::on_wire);
  budget.load_answered = load_permille(budget.classes, &BusBudget::Polled::answered);
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
