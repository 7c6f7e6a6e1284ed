# SPDX-License-Identifier: Apache-2.0
"""The register map of the contract, written down anew, and two clients that nobody here wrote: pymodbus and mbpoll."""
import logging
import re
import subprocess

from pymodbus.client import ModbusTcpClient
from pymodbus.exceptions import ConnectionException
from pymodbus.pdu import ExceptionResponse

from processes import NEVER, until

AXIS = {
    "statusword": (0, "u16"), "mode_display": (1, "i16"), "position_actual": (2, "i32"), "velocity_actual": (4, "i32"),
    "torque_actual": (6, "i16"), "current_actual": (7, "i16"), "following_error": (8, "i32"), "error_code": (10, "u16"),
    "digital_inputs": (11, "u16"), "vendor_error": (12, "u32"), "digital_outputs": (14, "u16"), "drive_temperature": (15, "i16"),
    "motor_temperature": (16, "i16"), "dc_voltage": (17, "u16"), "link_state": (18, "u16"), "age_ms": (19, "u16"),
    "supported": (20, "u32"), "valid": (22, "u32"), "sequence": (24, "u16"), "command_result": (25, "u16"),
    "command_detail": (26, "u32"), "owner": (28, "u16"), "lease_remaining_ms": (29, "u16"), "command_id_seen": (30, "u16"),
    "axis_state": (31, "u16"), "motion_state": (32, "u16"), "motion_id": (33, "u16"), "axis_alarms": (34, "u32"),
    "supported_commands": (36, "u32"), "supported_modes": (38, "u16"), "controlword": (40, "u16"), "mode": (41, "i16"),
    "target_position": (42, "i32"), "target_velocity": (44, "i32"), "target_torque": (46, "i16"), "max_torque": (47, "u16"),
    "profile_velocity": (48, "u32"), "profile_acceleration": (50, "u32"), "profile_deceleration": (52, "u32"),
    "command": (54, "u16"), "command_id": (55, "u16"), "heartbeat": (56, "u16"), "homing_method": (60, "i16"),
    "homing_speed_switch": (62, "u32"), "homing_speed_zero": (64, "u32"), "homing_acceleration": (66, "u32"),
    "homing_offset": (68, "i32"), "position_limit_min": (72, "i32"), "position_limit_max": (74, "i32"), "max_velocity": (76, "u32"),
    "set_position_value": (78, "i32"), "object_request": (80, "u16"), "object_index": (81, "u16"), "object_subindex": (82, "u16"),
    "object_size": (83, "u16"), "object_data": (84, "u32"), "object_status": (86, "u16"), "object_detail": (88, "u32"),
    "units_per_rev_numerator": (90, "u32"), "units_per_rev_denominator": (92, "u32"), "rated_speed": (94, "u32"),
    "owner_address": (96, "u32"), "loss_stop_ms": (98, "u16"),
}
COILS = ["enable", "fault_reset", "quick_stop", "halt", "start_absolute", "start_relative", "home", "run_velocity"]
INPUTS = ["online", "ready", "enabled", "fault", "warning", "target_reached", "homed", "moving", "limit_active",
          "quick_stop_active", "following_error", "owned_by_me", "stop_latched"]
COMMANDS = {"enable": 1, "disable": 2, "quick_stop": 3, "halt": 4, "fault_reset": 5, "move_absolute": 6, "move_relative": 7,
            "run_velocity": 8, "run_torque": 9, "home": 10, "set_position": 11, "save_parameters": 12}
OVERVIEW = {"statusword": (0, "u16"), "mode_display": (1, "i16"), "position_actual": (2, "i32"), "velocity_actual": (4, "i32"),
            "torque_actual": (6, "i16"), "error_code": (7, "u16"), "link_state": (8, "u16"), "sequence": (9, "u16")}
GATEWAY = {"map_version": (0, "u16"), "axis_count": (1, "u16"), "gateway_state": (2, "u16"), "axes_online": (3, "u16"),
           "uptime_s": (4, "u32"), "alarms": (6, "u16"), "role": (7, "u16"), "heartbeat": (8, "u16"), "word_order_test": (10, "u32")}
BUS = {"link": (0, "u16"), "load": (1, "u16"), "cycle_ms": (2, "u16"), "queue_depth": (3, "u16"), "requests": (4, "u32"),
       "replies": (6, "u32"), "timeouts": (8, "u32"), "bad_frames": (10, "u32"), "late_replies": (12, "u32"),
       "dropped_bytes": (14, "u32"), "refused": (16, "u32"), "coalesced": (18, "u32"), "superseded": (20, "u32"),
       "reconnects": (22, "u32")}

UNKNOWN, SETUP, ONLINE, SUSPECT, OFFLINE, LINK_DOWN = range(6)
DISABLED, STANDSTILL, DISCRETE, CONTINUOUS, HOMING, STOPPING, ERROR_STOP, OUT_OF_SIGHT = range(8)
NO_MOTION, ACTIVE, COMPLETED, ABORTED, FAILED = range(5)
ALARM_ADOPTED, ALARM_LOCAL_CONTROL, ALARM_CANNOT_DEENERGISE, ALARM_STOP_LATCHED = 1 << 1, 1 << 3, 1 << 6, 1 << 7
NO_FUNCTION, NO_ADDRESS, BAD_VALUE, REFUSED, BUSY, NO_PATH, NO_ANSWER = 0x01, 0x02, 0x03, 0x04, 0x06, 0x0A, 0x0B


logging.getLogger("pymodbus").setLevel(logging.CRITICAL)  # what it meets is asserted, not logged


class Refused(Exception):
    def __init__(self, code):
        super().__init__(f"exception {code:#04x}")
        self.code = code


class Closed(Exception):
    pass


def decode(kind, registers):
    value = registers[0] if len(registers) == 1 else registers[0] << 16 | registers[1]
    bits = 16 * len(registers)
    return value - (1 << bits) if kind.startswith("i") and value >> (bits - 1) else value


def encode(kind, value):
    return [value & 0xFFFF] if kind.endswith("16") else [value >> 16 & 0xFFFF, value & 0xFFFF]


def width(kind):
    return 1 if kind.endswith("16") else 2


class Client:
    """One pymodbus connection. Refusals are raised with their exception code."""

    def __init__(self, port, unit=1):
        self.unit = unit
        self.tcp = ModbusTcpClient("127.0.0.1", port=port, timeout=NEVER, retries=0)
        if not self.tcp.connect():
            raise Closed(f"no connection to port {port}")

    def close(self):
        self.tcp.close()

    def ask(self, function, *arguments):
        """Calls a function of pymodbus's client for our unit."""
        try:
            reply = function(*arguments, slave=self.unit)
        except (ConnectionException, OSError) as failed:
            raise Closed(str(failed)) from None
        return self.checked(reply)

    def checked(self, reply):
        if isinstance(reply, ExceptionResponse):
            raise Refused(reply.exception_code)
        if reply.isError():
            raise Closed(str(reply))
        return reply

    def execute(self, request):
        return self.checked(self.tcp.execute(request))

    def registers(self, address, count=1):
        return self.ask(self.tcp.read_holding_registers, address, count).registers

    def write(self, address, *values):
        """FC 6 for one register, FC 16 for more."""
        if len(values) == 1:
            self.ask(self.tcp.write_register, address, values[0])
        else:
            self.ask(self.tcp.write_registers, address, list(values))

    def table(self, rows, first):
        """All rows of a table as one read shows them."""
        end = max(offset + width(kind) for offset, kind in rows.values())
        registers = self.registers(first, end)
        return {name: decode(kind, registers[offset:offset + width(kind)]) for name, (offset, kind) in rows.items()}

    def gateway(self):
        return self.table(GATEWAY, 0)

    def bus(self, number):
        return self.table(BUS, 50000 + 100 * number)

    def overview(self, axis):
        return self.table(OVERVIEW, 60000 + 10 * axis)

    def axis(self, number):
        return Axis(self, number)


class Axis:
    """One axis as one client sees it. `first` is the address of its block."""

    def __init__(self, client, number, first=None):
        self.client = client
        self.number = number
        self.first = 100 * number if first is None else first
        self.id = None

    def get(self, name):
        offset, kind = AXIS[name]
        return decode(kind, self.client.registers(self.first + offset, width(kind)))

    def block(self):
        """All that a cyclic scanner reads, and the rows it writes, from one look."""
        return self.client.table(AXIS, self.first)

    def set(self, **values):
        for name, value in values.items():
            offset, kind = AXIS[name]
            self.client.write(self.first + offset, *encode(kind, value))

    def command(self, name):
        """With a command_id, as a program does it; the id is returned."""
        if self.id is None:
            self.begin()
        self.id = self.id % 0xFFFF + 1
        self.client.write(self.first + 54, COMMANDS[name], self.id)
        return self.id

    def begin(self):
        """A program begins by writing command 0 with an id that it will not use next."""
        self.id = self.get("command_id_seen") % 0xFFFF + 1
        self.client.write(self.first + 54, 0, self.id)

    def coil(self, name, on=True):
        address = self.first + COILS.index(name)
        self.client.ask(self.client.tcp.write_coil, address, on)

    def coils(self):
        bits = self.client.ask(self.client.tcp.read_coils, self.first, len(COILS)).bits
        return {name for name, bit in zip(COILS, bits) if bit}

    def inputs(self):
        reply = self.client.ask(self.client.tcp.read_discrete_inputs, self.first, len(INPUTS))
        return {name for name, bit in zip(INPUTS, reply.bits) if bit}

    def until(self, **wanted):
        """Polls the block until these rows read so: the block."""
        def look():
            block = self.block()
            return block if all(block[name] == value for name, value in wanted.items()) else None

        try:
            return until(f"axis {self.number} reads {wanted}", look)
        except AssertionError as failed:
            raise AssertionError(f"{failed}; it reads {self.block()}") from None

    def until_input(self, name, on=True):
        until(f"input {name} of axis {self.number} is {on}", lambda: (name in self.inputs()) == on)


def mbpoll(port, table, address, *values, count=1, unit=1):
    """One call of the program: what it read, or Refused with its own words."""
    command = ["mbpoll", "-m", "tcp", "-p", str(port), "-a", str(unit), "-0", "-1", "-q", "-o", "10", "-t", table, "-r", str(address)]
    command += [] if values else ["-c", str(count)]
    command += ["-B", "127.0.0.1", *["--"][:bool(values)], *map(str, values)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=NEVER, check=False)
    if done.returncode != 0:
        raise MbpollFailed(done.stdout + done.stderr)
    return [int(value) for value in re.findall(r"^\[\d+\]:\s+(-?\d+)", done.stdout, re.M)]


class MbpollFailed(Exception):
    pass
