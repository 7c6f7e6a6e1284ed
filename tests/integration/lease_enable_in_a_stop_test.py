# SPDX-License-Identifier: Apache-2.0
"""A master that is back at once: its enable meets a stop that is still under way. What it is told is what it gets."""
from lease_stage import PANEL_1, Machine, main
from modbus import BUSY, REFUSED, STANDSTILL, Axis, Refused
from processes import NEVER, until


class EnableInAStop(Machine):
    """Most drives stop by themselves once they were told to. A Keya's stop has many steps: speed 0, and the torque goes when the motor
    stands; the gateway does both."""

    lease = {"timeout_ms": 1000}

    def setUp(self):
        super().setUp()
        self.begin()

    def enables(self, axis):
        try:
            axis.command("enable")
            return True
        except Refused as refused:
            self.assertIn(refused.code, (BUSY, REFUSED))
            return False

    def assert_as_told(self, axis, enabled):
        """An enable that was done leaves an enabled axis, one that was refused a latched one."""
        self.until_it_stands(axis.number)
        self.assertEqual(axis.get("command_result") == 2, enabled)
        if enabled:
            axis.until(axis_state=STANDSTILL)
            self.assertNotIn("stop_latched", axis.inputs())
        else:
            self.assertIn("stop_latched", axis.inputs())
            self.enable(axis)
        self.assertEqual(self.speed(axis.number), 0)

    def test_the_lease_has_run_out_a_moment_ago(self):
        for number in self.each():
            gone = self.peer()
            self.set_running(Axis(gone, number))
            gone.reset()
            axis = Axis(self.peer(), number)
            axis.begin()
            self.watched(number).until_input("stop_latched")
            self.assert_as_told(axis, self.enables(axis))
            axis.command("quick_stop")

    def test_a_panel_has_stopped_it_a_moment_ago(self):
        for number in self.each():
            axis, panel = Axis(self.peer(), number), Axis(self.peer(PANEL_1), number)
            self.set_running(axis)
            stop = self.later(panel.coil, "quick_stop")
            until("the stop is told", lambda: "stop_latched" in axis.inputs() or stop.done())
            enabled = self.enables(axis)
            stop.result(timeout=NEVER)
            self.assert_as_told(axis, enabled)
            axis.command("quick_stop")


if __name__ == "__main__":
    main()
