# SPDX-License-Identifier: Apache-2.0
"""Somebody pulls the serial cable of axis 1 and puts it back, in every state; axis 2 hangs on another line."""
import os
import signal

from modbus import (ALARM_ADOPTED, COMPLETED, CONTINUOUS, DISABLED, ERROR_STOP, FAILED, LINK_DOWN, NO_ANSWER, NO_PATH, ONLINE,
                    REFUSED, SETUP, STANDSTILL, SUSPECT)
from processes import Program, until
from stage import Story, bus, drive, main

TURN = 10000
FAR = 20000 * TURN
RPM = 1000
NEVER_SENT, OUTCOME_UNKNOWN = 6, 4


class Cable(Story):
    def begin(self, **options):
        self.start(**options)
        self.lift, self.feeder = self.axis(1), self.axis(2)

    def pull(self):
        self.sim.ask("unplug lift")
        self.lift.until(link_state=LINK_DOWN)

    def put_back(self):
        self.sim.ask("plug lift")
        self.lift.until(link_state=ONLINE)

    def assert_gone(self, axis):
        """Reads go on and say what is known; writes are refused as never sent."""
        block = axis.block()
        self.assertEqual((block["link_state"], block["valid"], block["statusword"]), (LINK_DOWN, 0, 0))
        self.assertEqual(block["error_code"], 0x8130)
        self.assertEqual(axis.inputs() - {"warning", "stop_latched"}, set())
        self.assertEqual(self.client.overview(axis.number)["link_state"], LINK_DOWN)
        for name in ("enable", "fault_reset", "move_absolute"):
            with self.refused(NO_PATH):
                axis.command(name)
            self.assertEqual(axis.get("command_result"), NEVER_SENT)
        with self.refused(NO_PATH):
            axis.set(target_velocity=1)
        gateway = self.client.gateway()
        self.assertEqual((gateway["gateway_state"], gateway["axes_online"], gateway["alarms"] & 0b11), (2, 1, 0b11))
        self.assertEqual((self.client.bus(0)["link"], self.client.bus(1)["link"]), (0, 1))

    def assert_unaffected(self, axis):
        self.assert_online(axis)
        sequence = axis.get("sequence")
        axis.set(profile_velocity=600 * RPM, target_position=axis.get("target_position") + TURN)
        axis.command("enable")
        axis.command("move_absolute")
        block = axis.until(motion_state=COMPLETED)
        self.assertNotEqual(block["sequence"], sequence)
        self.assertEqual(self.client.bus(1)["timeouts"], 0)

    def assert_back(self, axis):
        """All is as the drive has it, and nothing was started."""
        self.assert_online(axis)
        self.assertEqual(self.client.bus(0)["link"], 1)
        self.assertEqual(self.client.bus(0)["reconnects"], 1)
        self.assertNotEqual(axis.get("valid"), 0)
        self.assertIn("online", axis.inputs())
        self.assertEqual(axis.get("error_code"), 0)


class PulledWhile(Cable):
    def setUp(self):
        super().setUp()
        self.begin()

    def enable(self):
        self.lift.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)
        self.lift.command("enable")

    def pull_and_put_back(self):
        transitions, writes = self.sim.ask("transitions lift/1"), self.sim.writes("lift/1")
        self.pull()
        self.assert_gone(self.lift)
        self.assert_unaffected(self.feeder)
        self.put_back()
        self.assert_back(self.lift)
        self.assertEqual(self.sim.ask("transitions lift/1"), transitions, "its state was changed by nobody")
        self.assertEqual(self.sim.writes("lift/1"), writes, "nothing was written")

    def test_idle(self):
        self.pull_and_put_back()
        self.assertEqual(self.lift.get("axis_state"), DISABLED)
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)

    def test_enabled(self):
        self.enable()
        self.pull_and_put_back()
        self.assert_adopted_until_disabled()

    def test_moving(self):
        self.enable()
        self.lift.set(target_position=FAR)
        number = self.lift.command("move_absolute")
        self.lift.until_input("moving")
        self.pull_and_put_back()
        block = self.lift.until(motion_state=FAILED)
        self.assertEqual(block["motion_id"], number, "a lost link ends every motion for good")
        self.assert_adopted_until_disabled()

    def test_velocity_running(self):
        self.enable()
        self.lift.set(target_velocity=100 * RPM)
        self.lift.command("run_velocity")
        self.lift.until(axis_state=CONTINUOUS)
        self.pull_and_put_back()
        self.lift.until(motion_state=FAILED)
        self.lift.command("quick_stop")  # works on an adopted axis as on any
        until("standstill", lambda: self.lift.get("velocity_actual") == 0)
        self.lift.command("disable")
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)
        self.assertEqual(self.sim.object("lift/1", "60FF.00"), 0, "velocity is needed anew")

    def assert_adopted_until_disabled(self):
        self.lift.until_input("enabled")  # it still is: this drive does not watch its line
        self.assertTrue(self.lift.get("axis_alarms") & ALARM_ADOPTED)
        self.lift.command("disable")
        until("no longer adopted", lambda: not self.lift.get("axis_alarms") & ALARM_ADOPTED)
        self.lift.until(axis_state=DISABLED)
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)

    def test_a_quick_stop_that_cannot_be_sent_latches_and_is_owed(self):
        self.enable()
        self.lift.set(target_velocity=100 * RPM)
        self.lift.command("run_velocity")
        self.lift.until(axis_state=CONTINUOUS)
        self.pull()
        with self.refused(NO_PATH):
            self.lift.command("quick_stop")
        self.assertIn("stop_latched", self.lift.inputs())
        self.put_back()
        self.lift.until_input("enabled", False)
        until("standstill", lambda: self.lift.get("velocity_actual") == 0)
        self.assertIn("stop_latched", self.lift.inputs())
        with self.refused(REFUSED):
            self.lift.command("move_absolute")
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)

    def test_faulted(self):
        self.enable()
        self.sim.ask("fault lift/1 2601 0x0020")
        self.lift.until(axis_state=ERROR_STOP, error_code=0x3210)
        self.pull()
        self.assertEqual(self.lift.get("error_code"), 0x3210, "the drive's last word stays")
        self.sim.ask("clear lift/1 2601 0x0020")
        self.put_back()
        self.lift.until(axis_state=ERROR_STOP, error_code=0x3210)
        self.lift.command("fault_reset")
        self.lift.until(axis_state=DISABLED, error_code=0)

    def test_pulled_again_and_again(self):
        for count in range(1, 4):
            self.pull()
            self.put_back()
            self.assertEqual(self.client.bus(0)["reconnects"], count)
        self.lift.command("enable")
        self.lift.set(profile_velocity=600 * RPM, target_position=TURN)
        self.lift.command("move_absolute")
        self.lift.until(motion_state=COMPLETED)


class PulledWhileOnAnMd(PulledWhile):
    """The same stories with the types changed about."""

    lines = {"lift": "md@1", "feeder": "jd@1"}

    def buses(self):
        return [bus(self.path("lift"), drive("md", 1, 1)), bus(self.path("feeder"), drive("jd", 1, 2))]

    def test_halted(self):
        self.enable()
        self.lift.set(target_position=FAR)
        self.lift.command("move_absolute")
        self.lift.until_input("moving")
        self.lift.command("halt")
        self.lift.until_input("moving", False)
        self.pull_and_put_back()
        where = self.sim.object("lift/1", "6063.00")
        self.assert_adopted_until_disabled()
        self.assertAlmostEqual(self.sim.object("lift/1", "6063.00"), where, delta=100)


class PulledOnAQuietLine(Cable):
    """Polls are rare and deadlines long, so that the wire holds what the story put there."""

    def setUp(self):
        super().setUp()
        quiet = {"timeout_ms": 10000, "poll": {"fast": 60000, "normal": 60000, "slow": 600000}}
        buses = [bus(self.path("lift"), drive("jd", 1, 1), **quiet), bus(self.path("feeder"), drive("md", 1, 2))]
        self.begin(listeners=[self.listener(start_deadline_ms=60000, reply_deadline_ms=60000)], buses=buses)
        self.first, self.second = self.connect().axis(1), self.connect().axis(1)

    def test_in_the_middle_of_a_write(self):
        self.sim.ask("late lift/1 5000 next 1")
        write = self.later(lambda: self.first.set(profile_acceleration=12345))
        until("the write at the drive", lambda: self.sim.writes("lift/1", "6083.00") == 1)
        self.pull()
        self.assertEqual(self.code_of(write), NO_ANSWER)
        self.assertEqual(self.first.get("command_result"), OUTCOME_UNKNOWN)
        self.put_back()
        self.assertEqual(self.sim.writes("lift/1", "6083.00"), 1, "it is not written twice")
        self.assertAlmostEqual(self.lift.get("profile_acceleration"), 12345, delta=5)

    def test_while_a_command_waits_behind_a_write(self):
        self.sim.ask("late lift/1 5000 next 1")
        write = self.later(lambda: self.first.set(profile_acceleration=12345))
        until("the write at the drive", lambda: self.sim.writes("lift/1", "6083.00") == 1)
        command = self.later(lambda: self.second.command("enable"))
        until("the command waits", lambda: self.client.bus(0)["queue_depth"] >= 1)
        self.pull()
        self.assertEqual((self.code_of(write), self.code_of(command)), (NO_ANSWER, NO_PATH))
        self.assertEqual(self.second.get("command_result"), NEVER_SENT)
        self.put_back()
        self.assertEqual(self.lift.get("axis_state"), DISABLED)
        self.assertEqual(self.sim.writes("lift/1", "6040.00"), 0, "what waited was never sent")

    def test_in_the_middle_of_an_enable(self):
        self.sim.ask("late lift/1 5000 next 1")
        enable = self.later(lambda: self.first.command("enable"))
        until("it is on the wire", lambda: self.client.bus(0)["requests"] > self.client.bus(0)["replies"])
        self.pull()
        self.assertEqual(self.code_of(enable), NO_ANSWER)
        self.put_back()
        self.assertNotIn("enabled", self.lift.inputs())
        self.assertNotIn("operation", self.sim.state("lift/1"))


class PulledAtStart(Cable):
    def test_during_setup(self):
        self.simulate()
        self.sim.ask("reply-delay lift 50")
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        self.lift = self.axis(1)
        self.lift.until(link_state=SETUP)
        with self.refused(0x06):
            self.lift.command("enable")
        self.pull()
        with self.refused(NO_PATH):
            self.lift.command("enable")
        self.sim.ask("reply-delay lift 0")
        self.put_back()
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)

    def test_a_device_that_is_not_there_is_picked_up_when_it_appears(self):
        self.simulate()
        self.sim.ask("unplug lift")
        self.configure()
        self.run_gateway()
        self.gateway.wait_for(r"warning bus lift: .*lift.*trying again")
        self.client = self.connect()
        self.lift, self.feeder = self.axis(1), self.axis(2)
        self.feeder.until(link_state=ONLINE)
        self.assert_gone(self.lift)
        self.assert_unaffected(self.feeder)
        self.put_back()
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)
        self.assertEqual(len(self.gateway.found("trying again")), 1, "said once, not each second")

    def test_drives_that_are_switched_on_after_the_gateway(self):
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        self.assertEqual(self.client.gateway()["axes_online"], 0)
        self.assertEqual(self.axis(1).get("link_state"), LINK_DOWN)
        self.simulate()
        self.until_online()


class SocatCable(Cable):
    """The line is a cable between two ptys that socat made; ending socat is pulling it."""

    lines = {"far-end": "jd@1", "feeder": "md@1"}

    def setUp(self):
        super().setUp()
        self.simulate()
        self.cable = self.lay_cable()
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.lift = self.axis(1)

    def lay_cable(self):
        near, far = self.path("lift"), self.path("far-end")
        cable = self.keep(Program("socat", ["socat", f"PTY,link={near},rawer", f"{far},rawer"]))
        until("socat's pty", lambda: os.path.islink(near) and os.path.exists(near))
        return cable

    def through_the_cable(self, end_of_socat):
        self.lift.command("enable")
        self.lift.set(profile_velocity=600 * RPM, target_position=TURN)
        self.lift.command("move_absolute")
        self.lift.until(motion_state=COMPLETED)
        self.lift.command("disable")
        end_of_socat()
        self.lift.until(link_state=LINK_DOWN)
        self.assert_gone(self.lift)
        self.lay_cable()
        self.lift.until(link_state=ONLINE)
        self.assert_back(self.lift)
        self.lift.command("enable")
        self.lift.until(axis_state=STANDSTILL)

    def test_a_cable_that_takes_its_name_along(self):
        self.through_the_cable(self.cable.terminate)

    def test_a_cable_whose_name_points_nowhere(self):
        def kill():
            self.cable.process.kill()
            self.cable.ended()

        self.through_the_cable(kill)

    def test_bytes_are_lost_but_the_line_stays(self):
        # Stopped, socat passes nothing on: the drive is unresponsive, the port is still there.
        self.cable.send(signal.SIGSTOP)
        until("no answer is noticed", lambda: self.lift.get("link_state") not in (ONLINE, SUSPECT))
        self.assertNotEqual(self.lift.get("link_state"), LINK_DOWN)
        with self.refused(NO_PATH):
            self.lift.command("enable")
        self.cable.send(signal.SIGCONT)
        self.lift.until(link_state=ONLINE)
        self.assertNotIn("enabled", self.lift.inputs())


if __name__ == "__main__":
    main()
