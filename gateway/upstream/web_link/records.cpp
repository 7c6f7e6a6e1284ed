// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_link/records.hpp"

#include <type_traits>

namespace axisgate::web {
namespace {

template <typename R, typename Wanted>
concept is = std::is_same_v<std::remove_const_t<R>, Wanted>;

// Each record's members, once, in the order they have on the wire; coder is an Encoder or a Decoder.
template <typename Coder, is<HelloRecord> R>
void members(Coder& coder, R& r) {
  coder(r.boot, r.started, r.axes, r.buses, r.low_word_first, r.float_numbers);
  coder.text(r.gateway, kMaxName);
  coder.text(r.version, kMaxName);
}

template <typename Coder, is<AxisInfoRecord> R>
void members(Coder& coder, R& r) {
  coder(r.axis, r.bus, r.node, r.units_numerator, r.units_denominator, r.rated_speed, r.supported_modes, r.writable,
        r.supported_commands);
  coder.text(r.name, kMaxName);
  coder.text(r.drive, kMaxName);
  coder.text(r.profile, kMaxName);
  coder.list(r.limits, kMaxQuantities, [&](auto& row) { coder(row.quantity, row.min, row.max); });
}

template <typename Coder, is<BusInfoRecord> R>
void members(Coder& coder, R& r) {
  coder(r.bus, r.planned_load_permille, r.planned_cycle_ms);
  coder.text(r.name, kMaxName);
  coder.text(r.protocol, kMaxName);
  coder.text(r.endpoint, kMaxText);
}

template <typename Coder, is<FaultWordRecord> R>
void members(Coder& coder, R& r) {
  coder(r.word, r.bit, r.whole, r.value, r.error_code);
  coder.text(r.profile, kMaxName);
  coder.text(r.text, kMaxText);
  coder.text(r.remedy, kMaxText);
}

template <typename Coder, is<SamplesRecord> R>
void members(Coder& coder, R& r) {
  coder(r.at, r.gaps);
  coder.list(r.axes, kMaxAxisNumber, [&](auto& a) {
    coder(a.axis, a.sequence, a.link_state, a.axis_state, a.motion_state, a.motion_id, a.alarms, a.supported, a.valid,
          a.inputs, a.level_coils, a.loss_stop_ms, a.jog_velocity, a.age_ms, a.lease_ms, a.result, a.result_detail,
          a.result_id, a.result_age_ms);
    coder.text(a.owner, kMaxName);
    coder.text(a.result_who, kMaxName);
    coder.text(a.result_what, kMaxName);
    coder.list(a.values, kMaxQuantities, [&](auto& value) { coder(value.quantity, value.value, value.age_us); });
  });
}

template <typename Coder, is<EventRecord> R>
void members(Coder& coder, R& r) {
  coder(r.number, r.at, r.axis, r.kind, r.code);
  coder.text(r.text, kMaxText);
}

/// Buckets and their sum.
void put(auto& coder, auto& times) {
  for (auto& count : times.counts) coder(count);
  coder(times.sum_ns);
}

template <typename Coder, is<StatisticsRecord> R>
void members(Coder& coder, R& r) {
  coder(r.at, r.state, r.axes_online, r.alarms, r.events_lost, r.worst_turn_us, r.modbus_clients, r.modbus_refused,
        r.modbus_requests, r.has_dds, r.dds_sent, r.dds_received);
  for (auto& count : r.modbus_exceptions) coder(count);
  put(coder, r.modbus_took);
  put(coder, r.loop_late);
  for (auto& count : r.events) coder(count);
  coder.list(r.programs, kMaxPrograms, [&](auto& program) {
    coder.text(program.name, kMaxName);
    coder(program.running, program.restarts);
  });
  coder.list(r.buses, kMaxBuses, [&](auto& bus) {
    coder(bus.link, bus.load_permille, bus.cycle_ms, bus.queue_depth);
    for (auto& counter : bus.counters) coder(counter);
  });
}

template <typename Coder, is<CountsRecord> R>
void members(Coder& coder, R& r) {
  coder(r.at);
  coder.list(r.buses, kMaxBuses, [&](auto& bus) {
    coder(bus.bus, bus.busy_us);
    for (auto& of_class : bus.times) put(coder, of_class);
    for (auto& of_class : bus.waits) put(coder, of_class);
  });
  coder.list(r.axes, kMaxAxisNumber, [&](auto& axis) {
    coder(axis.axis, axis.faults, axis.lease_expiries, axis.enabled_ms, axis.travel_microturns);
    coder.list(axis.commands, kMaxCommandCounts, [&](auto& each) { coder(each.command, each.result, each.count); });
  });
}

template <typename Coder, is<ReadyRecord> R>
void members(Coder& coder, R& r) {
  coder(r.confined);
  coder.text(r.version, kMaxName);
}

template <typename Coder, is<LogRecord> R>
void members(Coder& coder, R& r) {
  coder(r.level);
  coder.text(r.text, kMaxText);
}

/// Calls members() of the record.
constexpr auto kMembers = [](auto& coder, auto& record) { members(coder, record); };

}  // namespace

std::vector<Byte> encode(const Record& record) { return link::encode(record, kLinkVersion, kMembers); }

Decoded decode(Bytes packet) { return link::decode<Record>(packet, kLinkVersion, kMembers); }

}  // namespace axisgate::web
