# SPDX-License-Identifier: Apache-2.0
"""The line at the speed it has in a machine: 38400 baud, a drive that takes 3 ms to answer, three drives in a chain."""
from modbus import COMPLETED, DISABLED, ONLINE
from processes import until
from stage import Story, bus, drive, main

TURN = 10000
RPM = 1000


class RealSpeed(Story):
    lines = {"chain": "jd@1,md@2,jd@3"}
    sim_options = ("--baud-timing", "38400", "--reply-delay-ms", "3")

    def setUp(self):
        super().setUp()
        self.simulate()
        self.configure(buses=[bus(self.path("chain"), drive("jd", 1, 1), drive("md", 2, 2), drive("jd", 3, 3), cascade=True)])
        self.run_gateway()
        self.client = self.connect()
        self.axes = [self.axis(number) for number in (1, 2, 3)]

    def test_what_is_online_has_valid_values(self):
        for axis in self.axes:
            block = axis.until(link_state=ONLINE)
            self.assertEqual(block["supported"] & ~block["valid"], 0, block)

    def test_what_check_plans_is_what_the_bus_does(self):
        planned = self.command_line("check", self.config)
        self.assertEqual(planned.returncode, 0, planned.stdout)
        self.until_online()
        self.assertEqual(self.client.bus(0)["link"], 1)

    def test_three_axes_move_at_once(self):
        self.until_online()
        for axis in self.axes:
            axis.set(profile_velocity=600 * RPM, target_position=axis.number * TURN)
            axis.command("enable")
        moves = {axis: axis.command("move_absolute") for axis in self.axes}
        for axis, number in moves.items():
            axis.until(motion_state=COMPLETED, motion_id=number)
            until("it is there", lambda axis=axis: abs(axis.get("position_actual") - axis.number * TURN) <= 20)
            axis.command("disable")
            axis.until(axis_state=DISABLED)
        bus_now = self.client.bus(0)
        self.assertEqual((bus_now["bad_frames"], bus_now["late_replies"]), (0, 0))


if __name__ == "__main__":
    main()
