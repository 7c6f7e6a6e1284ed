# SPDX-License-Identifier: Apache-2.0
"""Jog: a motor turns while a button is held, and not a moment longer, whatever becomes of the button's release. What else a jog does is
told of each drive by tests/obey and tests/unit/drive."""
import time

from lease_stage import ANOTHER, RPM, Machine, main
from modbus import BUSY, REFUSED, STANDSTILL, Axis, Refused
from processes import until


class Buttons(Machine):
    lease = {"timeout_ms": 10000}
    jog_timeout_ms = 600
    axis_options = {"jog_timeout_ms": jog_timeout_ms}

    def setUp(self):
        super().setUp()
        self.begin()
        self.panel = self.peer()
        self.axes = [Axis(self.panel, number) for number in self.numbers]
        for axis in self.axes:
            self.prepare(axis)
            axis.set(jog_velocity=200 * RPM)
            for name in ("jog_forward", "jog_reverse"):
                axis.coil(name, False)  # a button acts on 1 once it was 0
            self.enable(axis)
            self.assertEqual(self.speed(axis.number), 0)

    def press(self, name, *axes):
        """Until they turn."""
        def turn():
            for axis in axes:
                axis.coil(name)
            return all(self.speed(axis.number) * (1 if name == "jog_forward" else -1) > 0 for axis in axes)

        until(f"axes {[axis.number for axis in axes]} jog", turn)

    def assert_halted(self, axis):
        self.until_it_stands(axis.number)
        axis.until(axis_state=STANDSTILL)
        self.assertEqual(axis.inputs() & {"enabled", "stop_latched"}, {"enabled"}, "the end of a jog is a halt")
        self.assertFalse(axis.coils() & {"jog_forward", "jog_reverse"})

    def test_they_turn_while_the_coil_is_written_and_halt_on_its_release(self):
        for name in ("jog_forward", "jog_reverse"):
            self.press(name, *self.axes)
            end = time.monotonic() + 1.3 * self.jog_timeout_ms / 1000
            while time.monotonic() < end:
                for axis in self.axes:
                    axis.coil(name)
                    self.assertNotEqual(self.speed(axis.number), 0, f"axis {axis.number}")
            for axis in self.axes:
                axis.coil(name, False)
            for axis in self.axes:
                self.assert_halted(axis)

    def test_they_halt_though_their_client_goes_on_reading_and_writing_other_things(self):
        pressed = {}
        for axis in self.axes:
            pressed[axis.number] = time.monotonic()
            self.press("jog_forward", axis)
        turning = set(pressed)

        def stand_meanwhile():
            for axis in self.axes:
                axis.block()
                axis.set(heartbeat=int(time.monotonic() * 100) & 0xFFFF)
                if axis.number in turning and self.speed(axis.number) == 0:
                    self.assertGreaterEqual(time.monotonic() - pressed[axis.number], self.jog_timeout_ms / 1000)
                    turning.remove(axis.number)
            return not turning

        until("they stand", stand_meanwhile)
        for axis in self.axes:
            self.assert_halted(axis)
        # The button that hangs: no time makes it a new press.
        end = time.monotonic() + 1.2 * self.jog_timeout_ms / 1000
        while time.monotonic() < end:
            for axis in self.axes:
                try:
                    axis.coil("jog_forward")
                except Refused as refused:
                    self.assertIn(refused.code, (REFUSED, BUSY))
                self.assertEqual(self.speed(axis.number), 0, f"axis {axis.number}")
        self.press_anew_and_go()

    def press_anew_and_go(self):
        """The connection of a pressed button is reset."""
        for axis in self.axes:
            axis.coil("jog_forward", False)
            self.press("jog_reverse", axis)
        self.panel.reset()
        for number in self.each():
            self.until_it_stands(number)
            self.watched(number).until(axis_state=STANDSTILL, owner=ANOTHER)


if __name__ == "__main__":
    main()
