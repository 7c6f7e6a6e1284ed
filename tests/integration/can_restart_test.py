# SPDX-License-Identifier: Apache-2.0
"""A drive on CAN restarts, or is unplugged from the bus and plugged in: its clients are told, nothing is enabled, it comes back."""
import time

from can_stage import FAR, RPM, CanStory, main
from modbus import (DISABLED, ERROR_STOP, FAILED, NO_ANSWER, NO_PATH, OFFLINE, ONLINE, REFUSED, STANDSTILL)
from processes import until


class Restarts(CanStory):
    def setUp(self):
        super().setUp()
        self.begin()
        for axis in self.axes:
            self.prepare(axis)

    def restart_while_it_moves(self, axis):
        others = [other for other in self.axes if other is not axis]
        for each in self.axes:
            each.command("enable")
        axis.set(target_position=FAR)
        number = axis.command("move_absolute")
        axis.until_input("moving")
        words = self.ask("writes DRIVE 6040.00", axis.number)
        self.ask("restart DRIVE", axis.number)
        self.gateway.wait_for(f"axis {axis.number}: the drive has restarted")
        axis.until(link_state=ONLINE)
        block = axis.until(motion_state=FAILED, axis_state=DISABLED)
        self.assertEqual(block["motion_id"], number)
        self.assertIn(self.ask("state DRIVE", axis.number), ("switch_on_disabled", "ready_to_switch_on"))
        self.assertLessEqual(int(self.ask("writes DRIVE 6040.00", axis.number)), int(words) + 1, "no control word but the first 6")
        with self.refused(REFUSED):
            axis.command("move_absolute")
        for other in others:
            self.assertIn("enabled", other.inputs(), "another drive's restart is no reason to stop")
            self.move(other)
        self.prepare(axis)
        self.targets[axis.number] = axis.get("position_actual")
        self.move(axis)
        until("process data again", lambda: self.ask("nmt DRIVE", axis.number) == "operational")
        self.assertEqual(self.ask("restarts DRIVE", axis.number), "1")

    def test_a_leadshine_restarts_while_it_moves(self):
        self.restart_while_it_moves(self.axes[0])

    def test_a_jd_restarts_while_it_moves(self):
        self.restart_while_it_moves(self.axes[1])

    def test_an_md_restarts_while_it_moves(self):
        self.restart_while_it_moves(self.axes[2])


class Unplugged(CanStory):
    def setUp(self):
        super().setUp()
        self.begin()
        for axis in self.axes:
            self.prepare(axis)

    def pull(self, axis):
        self.ask("connect DRIVE off", axis.number)
        axis.until(link_state=OFFLINE)
        block = axis.block()
        self.assertEqual((block["statusword"], block["valid"]), (0, 0))
        self.assertNotEqual(block["error_code"], 0)
        self.assertEqual(axis.inputs() - {"warning"}, set())
        for name in ("enable", "move_absolute", "disable"):
            with self.refused(NO_PATH):
                axis.command(name)
        with self.refused(NO_PATH):
            axis.set(target_velocity=1)
        gateway = self.client.gateway()
        self.assertEqual((gateway["axes_online"], gateway["alarms"] & 0b11), (2, 0b01))
        self.assert_goes_on(*(other for other in self.axes if other is not axis))

    def put_back(self, axis):
        self.ask("connect DRIVE on", axis.number)
        axis.until(link_state=ONLINE)
        self.assertNotIn("enabled", axis.inputs())

    def assert_works_after_a_reset(self, axis):
        self.reset(axis)
        self.targets[axis.number] = axis.get("position_actual")
        self.move(axis)

    def test_at_rest(self):
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                self.pull(axis)
                self.put_back(axis)
                axis.until(axis_state=ERROR_STOP)  # it has missed the gateway, and says so
                self.assert_works_after_a_reset(axis)

    def test_in_motion_it_stops_by_itself_and_stays_stopped(self):
        for axis in self.axes:
            axis.command("enable")
            axis.set(target_position=FAR, profile_velocity=60 * RPM)
            axis.command("move_absolute")
            axis.until_input("moving")
            self.ask("connect DRIVE off", axis.number)
        for axis in self.axes:
            axis.until(link_state=OFFLINE, motion_state=FAILED)
            until("it notices", lambda: self.ask("state DRIVE", axis.number) == "fault")
        for axis in self.axes:
            self.put_back(axis)
            axis.until(axis_state=ERROR_STOP)
            self.prepare(axis)
            self.assert_works_after_a_reset(axis)


class InTheMiddleOfARequest(CanStory):
    """An MD alone sends its values by timer, so that with rare polls nothing but the story's requests is on the wire."""

    drives_on = {"cell": "md@1"}
    timings = {"timeout_ms": 10000, "poll": {"fast": 60000, "normal": 60000, "slow": 600000}}

    def setUp(self):
        super().setUp()
        self.begin()
        self.md = self.axes[0]
        # What is read once, and by a client's first look, has been read when the bus has become quiet.
        until("a quiet bus", self.is_quiet)

    def is_quiet(self):
        before = self.ask("writes DRIVE 6083.00", 1), self.client.bus(0)["requests"]
        mark = time.monotonic()
        until("a second", lambda: self.client.gateway() and time.monotonic() > mark + 1)
        return before == (self.ask("writes DRIVE 6083.00", 1), self.client.bus(0)["requests"])

    def restart_on_the_next_request(self, when, words):
        self.ask(f"restart DRIVE {when} next", 1)
        self.assertEqual(self.code_of(self.later(words)), NO_ANSWER)
        self.assertEqual(self.client.bus(0)["timeouts"], 0, "its start has ended the request, before its time was over")
        self.gateway.wait_for("axis 1: the drive has restarted")
        self.md.until(link_state=ONLINE, axis_state=DISABLED)

    def test_a_write_that_was_carried_out_is_not_written_again(self):
        before = int(self.ask("writes DRIVE 6083.00", 1))
        self.restart_on_the_next_request("after", lambda: self.md.set(profile_acceleration=12345))
        self.assertEqual(int(self.ask("writes DRIVE 6083.00", 1)), before + 1)

    def test_a_write_that_was_lost_is_not_written_again(self):
        before = int(self.ask("writes DRIVE 6083.00", 1))
        self.restart_on_the_next_request("before", lambda: self.md.set(profile_acceleration=12345))
        self.assertEqual(int(self.ask("writes DRIVE 6083.00", 1)), before)

    def test_an_enable_is_not_taken_up_again(self):
        self.restart_on_the_next_request("after", lambda: self.md.command("enable"))
        self.assertIn(self.ask("state DRIVE", 1), ("switch_on_disabled", "ready_to_switch_on"))
        self.assertNotIn("enabled", self.md.inputs())
        self.md.command("enable")
        self.md.until(axis_state=STANDSTILL)


if __name__ == "__main__":
    main()
