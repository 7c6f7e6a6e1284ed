# SPDX-License-Identifier: Apache-2.0
"""Jog: a motor turns while a button is held, and not a moment longer, whatever becomes of the button's release."""
import time

from lease_stage import ANOTHER, COILS, ME, PANEL_1, RPM, Machine, main
from modbus import BUSY, REFUSED, STANDSTILL, Axis, Refused
from processes import until

FORWARD, REVERSE = COILS.index("jog_forward"), COILS.index("jog_reverse")
A_MOMENT = 0.2  # seconds: many turns of the gateway's and the drives' loops


class Buttons(Machine):
    lease = {"timeout_ms": 10000}
    jog_timeout_ms = 600
    axis_options = {"jog_timeout_ms": jog_timeout_ms}

    def setUp(self):
        super().setUp()
        self.begin()
        self.panel = self.peer()

    def ready(self, number):
        axis = Axis(self.panel, number)
        self.prepare(axis)
        axis.set(jog_velocity=200 * RPM)
        for name in ("jog_forward", "jog_reverse"):
            axis.coil(name, False)  # a button acts on 1 once it was 0
        self.assertEqual(axis.get("jog_velocity"), 200 * RPM)
        self.enable(axis)
        self.assertEqual(self.speed(number), 0)
        return axis

    def all_ready(self):
        return [self.ready(number) for number in self.each()]

    def hold(self, name, seconds, *axes):
        """Writes the 1 again and again: the motors turn all the while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for axis in axes:
                axis.coil(name)
                self.assertNotEqual(self.speed(axis.number), 0, f"axis {axis.number}")
                self.assertIn(name, axis.coils())

    def press(self, name, *axes):
        """Until they turn."""
        def turn():
            for axis in axes:
                axis.coil(name)
            return all(self.speed(axis.number) * (1 if name == "jog_forward" else -1) > 0 for axis in axes)

        until(f"axes {[axis.number for axis in axes]} jog", turn)

    def press_in_vain(self, name, seconds, *axes):
        """For longer than a jog would need to begin."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for axis in axes:
                try:
                    axis.coil(name)
                except Refused as refused:
                    self.assertIn(refused.code, (REFUSED, BUSY))
                self.assertEqual(self.speed(axis.number), 0, f"axis {axis.number}")
                self.assertNotIn(name, axis.coils())

    def assert_halted(self, axis):
        self.until_it_stands(axis.number)
        axis.until(axis_state=STANDSTILL)
        self.assertEqual(axis.inputs() & {"enabled", "stop_latched"}, {"enabled"}, "the end of a jog is a halt")
        self.assertFalse(axis.coils() & {"jog_forward", "jog_reverse"})


class Held(Buttons):
    def test_they_turn_while_the_coil_is_written_and_halt_on_its_release(self):
        axes = self.all_ready()
        for name, rpm in (("jog_forward", 200), ("jog_reverse", -200)):
            self.press(name, *axes)
            self.hold(name, 1.3 * self.jog_timeout_ms / 1000, *axes)

            def at_its_velocity():
                for axis in axes:
                    axis.coil(name)
                return all(abs(axis.get("velocity_actual") - rpm * RPM) < 40 * RPM for axis in axes)

            until("at their velocity", at_its_velocity)
            for axis in axes:
                axis.coil(name, False)
            for axis in axes:
                self.assert_halted(axis)


class ReleaseLost(Buttons):
    def test_they_halt_though_their_client_goes_on_reading_and_writing_other_things(self):
        axes = self.all_ready()
        pressed = {}
        for axis in axes:
            pressed[axis.number] = time.monotonic()
            self.press("jog_forward", axis)
        turning = set(pressed)

        def stand_meanwhile():
            for axis in axes:
                axis.block()
                axis.coils()
                axis.set(heartbeat=int(time.monotonic() * 100) & 0xFFFF)
                if axis.number in turning and self.speed(axis.number) == 0:
                    self.assertGreaterEqual(time.monotonic() - pressed[axis.number], self.jog_timeout_ms / 1000)
                    turning.remove(axis.number)
            return not turning

        until("they stand", stand_meanwhile)
        for axis in axes:
            self.assert_halted(axis)
        # The button that hangs: no time makes it a new press.
        self.press_in_vain("jog_forward", 1.2 * self.jog_timeout_ms / 1000, *axes)
        for axis in axes:
            axis.coil("jog_forward", False)
            self.press("jog_forward", axis)
            axis.coil("jog_forward", False)
            self.assert_halted(axis)

    def test_it_halts_when_its_client_is_gone(self):
        for number in self.each():
            axis = self.ready(number)
            self.press("jog_reverse", axis)
            self.panel.reset()
            self.until_it_stands(number)
            self.watched(number).until(axis_state=STANDSTILL, owner=ANOTHER)
            self.panel = self.peer()
            again = Axis(self.panel, number)
            again.command("disable")
            again.set(heartbeat=1)
            self.assertEqual(again.get("owner"), ME)


class BothButtons(Buttons):
    def test_both_at_once_are_a_halt(self):
        for number in self.each():
            axis = self.ready(number)
            self.press("jog_forward", axis)
            axis.coil("jog_reverse")
            self.assert_halted(axis)
            self.press_in_vain("jog_forward", A_MOMENT, axis)
            axis.coil("jog_forward", False)
            self.press_in_vain("jog_reverse", A_MOMENT, axis)
            axis.coil("jog_reverse", False)
            self.press("jog_reverse", axis)
            axis.coil("jog_reverse", False)
            self.assert_halted(axis)
            axis.command("disable")

    def test_both_in_one_request_start_nothing(self):
        for number in self.each():
            axis = self.ready(number)
            self.panel.ask(self.panel.tcp.write_coils, axis.first + FORWARD, [True, True])
            self.assertEqual(self.speed(number), 0)
            self.assert_halted(axis)
            self.panel.ask(self.panel.tcp.write_coils, axis.first + FORWARD, [False, False])
            axis.command("disable")


class Stopped(Buttons):
    def test_after_a_stop_only_a_new_press_jogs(self):
        for number in self.each():
            axis, other = self.ready(number), Axis(self.peer(PANEL_1), number)
            self.press("jog_forward", axis)
            other.coil("quick_stop")
            other.coil("quick_stop", False)
            self.until_it_stands(number)
            self.press_in_vain("jog_forward", A_MOMENT, axis)
            self.enable(axis)
            self.press_in_vain("jog_forward", 1.2 * self.jog_timeout_ms / 1000, axis)
            axis.coil("jog_forward", False)
            self.press("jog_forward", axis)
            axis.coil("jog_forward", False)
            self.assert_halted(axis)
            axis.command("disable")

    def test_a_latched_or_disabled_axis_does_not_jog(self):
        for number in self.each():
            axis = self.ready(number)
            axis.command("disable")
            with self.refused(REFUSED):
                axis.coil("jog_forward")
            axis.coil("jog_forward", False)
            self.enable(axis)
            axis.command("quick_stop")
            with self.refused(REFUSED):
                axis.coil("jog_reverse")
            axis.coil("jog_reverse", False)
            self.assertEqual(self.speed(number), 0)


class NotTheOwner(Buttons):
    def test_his_button_neither_jogs_nor_stops(self):
        for number in self.each():
            axis, other = self.ready(number), Axis(self.peer(PANEL_1), number)
            other.coil("jog_reverse", False)
            with self.refused(BUSY):
                other.coil("jog_reverse")
            self.press("jog_forward", axis)
            with self.refused(BUSY):
                other.coil("jog_reverse")
            other.coil("jog_reverse", False)  # letting go of what was pressed in vain ends nobody's jog
            self.hold("jog_forward", A_MOMENT, axis)
            axis.coil("jog_forward", False)
            self.assert_halted(axis)
            axis.command("disable")


if __name__ == "__main__":
    main()
