// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/bus_budget.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "adapters/kinco/kinco_exchange.hpp"
#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "adapters/modbus_rtu/rtu_timing.hpp"
#include "gateway/config/adapter_names.hpp"
#include "gateway/drive/device/read_blocks.hpp"

namespace axisgate::config {
namespace {

using std::chrono::milliseconds;

constexpr int kLongestFrame = 8;  // data bytes of CAN
constexpr int kKeyaFrame = 12;    // bytes, of every frame of its serial protocols
constexpr std::uint8_t kLastSynchronousType = 240;
/// Without an inhibit time a TPDO may come whenever the drive finds a change: so often at least.
constexpr Duration kUninhibited = milliseconds(1);
/// Where confirming takes the whole line, the polls are still planned with this share, in 0.1 %.
constexpr int kLeastRoom = 50;

/// In 0.1 %, rounded up: a plan is never made to look better than it is.
int permille_of(double share) {
  constexpr double kMost = 1000000;
  const double permille = std::min(share * 1000, kMost);
  const int whole = static_cast<int>(permille);
  return permille > whole ? whole + 1 : whole;
}

double share_of(Duration taken, Duration period) {
  return period <= Duration{} ? 0 : static_cast<double>(taken.count()) / static_cast<double>(period.count());
}

int load_permille(const BusBudget& budget, Duration BusBudget::Polled::*taken) {
  double share = share_of(budget.confirmed.*taken, budget.confirmed.period) +
                 share_of(budget.kept_alive.*taken, budget.kept_alive.period);
  for (const auto& polled : budget.classes) share += share_of(polled.*taken, polled.period);
  return permille_of(share);
}

Duration stretched(Duration period, int permille) {
  return permille <= 1000 ? period : Duration(period.count() / 1000 * permille);
}

}  // namespace

Duration answer_of(const model::DriveModel& model) {
  return model::is_canopen(model) ? kAssumedSdoAnswer : std::max(kAssumedAnswer, model.rtu.answer);
}

BusTiming timing_of(const BusConfig& bus) {
  BusTiming timing{{}, bus.min_gap, bus.settle, bus.timeout, bus.poll};
  if (bus.adapter == adapter::kCanopen) {
    timing.can_bitrate = bus.bitrate;
    timing.begun = can_frame_time(bus.bitrate, kLongestFrame);
    timing.on_wire = 2 * timing.begun;
  } else if (bus.adapter == adapter::kKeyaCan) {
    timing.begun = extended_frame_time(bus.bitrate, kLongestFrame);
    timing.unsolicited = timing.begun;
    timing.on_wire = 2 * timing.begun;
  } else if (adapter::keya_serial(bus.adapter)) {
    timing.control = characters_time(bus.baud, kKeyaFrame);
    timing.unsolicited = bus.adapter == adapter::kKeyaRs232 ? timing.control : Duration{};
    timing.on_wire = 2 * timing.control;
  } else if (bus.adapter == adapter::kModbusRtu) {
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

namespace {

/// Each request of one drive into its class; the longest of them on the wire.
Duration add_polls(BusBudget& budget, const BusTiming& timing, const model::DriveModel& model) {
  Duration longest{};
  std::set<std::tuple<model::PollClass, std::uint16_t, std::uint8_t>> queries;
  for (const drive::PlannedRead& read : drive::planned_reads(model)) {
    const Duration on_wire = wire_time_of(timing, read.exchange);
    longest = std::max(longest, on_wire);
    if (read.poll_class == model::PollClass::once) continue;  // at bring-up and after writes, but a stop may meet it
    // One query of Keya's answers for both motors, with several objects.
    const ObjectAddress& asked = read.exchange.object;
    if (adapter::keya(model.protocol) && !queries.emplace(read.poll_class, asked.index, asked.sub).second) continue;
    BusBudget::Polled& polled = budget.classes[static_cast<std::size_t>(read.poll_class)];
    ++polled.reads;
    polled.on_wire += on_wire + timing.min_gap;
    polled.answered += on_wire + timing.min_gap + answer_of(model);
  }
  return longest;
}

/// What the gateway sends so that a drive stays enabled, one write for each axis.
void add_keep_alives(BusBudget& budget, const BusTiming& timing, const model::DriveModel& model) {
  if (model.keep_alive == Duration{}) return;
  BusBudget::Polled& kept = budget.kept_alive;
  kept.period = kept.period == Duration{} ? model.keep_alive : std::min(kept.period, model.keep_alive);
  const bool answered = timing.control == Duration{};
  const Duration on_wire = (answered ? timing.on_wire : timing.control) + timing.min_gap;
  for (const model::AxisModel& axis : model.axes) {
    if (axis.keep_alive.empty()) continue;
    ++kept.reads;
    kept.on_wire += on_wire;
    kept.answered += on_wire + (answered ? answer_of(model) : Duration{});
  }
}

/// Keya: a drive's heartbeats.
double heartbeat_share(const BusTiming& timing, const model::DriveModel& model) {
  const Duration every = model.unsolicited.every;
  return share_of(timing.unsolicited, every == Duration{} ? kAssumedHeartbeat : every);
}

/// On CANopen what is mapped is asked for now and then alone. Gives the share of the line it would take unmapped.
double add_sdo_polls(BusBudget& budget, const BusTiming& timing, const model::DriveModel& model) {
  double unmapped = 0;
  const Duration on_wire = timing.on_wire + timing.min_gap;
  for (const drive::PollItem& item : drive::poll_items(model)) {
    if (item.poll_class == model::PollClass::once) continue;
    BusBudget::Polled& polled_otherwise = budget.classes[static_cast<std::size_t>(item.poll_class)];
    unmapped += share_of(on_wire + answer_of(model), polled_otherwise.period);
    BusBudget::Polled& polled = item.mapped ? budget.confirmed : polled_otherwise;
    ++polled.reads;
    polled.on_wire += on_wire;
    polled.answered += on_wire + answer_of(model);
  }
  return unmapped;
}

/// How often a TPDO may come at most: at each change, but for its inhibit time; at its event timer; or by SYNC.
Duration shortest_period(const model::TpdoProperties& tpdo, Duration sync) {
  if (tpdo.type <= kLastSynchronousType) return sync * std::max<int>(tpdo.type, 1);
  const Duration on_change = tpdo.inhibit_time > Duration{} ? tpdo.inhibit_time : kUninhibited;
  return tpdo.event_ms ? std::min<Duration>(on_change, milliseconds(*tpdo.event_ms)) : on_change;
}

double unsolicited_share(const BusTiming& timing, const model::DriveModel& model) {
  const model::CanopenProperties& facts = model.canopen;
  const auto frame = [&](int bytes) { return can_frame_time(timing.can_bitrate, bytes); };
  double share = share_of(frame(1), facts.heartbeat) + share_of(frame(0) + frame(1), facts.guard_time);
  for (const model::TpdoProperties& tpdo : facts.tpdos) {
    int bytes = 0;
    for (const model::ObjectId id : tpdo.map) bytes += model.object(id).size;
    share += share_of(frame(bytes), shortest_period(tpdo, facts.sync));
  }
  return share;
}

/// The gateway's own frames beside the exchanges, once for all drives: at the shortest period that any asks for.
double own_share(const BusTiming& timing, const std::vector<model::DriveModel>& drives) {
  double heartbeat = 0;
  double sync = 0;
  for (const model::DriveModel& model : drives) {
    heartbeat = std::max(heartbeat, share_of(can_frame_time(timing.can_bitrate, 1), model.canopen.own_heartbeat));
    sync = std::max(sync, share_of(can_frame_time(timing.can_bitrate, 0), model.canopen.sync));
  }
  return heartbeat + sync;
}

void plan_can(BusBudget& budget, const BusTiming& timing, const std::vector<model::DriveModel>& drives) {
  double unmapped = 0;
  double unsolicited = own_share(timing, drives);
  for (const model::DriveModel& model : drives) {
    const Duration confirm = model.canopen.confirm;
    Duration& period = budget.confirmed.period;
    period = period == Duration{} ? confirm : std::min(period, confirm);
    unmapped += add_sdo_polls(budget, timing, model);
    unsolicited += unsolicited_share(timing, model);
  }
  budget.load_unmapped = permille_of(unmapped);
  budget.load_unsolicited = permille_of(unsolicited);
}

/// The write of a part goes behind a read of its whole, in one turn.
bool any_parts(const std::vector<model::DriveModel>& drives) {
  const auto is_written = [](const model::ObjectDef& object) { return object.is_part() && object.writable; };
  return std::ranges::any_of(
      drives, [&](const model::DriveModel& model) { return std::ranges::any_of(model.objects, is_written); });
}

}  // namespace

BusBudget plan_bus(const BusTiming& timing, const std::vector<model::DriveModel>& drives) {
  BusBudget budget;
  for (std::size_t i = 0; i < budget.classes.size(); ++i) budget.classes[i].period = timing.poll[i];
  const bool can = timing.can_bitrate != 0;
  Duration longest = timing.on_wire;
  Duration answer = can ? kAssumedSdoAnswer : kAssumedAnswer;
  double heartbeats = 0;
  for (const model::DriveModel& model : drives) {
    answer = std::max(answer, answer_of(model));
    if (!can) longest = std::max(longest, add_polls(budget, timing, model));
    add_keep_alives(budget, timing, model);
    heartbeats += heartbeat_share(timing, model);
  }
  budget.load_unsolicited = permille_of(heartbeats);
  if (can) plan_can(budget, timing, drives);
  budget.exchange = longest + answer;
  budget.load_on_wire = load_permille(budget, &BusBudget::Polled::on_wire);
  budget.load_answered = load_permille(budget, &BusBudget::Polled::answered);
  if (!can) budget.load_unmapped = budget.load_answered;
  budget.cycle = stretched(timing.poll[0], budget.load_answered);

  const Duration before = any_parts(drives) ? budget.exchange + timing.min_gap : Duration{};
  budget.stop_wait = before + budget.exchange + timing.min_gap + timing.begun;
  budget.command_wait = 2 * budget.stop_wait;
  // A drive that does not answer holds the line for its timeout; nothing may be sent while a late talker could collide.
  budget.stop_wait_unresponsive = before + timing.timeout + std::max(timing.settle, timing.min_gap) + timing.begun;
  budget.command_wait_unresponsive = budget.stop_wait_unresponsive + budget.stop_wait;
  return budget;
}

int BusBudget::load_confirmed() const { return permille_of(share_of(confirmed.answered, confirmed.period)); }

int BusBudget::load_fixed() const {
  return permille_of(share_of(confirmed.answered, confirmed.period) + share_of(kept_alive.answered, kept_alive.period));
}

std::array<Duration, 3> comfortable_periods(const BusBudget& budget) {
  std::array<Duration, 3> periods{};
  // What is confirmed and what keeps drives enabled have their own periods: the classes share what is left.
  const int fixed = budget.load_fixed();
  const int room = std::max(kComfortablePermille - fixed, kLeastRoom);
  const int polled = budget.load_answered - fixed;
  for (std::size_t i = 0; i < periods.size(); ++i) {
    periods[i] = budget.classes[i].period;
    if (polled <= room) continue;
    constexpr Duration kStep = milliseconds(10);
    const Duration needed = periods[i] / room * polled;
    periods[i] = (needed + kStep - Duration(1)) / kStep * kStep;
  }
  return periods;
}

}  // namespace axisgate::config
