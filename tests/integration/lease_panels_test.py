# SPDX-License-Identifier: Apache-2.0
"""Two panels and a PLC on the same axes: who owns them, who may stop them, how they are handed over and taken."""
from lease_stage import (ANOTHER, ME, NOBODY, NOT_OWNER, PANEL_1, PANEL_2, PLC, RPM, STOPPED_BY_ANOTHER, Machine, main)
from modbus import ABORTED, ACTIVE, ALARM_STOP_LATCHED, BUSY, COMMANDS, CONTINUOUS, REFUSED, STANDSTILL, Axis
from processes import until


class Panels(Machine):
    """Panel 1 is of the lowest rank, the PLC above it, panel 2 above both. The watcher may not write at all."""

    lease = {"timeout_ms": 5000}
    allow = [{"from": PLC, "role": "engineer", "rank": 3}, {"from": PANEL_1, "role": "operator"},
             {"from": PANEL_2, "role": "operator", "rank": 5}, {"from": "127.0.0.9", "role": "viewer"}]

    def setUp(self):
        super().setUp()
        self.begin()
        self.plc, self.panel_1, self.panel_2 = self.peer(PLC), self.peer(PANEL_1), self.peer(PANEL_2)

    def three(self, number):
        """The axis as PLC, panel 1 and panel 2 have it."""
        return [Axis(client, number) for client in (self.plc, self.panel_1, self.panel_2)]

    def assert_owner(self, owner, *others):
        for axis in (owner, *others) if owner else others:
            mine = axis is owner
            self.assertEqual(axis.get("owner"), ME if mine else ANOTHER if owner else NOBODY)
            self.assertEqual("owned_by_me" in axis.inputs(), mine)
            self.assertEqual(axis.get("lease_remaining_ms") > 0, owner is not None)
            self.assertLessEqual(axis.get("lease_remaining_ms"), self.lease["timeout_ms"])

    def plain(self, axis, name):
        """A command as a button gives it: the number alone, without a command_id."""
        axis.client.write(axis.first + 54, COMMANDS[name])

    def assert_not_his(self, axis, write):
        with self.refused(BUSY):
            write()
        self.assertEqual(axis.get("command_result"), NOT_OWNER)


class Owners(Panels):
    def test_each_sees_whose_the_axis_is(self):
        for number in self.each():
            plc, panel_1, panel_2 = self.three(number)
            self.assert_owner(None, plc, panel_1, panel_2)
            plc.set(target_velocity=300 * RPM)
            self.assert_owner(plc, panel_1, panel_2, self.watched(number))
            held = plc.get("target_velocity")
            for panel in (panel_1, panel_2):
                self.assert_not_his(panel, lambda: panel.set(target_velocity=0))
                self.assert_not_his(panel, lambda: panel.coil("enable"))
                self.assert_not_his(panel, lambda: self.plain(panel, "enable"))
                self.assert_not_his(panel, lambda: self.plain(panel, "release"))
            self.assert_owner(plc, panel_1, panel_2)
            self.assertEqual(plc.get("target_velocity"), held)
            plc.command("release")
            self.assert_owner(None, plc, panel_1, panel_2)
            panel_2.set(target_velocity=0)
            self.assert_owner(panel_2, panel_1, plc)
            panel_2.command("release")

    def test_release_and_take_over_are_among_the_commands(self):
        for number in self.each():
            self.assertEqual(self.watched(number).get("supported_commands") >> 13 & 3, 3)


class AnybodyStops(Panels):
    def test_a_panel_stops_what_it_does_not_own(self):
        for number in self.each():
            plc, panel_1, panel_2 = self.three(number)
            motion = self.set_running(plc)
            panel_1.coil("quick_stop")
            self.until_it_stands(number)
            block = plc.until(motion_state=ABORTED, motion_id=motion)
            self.assertTrue(block["axis_alarms"] & ALARM_STOP_LATCHED)
            self.assert_owner(plc, panel_1, panel_2)
            self.until_told(number, "which does not own the axis")
            with self.refused(REFUSED):
                plc.command("run_velocity")
            self.assert_not_his(panel_1, lambda: panel_1.set(target_velocity=0))
            self.assertEqual(self.speed(number), 0)
            self.set_running(plc, 200)
            panel_2.coil("halt")
            self.until_it_stands(number)
            plc.until(motion_state=ABORTED, owner=ME)
            self.assertNotIn("stop_latched", plc.inputs())
            plc.set(target_velocity=300 * RPM)
            plc.command("run_velocity")
            self.until_it_turns_at(number, 300)
            self.plain(panel_1, "disable")
            self.until_it_stands(number)
            until("it is disabled", lambda: "enabled" not in plc.inputs())
            self.assert_owner(plc, panel_1, panel_2)
            plc.command("release")


class CommandOnItsWay(Panels):
    """Drives that take long to answer, so that a stop meets a command which has begun."""

    lines_of = ("serial", "modbus", "kincocan", "leadshine")
    lease = {"timeout_ms": 60000}
    reply_timeout_ms = 5000

    def test_the_owner_is_told_that_another_has_stopped_it(self):
        for number in self.each():
            line, _ = self.motors[number]
            plc, panel_1, panel_2 = self.three(number)
            plc.set(target_velocity=0)
            self.watched(number).until(owner=ANOTHER)
            plc.begin()
            before = self.sim.state(f"{line}/1")
            self.sim.ask(f"reply-delay {line} 300")
            pending = self.later(plc.command, "enable")
            until("the drive was told something", lambda: self.sim.state(f"{line}/1") != before or pending.done())
            self.assertFalse(pending.done())
            panel_1.coil("quick_stop")
            self.assertEqual(self.code_of(pending), BUSY)
            self.sim.ask(f"reply-delay {line} 0")
            self.assertEqual(plc.get("command_result"), STOPPED_BY_ANOTHER)
            self.until_told(number, "stopped by another client")
            until("it is not enabled", lambda: not plc.inputs() & {"enabled"})
            self.assertIn("stop_latched", plc.inputs())
            self.assert_owner(plc, panel_1, panel_2)


class HandOver(Panels):
    def test_a_running_motor_is_handed_over_without_a_stop(self):
        for number in self.each():
            plc, panel_1, panel_2 = self.three(number)
            motion = self.set_running(plc)
            plc.command("release")
            self.assertEqual((plc.get("owner"), panel_1.get("owner")), (NOBODY, NOBODY))
            self.assertGreater(plc.get("lease_remaining_ms"), 0, "it is enabled: somebody has to answer for it")
            panel_1.set(target_velocity=400 * RPM)
            self.assert_owner(panel_1, plc, panel_2)
            self.until_it_turns_at(number, 400)
            block = panel_1.block()
            self.assertEqual((block["motion_state"], block["motion_id"], block["axis_state"]), (ACTIVE, motion, CONTINUOUS))
            self.assert_not_his(plc, lambda: plc.set(target_velocity=300 * RPM))
            panel_1.command("disable")
            self.until_it_stands(number)
            panel_1.command("release")
            self.assert_owner(None, plc, panel_1, panel_2)


class Abandoned(Panels):
    lease = {"timeout_ms": 1000}

    def test_a_motor_that_is_released_and_that_nobody_takes_is_stopped(self):
        for number in self.each():
            plc = Axis(self.plc, number)
            self.set_running(plc)
            plc.command("release")
            self.assertNotEqual(self.speed(number), 0)
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assertTrue(self.leases_told(number, "nobody has taken over the enabled axis"))
        for number in self.each():
            self.assert_it_can_be_had_again(number, PANEL_1)


class Ranks(Panels):
    def test_a_higher_rank_takes_over_after_a_halt_and_a_lower_one_never(self):
        for number in self.each():
            plc, panel_1, panel_2 = self.three(number)
            self.set_running(plc)
            self.assert_not_his(panel_1, lambda: self.plain(panel_1, "take_over"))
            self.assert_owner(plc, panel_1, panel_2)
            self.assertNotEqual(self.speed(number), 0)
            self.plain(panel_2, "take_over")
            self.assert_owner(panel_2, plc, panel_1)
            self.until_it_stands(number)
            panel_2.until(axis_state=STANDSTILL, motion_state=ABORTED)
            self.assertEqual(panel_2.inputs() & {"enabled", "stop_latched"}, {"enabled"}, "a halt is enough")
            self.until_told(number, "has taken the axis over from a lower rank")
            self.assert_not_his(plc, lambda: plc.set(target_velocity=100 * RPM))
            self.assert_not_his(plc, lambda: self.plain(plc, "take_over"))
            panel_2.set(target_velocity=200 * RPM)
            panel_2.command("run_velocity")
            self.until_it_turns_at(number, 200)
            panel_2.command("disable")
            self.until_it_stands(number)
            panel_2.command("release")
            plc.command("take_over")  # of nobody
            self.assert_owner(plc, panel_1, panel_2)
            plc.command("release")


class ProgramsThatCount(Panels):
    """Commands with a command_id. A program begins with command 0, which asks for nothing, and so is nobody's business."""

    def test_a_program_that_does_not_own_the_axis_can_stop_it_and_take_it_over(self):
        for number in self.each():
            plc, panel_1, panel_2 = self.three(number)
            self.set_running(plc)
            panel_1.begin()
            panel_1.command("quick_stop")
            self.until_it_stands(number)
            self.assert_owner(plc, panel_1, panel_2)
            panel_2.begin()
            taken = panel_2.command("take_over")
            self.assert_owner(panel_2, plc, panel_1)
            self.assertEqual(panel_2.get("command_id_seen"), taken)
            panel_2.command("release")


class EqualRanks(Panels):
    lines_of = ("serial", "keyacan")
    allow = [{"from": "127.0.0.0/8", "role": "operator", "rank": 9}]

    def test_nobody_takes_from_his_equal(self):
        for number in self.each():
            plc, panel_1, panel_2 = self.three(number)
            plc.set(target_velocity=0)
            self.assert_not_his(panel_2, lambda: self.plain(panel_2, "take_over"))
            self.assert_owner(plc, panel_1, panel_2)

    def test_but_from_another_connection_of_his_own(self):
        for number in self.each():
            plc = Axis(self.plc, number)
            again = Axis(self.peer(PLC), number)
            self.set_running(plc)
            self.assert_not_his(again, lambda: again.set(target_velocity=0))
            self.plain(again, "take_over")
            self.until_it_stands(number)
            self.assertEqual((again.get("owner"), plc.get("owner")), (ME, ANOTHER))
            again.command("quick_stop")
            again.command("release")


class IdleScanner(Panels):
    """A PLC that scans the same block for ever, and a panel, share an axis."""

    def test_it_claims_nothing_and_undoes_nothing(self):
        for number in self.each():
            plc, panel_1, _ = self.three(number)
            idle = lambda: plc.client.write(plc.first + 54, 0, 0, 7)
            idle()
            self.assertEqual(plc.get("owner"), NOBODY)
            self.set_running(panel_1)
            for _ in range(20):
                idle()
            self.assertEqual((panel_1.get("owner"), plc.get("owner")), (ME, ANOTHER))
            self.assertNotEqual(self.speed(number), 0)
            panel_1.command("disable")
            self.until_it_stands(number)
            panel_1.command("release")


if __name__ == "__main__":
    main()
