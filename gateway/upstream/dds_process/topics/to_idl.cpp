// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/topics/to_idl.hpp"
#include "gateway/upstream/dds_link/command_mask.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {

// The gateway's own half does not know the IDL.
static_assert(kHasMode == HAS_MODE && kHasTargetPosition == HAS_TARGET_POSITION &&
              kHasTargetVelocity == HAS_TARGET_VELOCITY && kHasTargetTorque == HAS_TARGET_TORQUE &&
              kHasMaxTorque == HAS_MAX_TORQUE && kHasProfileVelocity == HAS_PROFILE_VELOCITY &&
              kHasProfileAcceleration == HAS_PROFILE_ACCELERATION &&
              kHasProfileDeceleration == HAS_PROFILE_DECELERATION && kHasJogVelocity == HAS_JOG_VELOCITY &&
              kHasHomingMethod == HAS_HOMING_METHOD && kHasSetPositionValue == HAS_SET_POSITION_VALUE);

namespace {

template <typename Sample>
void put_gateway(Sample& sample, const GatewayId& gateway) {
  sample.gateway_key(gateway.key);
  sample.gateway(eprosima::fastrtps::fixed_string<kMaxGatewayName>(gateway.name));
}

template <typename Sample>
GatewayId gateway_of(const Sample& sample) {
  return {sample.gateway_key(), sample.gateway().to_string()};
}

}  // namespace

axisgate::Time to_time(SteadyNs at, ClockDifference difference) {
  axisgate::Time time;
  if (at == 0) return time;
  const std::int64_t of_day = at + difference;
  time.sec(static_cast<std::int32_t>(of_day / kSecond));
  time.nanosec(static_cast<std::uint32_t>(of_day % kSecond));
  return time;
}

axisgate::AxisState to_idl(const StateRecord& record, ClockDifference difference, const GatewayId& gateway) {
  axisgate::AxisState state;
  put_gateway(state, gateway);
  state.axis(record.axis);
  state.name(eprosima::fastrtps::fixed_string<kMaxName>(record.name));
  state.stamp(to_time(record.at, difference));
  state.sequence_number(record.sequence);
  state.statusword(record.statusword);
  state.mode(record.mode);
  state.position(record.position);
  state.velocity(record.velocity);
  state.torque(record.torque);
  state.current(record.current);
  state.following_error(record.following_error);
  state.error_code(record.error_code);
  state.vendor_error(record.vendor_error);
  state.inputs(record.inputs);
  state.outputs(record.outputs);
  state.drive_temperature(record.drive_temperature);
  state.motor_temperature(record.motor_temperature);
  state.voltage(record.voltage);
  state.axis_state(record.axis_state);
  state.motion_state(record.motion_state);
  state.motion_id(record.motion_id);
  state.alarms(record.alarms);
  state.link_state(record.link_state);
  state.supported(record.supported);
  state.valid(record.valid);
  return state;
}

axisgate::AxisEvent to_idl(const EventRecord& record, ClockDifference difference, const GatewayId& gateway) {
  axisgate::AxisEvent event;
  put_gateway(event, gateway);
  event.axis(record.axis);
  event.stamp(to_time(record.at, difference));
  event.number(record.number);
  event.kind(record.kind);
  event.code(record.code);
  event.text(eprosima::fastrtps::fixed_string<kMaxText>(record.text));
  return event;
}

namespace {

axisgate::BusState to_idl(const BusRecord& record) {
  axisgate::BusState bus;
  bus.name(eprosima::fastrtps::fixed_string<kMaxName>(record.name));
  bus.link(record.link);
  bus.load(record.load_permille / 1000.0);
  bus.cycle_ms(record.cycle_ms);
  bus.queue_depth(record.queue_depth);
  bus.requests(record.counters[0]);
  bus.replies(record.counters[1]);
  bus.timeouts(record.counters[2]);
  bus.bad_frames(record.counters[3]);
  bus.late_replies(record.counters[4]);
  bus.dropped_bytes(record.counters[5]);
  bus.refused(record.counters[6]);
  bus.coalesced(record.counters[7]);
  bus.superseded(record.counters[8]);
  bus.reconnects(record.counters[9]);
  return bus;
}

}  // namespace

axisgate::GatewayState to_idl(const GatewayRecord& record, SteadyNs now, ClockDifference difference,
                              const GatewayId& gateway) {
  axisgate::GatewayState state;
  put_gateway(state, gateway);
  state.stamp(to_time(now, difference));
  state.state(record.state);
  state.axis_count(record.axis_count);
  state.axes_online(record.axes_online);
  state.uptime_s(record.uptime_s);
  state.alarms(record.alarms);
  state.events_lost(record.events_lost);
  for (const BusRecord& bus : record.buses) state.buses().push_back(to_idl(bus));
  return state;
}

namespace {

/// What replies of both kinds begin with.
template <typename Reply, typename Of>
Reply reply_to(const Of& record, const GatewayId& gateway) {
  Reply reply;
  put_gateway(reply, gateway);
  reply.axis(record.axis);
  reply.request_id(record.request_id);
  reply.writer(record.writer);
  reply.result(record.result);
  reply.detail(record.detail);
  return reply;
}

}  // namespace

axisgate::CommandReply to_idl(const ReplyRecord& record, const GatewayId& gateway) {
  return reply_to<axisgate::CommandReply>(record, gateway);
}

axisgate::ObjectReply to_idl(const ObjectReplyRecord& record, const GatewayId& gateway) {
  auto reply = reply_to<axisgate::ObjectReply>(record, gateway);
  reply.value(record.value);
  reply.data(record.data);
  return reply;
}

CommandRecord to_record(const axisgate::AxisCommand& sample, const Sender& sender) {
  return {.writer = sender.writer,
          .strength = sender.strength,
          .written = sender.written,
          .gateway = gateway_of(sample),
          .axis = sample.axis(),
          .request_id = sample.request_id(),
          .command = sample.command(),
          .mode = sample.mode(),
          .mask = sample.mask(),
          .target_position = sample.target_position(),
          .target_velocity = sample.target_velocity(),
          .target_torque = sample.target_torque(),
          .max_torque = sample.max_torque(),
          .profile_velocity = sample.profile_velocity(),
          .profile_acceleration = sample.profile_acceleration(),
          .profile_deceleration = sample.profile_deceleration(),
          .jog_velocity = sample.jog_velocity(),
          .set_position_value = sample.set_position_value(),
          .homing_method = sample.homing_method()};
}

ObjectRequestRecord to_record(const axisgate::ObjectRequest& sample, const Sender& sender) {
  return {.writer = sender.writer,
          .written = sender.written,
          .gateway = gateway_of(sample),
          .axis = sample.axis(),
          .request_id = sample.request_id(),
          .write = sample.write(),
          .index = sample.index(),
          .subindex = sample.subindex(),
          .size = sample.size(),
          .value = sample.value(),
          .data = sample.data(),
          .received = sender.received};
}

HeartbeatRecord to_record(const axisgate::Heartbeat& sample, const Sender& sender) {
  return {.writer = sender.writer,
          .client = sample.client(),
          .counter = sample.counter(),
          .lease_ms = sample.lease_ms(),
          .written = sender.written};
}

}  // namespace axisgate::dds
