// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_link/records.hpp"

#include <type_traits>

namespace axisgate::dds {
namespace {

// Each record's members, once, in the order they have on the wire; coder is an Encoder or a Decoder.
template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, StateRecord> {
  coder(r.axis, r.at, r.sequence, r.statusword, r.mode, r.position, r.velocity, r.torque, r.current, r.following_error,
        r.error_code, r.vendor_error, r.inputs, r.outputs, r.drive_temperature, r.motor_temperature, r.voltage,
        r.axis_state, r.motion_state, r.motion_id, r.alarms, r.link_state, r.supported, r.valid);
  coder.text(r.name, kMaxName);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, EventRecord> {
  coder(r.axis, r.at, r.number, r.kind, r.code);
  coder.text(r.text, kMaxText);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, BusRecord> {
  coder.text(r.name, kMaxName);
  coder(r.link, r.load_permille, r.cycle_ms, r.queue_depth);
  for (auto& counter : r.counters) coder(counter);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, GatewayRecord> {
  coder(r.state, r.axis_count, r.axes_online, r.uptime_s, r.alarms, r.events_lost);
  coder.list(r.buses, kMaxBusesShown, [&](auto& bus) { members(coder, bus); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ReplyRecord> {
  coder(r.axis, r.request_id, r.writer, r.result, r.detail);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ObjectReplyRecord> {
  coder(r.axis, r.request_id, r.writer, r.result, r.detail, r.value);
  coder.list(r.data, kMaxObjectBytes, [&](auto& byte) { coder(byte); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ReadyRecord> {
  coder.text(r.version, kMaxText);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, LogRecord> {
  coder(r.level);
  coder.text(r.text, kMaxText);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, WriterRecord> {
  coder(r.writer, r.strength, r.gone, r.liveliness);
  coder.text(r.where, kMaxName);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, BeatRecord> {
  coder(r.said);
  coder.list(r.writers, kMaxBeats, [&](auto& writer) { coder(writer); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, CommandRecord> {
  coder(r.writer, r.strength, r.written, r.gateway.key);
  coder.text(r.gateway.name, kMaxName);
  coder(r.axis, r.request_id, r.command, r.mode, r.mask, r.target_position, r.target_velocity, r.target_torque,
        r.max_torque, r.profile_velocity, r.profile_acceleration, r.profile_deceleration, r.jog_velocity,
        r.set_position_value, r.homing_method, r.received);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ObjectRequestRecord> {
  coder(r.writer, r.written, r.gateway.key);
  coder.text(r.gateway.name, kMaxName);
  coder(r.axis, r.request_id, r.write, r.index, r.subindex, r.size, r.value, r.received);
  coder.list(r.data, kMaxObjectBytes, [&](auto& byte) { coder(byte); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, JointCommandsRecord> {
  coder(r.writer, r.written, r.efforts, r.received);
  coder.list(r.names, kMaxJoints + 1, [&](auto& name) { coder.text(name, kMaxName); });
  coder.list(r.positions, kMaxJoints + 1, [&](auto& each) { coder(each); });
  coder.list(r.velocities, kMaxJoints + 1, [&](auto& each) { coder(each); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, RosActionRecord> {
  coder(r.writer, r.written, r.axis, r.action, r.received);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, IdentityRecord> {
  coder(r.number, r.guid);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, HeartbeatRecord> {
  coder(r.writer, r.client, r.counter, r.lease_ms, r.written, r.gone);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, NamesakeRecord> {
  coder(r.writer, r.axis, r.gone);
  coder.text(r.where, kMaxName);
}

/// Calls members() of the record.
constexpr auto kMembers = [](auto& coder, auto& record) { members(coder, record); };

}  // namespace

std::vector<Byte> encode(const Record& record) { return link::encode(record, kLinkVersion, kMembers); }

Decoded decode(Bytes packet) { return link::decode<Record>(packet, kLinkVersion, kMembers); }

}  // namespace axisgate::dds
