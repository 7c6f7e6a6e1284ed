# SPDX-License-Identifier: Apache-2.0
"""What is done when a lease has run out is the configuration's choice: halt, disable, nothing."""
from lease_stage import MACHINES, NOBODY, Machine, main
from modbus import ACTIVE, DISABLED, REFUSED, Axis
from processes import until


class OnExpiry(Machine):
    def setUp(self):
        super().setUp()
        self.begin()
        owner = self.peer()
        for number in self.numbers:
            self.set_running(Axis(owner, number))
        owner.reset()


class Halt(OnExpiry):
    lease = {"timeout_ms": 1000, "on_expiry": "halt"}

    def test_it_stands_under_torque_and_is_latched(self):
        for number in self.each():
            self.until_it_stands(number)
            axis = self.watched(number)
            axis.until(owner=NOBODY)
            axis.until_input("stop_latched")
            self.assertIn("enabled", axis.inputs())
        for number in self.each():
            late = self.peer()
            with self.refused(REFUSED):
                Axis(late, number).command("run_velocity")
            late.close()
        for number in self.each():
            self.assert_it_can_be_had_again(number)


class Disable(OnExpiry):
    lease = {"timeout_ms": 1000, "on_expiry": "disable"}

    def test_it_ends_disabled_and_latched(self):
        for number in self.each():
            self.until_it_stands(number)
            axis = self.watched(number)
            until("it is disabled", lambda: "enabled" not in axis.inputs())
            axis.until(owner=NOBODY)
            self.assertIn("stop_latched", axis.inputs())
        for number in self.each():
            self.assert_it_can_be_had_again(number)


class Nothing(OnExpiry):
    lease = {"timeout_ms": 1000, "on_expiry": "none"}
    lines_of = tuple(line for line in MACHINES if not line.startswith("keya"))

    def test_it_runs_on_and_is_free(self):
        for number in self.each():
            axis = self.watched(number)
            axis.until(owner=NOBODY, lease_remaining_ms=0)
            self.until_told(number, "nothing is done")
            self.assertNotEqual(self.speed(number), 0)
            self.assertEqual(axis.get("motion_state"), ACTIVE)
            self.assertNotIn("stop_latched", axis.inputs())
        for number in self.each():
            axis = Axis(self.peer(), number)
            axis.command("disable")
            self.until_it_stands(number)
            axis.until(axis_state=DISABLED)


class NothingOnAKeya(OnExpiry):
    lease = {"timeout_ms": 1000, "on_expiry": "none"}
    lines_of = ("keya232", "keyacan")

    def test_nobody_feeds_its_watchdog_which_stops_it(self):
        for line in self.lines_of:
            until("its watchdog has acted", lambda: self.sim.ask(f"trips {line}/1") != "0")
        for number in self.each():
            self.until_it_stands(number)
            self.until_without_torque(number)
            until("it reads so", lambda: "enabled" not in self.watched(number).inputs())


if __name__ == "__main__":
    main()
