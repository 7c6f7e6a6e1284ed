// SPDX-License-Identifier: Apache-2.0
// The members of our types, in the order of schemas/axisgate.idl, for both peers: X(KIND, NAME) is defined by whoever uses a list.
// Promises that both print and take every member under its IDL name.
// Never says how a member is kept: each vendor's generator decides that.
#pragma once

#define AXIS_STATE_MEMBERS(X)                                                                                          \
  X(u64, gateway_key) X(text, gateway)                                                                                 \
  X(u64, axis) X(text, name) X(time, stamp) X(u64, sequence_number) X(u64, statusword) X(i64, mode) X(f64, position)   \
  X(f64, velocity) X(f64, torque) X(f64, current) X(f64, following_error) X(u64, error_code) X(u64, vendor_error)      \
  X(u64, inputs) X(u64, outputs) X(f64, drive_temperature) X(f64, motor_temperature) X(f64, voltage)                   \
  X(u64, axis_state) X(u64, motion_state) X(u64, motion_id) X(u64, alarms) X(u64, link_state) X(u64, supported)        \
  X(u64, valid)

#define AXIS_EVENT_MEMBERS(X)                                                                                          \
  X(u64, gateway_key) X(text, gateway)                                                                                 \
  X(u64, axis) X(time, stamp) X(u64, number) X(u64, kind) X(u64, code) X(text, text)

#define COMMAND_REPLY_MEMBERS(X)                                                                                       \
  X(u64, gateway_key) X(text, gateway) X(u64, axis) X(u64, request_id) X(guid, writer) X(u64, result) X(u64, detail)

#define OBJECT_REPLY_MEMBERS(X)                                                                                        \
  X(u64, gateway_key) X(text, gateway)                                                                                 \
  X(u64, axis) X(u64, request_id) X(guid, writer) X(u64, result) X(u64, detail) X(u64, value) X(bytes, data)

#define GATEWAY_STATE_MEMBERS(X)                                                                                       \
  X(u64, gateway_key) X(text, gateway)                                                                                 \
  X(u64, id) X(time, stamp) X(u64, state) X(u64, axis_count) X(u64, axes_online) X(u64, uptime_s) X(u64, alarms)       \
  X(u64, events_lost) X(buses, buses)

#define BUS_STATE_MEMBERS(X)                                                                                           \
  X(text, name) X(u64, link) X(f64, load) X(u64, cycle_ms) X(u64, queue_depth) X(u64, requests) X(u64, replies)        \
  X(u64, timeouts) X(u64, bad_frames) X(u64, late_replies) X(u64, dropped_bytes) X(u64, refused) X(u64, coalesced)     \
  X(u64, superseded) X(u64, reconnects)

#define JOINT_STATE_MEMBERS(X)                                                                                         \
  X(header, header) X(texts, name) X(numbers, position) X(numbers, velocity) X(numbers, effort)

// Of what is written `gateway` is left out: a bounded string is kept in another way by each.
#define AXIS_COMMAND_MEMBERS(X)                                                                                        \
  X(u32, gateway_key)                                                                                                  \
  X(u16, axis) X(u64, request_id) X(u8, command) X(i16, mode) X(u32, mask) X(f64, target_position)                     \
  X(f64, target_velocity) X(f64, target_torque) X(f64, max_torque) X(f64, profile_velocity)                            \
  X(f64, profile_acceleration) X(f64, profile_deceleration) X(f64, jog_velocity) X(f64, set_position_value)            \
  X(i16, homing_method)

#define OBJECT_REQUEST_MEMBERS(X)                                                                                      \
  X(u32, gateway_key)                                                                                                  \
  X(u16, axis) X(u64, request_id) X(flag, write) X(u16, index) X(u8, subindex) X(u8, size) X(u32, value) X(bytes, data)

#define HEARTBEAT_MEMBERS(X) X(u32, counter) X(u32, lease_ms)

#define BOOL_MEMBERS(X) X(flag, data)

#define EMPTY_MEMBERS(X) X(u8, structure_needs_at_least_one_member)

#define DIAGNOSTIC_ARRAY_MEMBERS(X) X(header, header) X(statuses, status)

#define DIAGNOSTIC_STATUS_MEMBERS(X) X(u64, level) X(text, name) X(text, message) X(text, hardware_id) X(pairs, values)

#define KEY_VALUE_MEMBERS(X) X(text, key) X(text, value)
