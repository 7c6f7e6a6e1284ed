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

    def hold(self, axis, name, seconds):
        """Writes the 1 again and again: the motor turns all the while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            axis.coil(name)
            self.assertNotEqual(self.speed(axis.number), 0)
            self.assertIn(name, axis.coils())

    def press(self, axis, name):
        """Until it turns."""
        def turns():
            axis.coil(name)
            return self.speed(axis.number) * (1 if name == "jog_forward" else -1) > 0

        until(f"axis {axis.number} jogs", turns)

    def press_in_vain(self, axis, name, seconds):
        """For longer than a jog would need to begin."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                axis.coil(name)
            except Refused as refused:
                self.assertIn(refused.code, (REFUSED, BUSY))
            self.assertEqual(self.speed(axis.number), 0)
            self.assertNotIn(name, axis.coils())

    def assert_halted(self, axis):
        self.until_it_stands(axis.number)
        axis.until(axis_state=STANDSTILL)
        self.assertEqual(axis.inputs() & {"enabled", "stop_latched"}, {"enabled"}, "the end of a jog is a halt")
        self.assertFalse(axis.coils() & {"jog_forward", "jog_reverse"})


class Held(Buttons):
    def test_it_turns_while_the_coil_is_written_and_halts_on_its_release(self):
        for number in self.each():
            axis = self.ready(number)
            for name, rpm in (("jog_forward", 200), ("jog_reverse", -200)):
                self.press(axis, name)
                self.hold(axis, name, 1.3 * self.jog_timeout_ms / 1000)
                until("at its velocity", lambda: axis.coil(name) or abs(axis.get("velocity_actual") - rpm * RPM) < 40 * RPM)
                axis.coil(name, False)
                self.assert_halted(axis)
            axis.command("disable")


class ReleaseLost(Buttons):
    def test_it_halts_though_its_client_goes_on_reading_and_writing_other_things(self):
        for number in self.each():
            axis = self.ready(number)
            before = time.monotonic()
            self.press(axis, "jog_forward")

            def stands_meanwhile():
                axis.block()
                axis.coils()
                axis.set(heartbeat=int(time.monotonic() * 100) & 0xFFFF)
                return self.speed(number) == 0

            until("it stands", stands_meanwhile)
            self.assertGreaterEqual(time.monotonic() - before, self.jog_timeout_ms / 1000)
            self.assert_halted(axis)
            self.press_in_vain(axis, "jog_forward", 1.2 * self.jog_timeout_ms / 1000)  # the button that hangs: no time makes it a new press
            axis.coil("jog_forward", False)
            self.press(axis, "jog_forward")
            axis.coil("jog_forward", False)
            self.assert_halted(axis)
            axis.command("disable")

    def test_it_halts_when_its_client_is_gone(self):
        for number in self.each():
            axis = self.ready(number)
            self.press(axis, "jog_reverse")
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
            self.press(axis, "jog_forward")
            axis.coil("jog_reverse")
            self.assert_halted(axis)
            self.press_in_vain(axis, "jog_forward", A_MOMENT)
            axis.coil("jog_forward", False)
            self.press_in_vain(axis, "jog_reverse", A_MOMENT)
            axis.coil("jog_reverse", False)
            self.press(axis, "jog_reverse")
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
            self.press(axis, "jog_forward")
            other.coil("quick_stop")
            other.coil("quick_stop", False)
            self.until_it_stands(number)
            self.press_in_vain(axis, "jog_forward", A_MOMENT)
            self.enable(axis)
            self.press_in_vain(axis, "jog_forward", 1.2 * self.jog_timeout_ms / 1000)
            axis.coil("jog_forward", False)
            self.press(axis, "jog_forward")
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
            self.press(axis, "jog_forward")
            with self.refused(BUSY):
                other.coil("jog_reverse")
            other.coil("jog_reverse", False)  # letting go of what was pressed in vain ends nobody's jog
            self.hold(axis, "jog_forward", A_MOMENT)
            axis.coil("jog_forward", False)
            self.assert_halted(axis)
            axis.command("disable")


if __name__ == "__main__":
    main()
