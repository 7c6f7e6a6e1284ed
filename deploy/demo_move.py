#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Moves one axis of the demo to and fro, as a PLC program would: enable once, then one move after the other.

It enables the axis at its start only. Whoever stops or disables the axis meanwhile has the last word: the moves go on when
somebody enables it again.
"""
import sys
import time

from pymodbus.client import ModbusTcpClient
from pymodbus.exceptions import ConnectionException

# Offsets in the block of an axis (map version 1).
COMMAND_ID_SEEN, MOTION_STATE = 30, 32
TARGET_POSITION, PROFILE_VELOCITY, COMMAND = 42, 48, 54
ENABLE, MOVE_ABSOLUTE = 1, 6
INPUT_ENABLED, INPUT_STOP_LATCHED = 2, 12
MOTION_ACTIVE = 1

TURN = 10000  # units_per_rev of the demo's axes
TARGETS = (5 * TURN, -5 * TURN)
SPEED = 600 * 1000  # 0.001 rpm
RAMP = 1500 * 10  # 0.1 rpm/s


def words(value):
    """A 32-bit value, high word first."""
    return [value >> 16 & 0xFFFF, value & 0xFFFF]


class Axis:
    def __init__(self, client, number):
        self.client = client
        self.block = 100 * number
        self.id = 0

    def write(self, offset, values):
        """False where the gateway refused it: an exception is an answer, not a crash."""
        return not self.client.write_registers(self.block + offset, values, slave=1).isError()

    def begin(self):
        """A program begins by writing command 0 with an id that it will not use next, and counts on from there."""
        seen = self.client.read_holding_registers(self.block + COMMAND_ID_SEEN, 1, slave=1)
        self.id = 1 if seen.isError() else seen.registers[0] % 0xFFFF + 1
        self.write(COMMAND, [0, self.id])

    def command(self, number):
        self.id = self.id % 0xFFFF + 1
        return self.write(COMMAND, [number, self.id])

    def may_move(self):
        inputs = self.client.read_discrete_inputs(self.block, 13, slave=1)
        return not inputs.isError() and inputs.bits[INPUT_ENABLED] and not inputs.bits[INPUT_STOP_LATCHED]

    def moving(self):
        state = self.client.read_holding_registers(self.block + MOTION_STATE, 1, slave=1)
        return not state.isError() and state.registers[0] == MOTION_ACTIVE


def move_to_and_fro(axis):
    axis.begin()
    axis.write(PROFILE_VELOCITY, words(SPEED) + words(RAMP) + words(RAMP))
    axis.command(ENABLE)
    turn = 0
    while True:
        if axis.may_move() and not axis.moving():
            if axis.write(TARGET_POSITION, words(TARGETS[turn % 2])) and axis.command(MOVE_ABSOLUTE):
                turn += 1
        time.sleep(0.3)


def main():
    if len(sys.argv) != 4:
        sys.exit("usage: demo_move.py HOST PORT AXIS")
    client = ModbusTcpClient(sys.argv[1], port=int(sys.argv[2]), timeout=3)
    if not client.connect():
        sys.exit(f"demo_move.py: cannot connect to {sys.argv[1]}:{sys.argv[2]}")
    move_to_and_fro(Axis(client, int(sys.argv[3])))


if __name__ == "__main__":
    try:
        main()
    except ConnectionException:
        sys.exit("demo_move.py: the gateway has closed the connection")
    except KeyboardInterrupt:
        pass
