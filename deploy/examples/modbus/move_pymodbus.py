#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Moves one axis and lets it go again: move_pymodbus.py HOST PORT AXIS TURNS RPM

Enables it, moves it to TURNS, waits until it is there, disables it. Ctrl-C and SIGTERM stop it before the program ends; if the program
dies, or its network does, the gateway stops it when the lease has run out. Needs pymodbus (Debian: python3-pymodbus).
"""
import signal
import sys
import threading

from pymodbus.client import ModbusTcpClient

# Offsets in the block of an axis, which begins at 100 * axis (schemas/register-map.md).
LINK_STATE, RESULT, DETAIL, ID_SEEN, MOTION_STATE, MOTION_ID = 18, 25, 26, 30, 32, 33
TARGET_POSITION, PROFILE_VELOCITY, COMMAND, UNITS_PER_REV = 42, 48, 54, 90
ENABLE, DISABLE, QUICK_STOP, MOVE_ABSOLUTE, RELEASE = 1, 2, 3, 6, 13
ONLINE, ACTIVE, COMPLETED = 2, 1, 2

ended = threading.Event()  # no request is cut in two by a signal


class Axis:
    def __init__(self, client, number):
        self.client, self.first = client, 100 * number
        # A program begins by writing command 0, which asks for nothing, with an id that it will not use next: from then on a new id
        # is a new command, and the same request sent twice is carried out once.
        self.id = self.read(ID_SEEN, 1)[0] % 0xFFFF + 1
        self.write(COMMAND, 0, self.id)

    def read(self, offset, count):
        reply = self.client.read_holding_registers(self.first + offset, count=count)
        if reply.isError():
            raise RuntimeError(f"reading offset {offset}: {reply}")
        return reply.registers

    def write(self, offset, *words):
        """The answer comes when the drive has acknowledged, so what follows can rely on it."""
        reply = self.client.write_registers(self.first + offset, list(words))
        if reply.isError():
            result, high, low = self.read(RESULT, 3)
            raise RuntimeError(f"writing offset {offset}: {reply}; `axisgate explain result {result}`, detail {high << 16 | low:#x}")

    def write32(self, offset, value):
        self.write(offset, value >> 16 & 0xFFFF, value & 0xFFFF)  # high word first, both in one request

    def command(self, number):
        self.id = self.id % 0xFFFF + 1  # 1 to 65535; 0 is no id
        self.write(COMMAND, number, self.id)

    def units(self, turns):
        numerator_high, numerator, denominator_high, denominator = self.read(UNITS_PER_REV, 4)
        return round(turns * (numerator_high << 16 | numerator) / (denominator_high << 16 | denominator))

    def until_there(self):
        """Each read is a sign of life: without one for the time of the lease (2 s) the gateway stops the axis."""
        while not ended.wait(0.1):
            state, motion = self.read(MOTION_STATE, 2)
            if motion == self.id and state != ACTIVE:
                return state == COMPLETED
        print("stopping", flush=True)
        return False


def main():
    host, port, number, turns, rpm = sys.argv[1:6]
    for number_of_signal in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number_of_signal, lambda *_: ended.set())
    client = ModbusTcpClient(host, port=int(port), timeout=5)
    if not client.connect():
        sys.exit(f"no gateway at {host}:{port}")
    axis = Axis(client, int(number))
    if axis.read(LINK_STATE, 1)[0] != ONLINE:
        sys.exit(f"axis {number} is not online")
    there = False
    try:
        axis.command(ENABLE)
        axis.write32(PROFILE_VELOCITY, round(float(rpm) * 1000))
        axis.write32(TARGET_POSITION, axis.units(float(turns)))
        axis.command(MOVE_ABSOLUTE)
        print(f"moving to {turns} turns", flush=True)
        there = axis.until_there()
        print("there" if there else "not there", flush=True)
    finally:
        if not there:
            axis.command(QUICK_STOP)
        axis.command(DISABLE)
        axis.command(RELEASE)  # others need not wait for the end of the lease
        client.close()
    sys.exit(0 if there else 1)


main()
