# SPDX-License-Identifier: Apache-2.0
"""A panel that counts in turns and rpm and can only write one register at a time (function 6) moves a motor."""
import re
import subprocess

from pymodbus.constants import Endian
from pymodbus.payload import BinaryPayloadBuilder, BinaryPayloadDecoder

from modbus import BAD_VALUE, NO_ADDRESS, STANDSTILL
from processes import NEVER, until
from stage import Story, main

PLC, PANEL, OTHER_PANEL = range(3)
POSITION, VELOCITY, RESULT, DETAIL, STATE = 2, 4, 25, 26, 31
TARGET, PROFILE_VELOCITY, PROFILE_ACCELERATION, PROFILE_DECELERATION, COMMAND = 42, 48, 50, 52, 54
ENABLE, MOVE_ABSOLUTE = 1, 6
COUNTS = 10000  # of a turn, in the drive and in the PLC's registers


class Panel:
    """Floats as pymodbus makes them, low word first, each register by a function 6 of its own; unit 1 is axis 1."""

    def __init__(self, client):
        self.client = client

    def halves(self, value):
        builder = BinaryPayloadBuilder(byteorder=Endian.Big, wordorder=Endian.Little)
        builder.add_32bit_float(value)
        return builder.to_registers()

    def set(self, offset, value, backwards=False):
        halves = list(enumerate(self.halves(value)))
        for place, half in reversed(halves) if backwards else halves:
            self.client.write(offset + place, half)

    def get(self, offset):
        registers = self.client.registers(offset, 2)
        return BinaryPayloadDecoder.fromRegisters(registers, byteorder=Endian.Big, wordorder=Endian.Little).decode_32bit_float()

    def command(self, number):
        self.client.write(COMMAND, 0)
        self.client.write(COMMAND, number)


class InTurns(Story):
    def setUp(self):
        super().setUp()
        panel = {"numbers": "float", "halves": "staged"}
        self.start(listeners=[self.listener(), self.listener(word_order="low-first", unit_ids="per-axis", **panel),
                              self.listener(**panel)])
        self.panel = Panel(self.connect(PANEL, unit=1))

    def mbpoll_floats(self, address, count):
        """As another client reads them that nobody here wrote."""
        done = subprocess.run(["mbpoll", "-m", "tcp", "-p", str(self.ports[OTHER_PANEL]), "-0", "-1", "-q", "-o", "10", "-t", "4:float", "-B",
                               "-r", str(address), "-c", str(count), "127.0.0.1"], capture_output=True, text=True, timeout=NEVER, check=True)
        return [float(value) for value in re.findall(r"^\[\d+\]:\s+(\S+)", done.stdout, re.M)]

    def test_a_move_is_set_started_and_seen_in_turns(self):
        self.panel.set(PROFILE_VELOCITY, 600.0)
        self.panel.set(PROFILE_ACCELERATION, 3000.0, backwards=True)
        self.panel.set(PROFILE_DECELERATION, 3000.0)
        self.panel.command(ENABLE)
        self.panel.set(TARGET, 2.5)
        self.panel.command(MOVE_ABSOLUTE)
        until("the panel shows 2.5 turns", lambda: abs(self.panel.get(POSITION) - 2.5) < 0.001)
        self.assertAlmostEqual(self.sim.object("lift/1", "6063.00"), 2.5 * COUNTS, delta=8)
        self.assertAlmostEqual(self.axis(1).get("position_actual"), 2.5 * COUNTS, delta=8)
        self.axis(1).until(axis_state=STANDSTILL)
        self.panel.set(TARGET, -0.25, backwards=True)
        self.panel.command(MOVE_ABSOLUTE)
        until("the other panel shows -0.25 turns", lambda: abs(self.mbpoll_floats(100 + POSITION, 1)[0] + 0.25) < 0.001)
        self.assertAlmostEqual(self.sim.object("lift/1", "6063.00"), -0.25 * COUNTS, delta=8)
        velocity, acceleration = self.mbpoll_floats(100 + PROFILE_VELOCITY, 2)
        self.assertAlmostEqual(velocity, 600, delta=1)
        self.assertAlmostEqual(acceleration, 3000, delta=20)
        self.assertAlmostEqual(self.panel.get(PROFILE_VELOCITY), velocity)

    def test_a_lone_half_changes_nothing_and_says_so(self):
        self.panel.set(PROFILE_VELOCITY, 600.0)
        held = self.panel.get(PROFILE_VELOCITY)
        self.assertAlmostEqual(held, 600, delta=1)
        # With the low half of 600 it would be 2400.
        self.panel.client.write(PROFILE_VELOCITY + 1, self.panel.halves(2400.0)[1])
        self.assertEqual(self.panel.get(PROFILE_VELOCITY), held)
        until("it is dropped", lambda: self.panel.client.registers(RESULT)[0] == 6)
        low, high = self.panel.client.registers(DETAIL, 2)
        self.assertEqual(high << 16 | low, 0x0A000000 + PROFILE_VELOCITY)
        self.gateway.wait_for("half of row 48 of axis 1, profile_velocity, was written and is dropped")
        self.panel.client.write(PROFILE_VELOCITY, self.panel.halves(600.0)[0])  # a new first half
        self.assertEqual(self.panel.get(PROFILE_VELOCITY), held)

    def test_what_is_no_number_is_refused(self):
        self.panel.client.write(TARGET, 0)
        with self.refused(BAD_VALUE):
            self.panel.client.write(TARGET + 1, 0x7FC0)
        with self.refused(NO_ADDRESS):
            self.client.write(100 + TARGET, 0)  # the PLC's listener knows no halves
        with self.refused(BAD_VALUE):
            self.connect(OTHER_PANEL).write(100 + TARGET, 0x7F80, 0)


if __name__ == "__main__":
    main()
