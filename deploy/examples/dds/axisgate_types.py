# SPDX-License-Identifier: Apache-2.0
"""The types of axisgate.idl that the examples in Python need, for Eclipse Cyclone DDS (the module cyclonedds, by pip). The order of the
members is that of the IDL, and so are the bounds: both are on the wire, or decide whether two programs match. What each member means
stands in axisgate.idl.
"""
from dataclasses import dataclass, field

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final, key
from cyclonedds.idl.types import array, bounded_str, float64, int16, int32, uint8, uint16, uint32, uint64
from cyclonedds.qos import Policy

# AxisCommand.mask: the member of that name is to be used.
HAS_TARGET_POSITION = 2

# AxisCommand.command.
ENABLE, DISABLE, MOVE_ABSOLUTE, RELEASE = 1, 2, 6, 13

# CommandReply.result.
DONE, ALREADY_SEEN = 2, 21
# With these the command has not reached the drive: somebody else has the axis, or it is not ours to command.
NOT_BEGUN = {7: "another client owns the axis", 16: "not supported", 17: "bad value", 18: "the role may not do this", 19: "busy",
             20: "no such axis", 22: "another gateway has this name and axis"}

# What the gateway reads and writes is XCDR1, whatever this version of the library prefers.
XCDR1 = Policy.DataRepresentation(use_cdrv0_representation=True)


@dataclass
@final
class Time(IdlStruct, typename="axisgate.Time"):
    sec: int32 = 0
    nanosec: uint32 = 0


@dataclass
@final
class AxisState(IdlStruct, typename="axisgate.AxisState"):
    gateway_key: uint32 = 0
    axis: uint16 = 0
    gateway: bounded_str[32] = ""
    name: bounded_str[64] = ""
    stamp: Time = field(default_factory=Time)
    sequence_number: uint32 = 0
    statusword: uint16 = 0
    mode: int16 = 0
    position: float64 = 0.0
    velocity: float64 = 0.0
    torque: float64 = 0.0
    current: float64 = 0.0
    following_error: float64 = 0.0
    error_code: uint16 = 0
    vendor_error: uint32 = 0
    inputs: uint16 = 0
    outputs: uint16 = 0
    drive_temperature: float64 = 0.0
    motor_temperature: float64 = 0.0
    voltage: float64 = 0.0
    axis_state: uint8 = 0
    motion_state: uint8 = 0
    motion_id: uint16 = 0
    alarms: uint32 = 0
    link_state: uint8 = 0
    supported: uint32 = 0
    valid: uint32 = 0
    key("gateway_key")
    key("axis")


@dataclass
@final
class AxisCommand(IdlStruct, typename="axisgate.AxisCommand"):
    gateway_key: uint32 = 0
    axis: uint16 = 0
    gateway: bounded_str[32] = ""
    request_id: uint64 = 0
    command: uint8 = 0
    mode: int16 = 0
    mask: uint32 = 0
    target_position: float64 = 0.0
    target_velocity: float64 = 0.0
    target_torque: float64 = 0.0
    max_torque: float64 = 0.0
    profile_velocity: float64 = 0.0
    profile_acceleration: float64 = 0.0
    profile_deceleration: float64 = 0.0
    jog_velocity: float64 = 0.0
    set_position_value: float64 = 0.0
    homing_method: int16 = 0
    key("gateway_key")
    key("axis")


@dataclass
@final
class Heartbeat(IdlStruct, typename="axisgate.Heartbeat"):
    client: array[uint8, 16] = field(default_factory=lambda: [0] * 16)
    counter: uint32 = 0
    lease_ms: uint32 = 0
    key("client")


@dataclass
@final
class CommandReply(IdlStruct, typename="axisgate.CommandReply"):
    gateway_key: uint32 = 0
    axis: uint16 = 0
    gateway: bounded_str[32] = ""
    request_id: uint64 = 0
    writer: array[uint8, 16] = field(default_factory=lambda: [0] * 16)
    result: uint8 = 0
    detail: uint32 = 0
    key("gateway_key")
    key("axis")
