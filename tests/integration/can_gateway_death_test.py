# SPDX-License-Identifier: Apache-2.0
"""Heartbeats, both ways: the gateway dies or hangs while motors run, and a drive falls silent."""
import signal

from can_stage import RPM, CanStory, main
from modbus import ALARM_ADOPTED, CONTINUOUS, ERROR_STOP, FAILED, LINK_DOWN, NO_PATH, OFFLINE, ONLINE
from processes import until

HEARTBEAT_LOST = 0x8130
ALARM_NO_COMM_WATCHDOG = 1


class MotorsRun(CanStory):
    def setUp(self):
        super().setUp()
        self.begin()
        for axis in self.axes:
            self.prepare(axis)
            axis.command("enable")
            axis.set(target_velocity=300 * RPM)
            axis.command("run_velocity")
            axis.until(axis_state=CONTINUOUS)
            until("it runs", lambda: axis.get("velocity_actual") > 200 * RPM)

    def position(self, number):
        return int(self.ask("position DRIVE", number))

    def all_stop_by_themselves(self):
        for axis in self.axes:
            until("it notices", lambda: self.ask("state DRIVE", axis.number) == "fault")
        for axis in self.axes:
            positions = []

            def stands():
                positions.append(self.position(axis.number))
                return len(positions) > 5 and len(set(positions[-5:])) == 1

            until("it stands", stands)

    def assert_nothing_starts(self):
        """Whoever comes back finds stopped motors, is told why, and no motor turns until it is asked to anew."""
        where = [self.position(axis.number) for axis in self.axes]
        for axis in self.axes:
            axis.until(link_state=ONLINE, axis_state=ERROR_STOP)
            self.assertNotIn("enabled", axis.inputs())
            self.assertIn("fault", axis.inputs())
        self.axes[0].until(error_code=HEARTBEAT_LOST)
        for axis in self.axes:
            self.reset(axis)
            axis.command("enable")
            until("no speed", lambda: abs(axis.get("velocity_actual")) <= RPM)
        for axis, before in zip(self.axes, where):
            self.assertAlmostEqual(self.position(axis.number), before, delta=100)
            self.targets[axis.number] = axis.get("position_actual")
            self.move(axis)
            axis.command("disable")
            until("its process data again", lambda: self.ask("nmt DRIVE", axis.number) == "operational")

    def test_the_gateway_is_killed(self):
        self.gateway.send(signal.SIGKILL)
        self.assertEqual(self.gateway.ended(), -signal.SIGKILL)
        self.all_stop_by_themselves()
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.look_around()
        self.assert_nothing_starts()

    def test_the_gateway_hangs_for_a_while(self):
        self.gateway.send(signal.SIGSTOP)
        self.addCleanup(self.gateway.send, signal.SIGCONT)
        self.all_stop_by_themselves()
        self.gateway.send(signal.SIGCONT)
        for axis in self.axes:
            axis.until(motion_state=FAILED)
        self.assert_nothing_starts()

    def test_a_gateway_that_finds_motors_running_lets_them_run(self):
        for number, off in ((1, "1016.01"), (2, "1016.01"), (3, "6007.00")):
            self.ask(f"set DRIVE {off} 0", number)  # as somebody's tool might: now the drive watches nobody
        self.gateway.send(signal.SIGKILL)
        self.gateway.ended()
        written = [[self.ask(f"writes DRIVE {name}", number) for name in ("6040.00", "6060.00", "60FF.00")] for number in (1, 2, 3)]
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.look_around()
        for axis in self.axes:
            block = axis.until(link_state=ONLINE)
            self.assertEqual(block["axis_alarms"] & (ALARM_ADOPTED | ALARM_NO_COMM_WATCHDOG), ALARM_ADOPTED | ALARM_NO_COMM_WATCHDOG)
            until("it runs on", lambda: axis.get("velocity_actual") > 200 * RPM)
        self.assertEqual([[self.ask(f"writes DRIVE {name}", number) for name in ("6040.00", "6060.00", "60FF.00")]
                          for number in (1, 2, 3)], written, "nothing was written")
        for axis in self.axes:
            axis.command("quick_stop")
            until("it stands", lambda: abs(axis.get("velocity_actual")) <= RPM)
            axis.command("disable")
            until("it is set up", lambda: not axis.get("axis_alarms") & (ALARM_ADOPTED | ALARM_NO_COMM_WATCHDOG))
            axis.until(link_state=ONLINE)
            self.targets[axis.number] = axis.get("position_actual")
            self.prepare(axis)
            self.move(axis)

    def test_the_gateway_is_ended_in_good_order(self):
        self.assertEqual(self.gateway.terminate(), 0)
        self.all_stop_by_themselves()


class Idle(CanStory):
    def test_an_idle_drive_does_not_miss_a_gateway_that_is_ended(self):
        """And misses the next one as before."""
        self.begin()
        for _ in range(2):
            self.assertEqual(self.gateway.terminate(), 0)
            for axis in self.axes:
                self.gateway.wait_for(f"axis {axis.number}: the gateway ends: no motor has torque: it misses the gateway no more")
            self.run_gateway()
            self.client = self.connect()
            self.until_online()
            self.look_around()
            for axis in self.axes:
                until("it is watched", lambda: not axis.get("axis_alarms") & ALARM_NO_COMM_WATCHDOG)
                self.assertNotIn("fault", axis.inputs())


class DriveAnswersNothing(CanStory):
    """Though it lives: its heartbeat goes on."""

    timings = {"timeout_ms": 300}

    def test_it_is_offline_and_comes_back(self):
        self.begin()
        for axis in self.axes:
            self.prepare(axis)
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                others = [other for other in self.axes if other is not axis]
                self.ask("unresponsive DRIVE on", axis.number)
                with self.refused(0x0B, NO_PATH):
                    while True:
                        axis.set(profile_velocity=600 * RPM + axis.get("sequence"))
                axis.until(link_state=OFFLINE)
                with self.refused(NO_PATH):
                    axis.command("enable")
                self.assert_goes_on(*others)
                self.ask("clear DRIVE", axis.number)
                axis.until(link_state=ONLINE)
                self.assertNotIn("enabled", axis.inputs())
                if "fault" in axis.inputs():
                    self.reset(axis)
                self.move(axis)
                for each in self.axes:
                    each.command("disable")


class EverythingFallsSilent(CanStory):
    def test_no_drive_answers_for_a_while(self):
        self.begin()
        for axis in self.axes:
            self.prepare(axis)
            axis.command("enable")
        self.let_heartbeats_pass()  # a gateway that was never heard is not missed
        self.sim.send(signal.SIGSTOP)
        self.addCleanup(self.sim.send, signal.SIGCONT)
        for axis in self.axes:
            self.gateway.wait_for(f"axis {axis.number}: no sign of life from the node")
            until("it is gone", lambda: axis.get("link_state") in (OFFLINE, LINK_DOWN))
            self.assertEqual(axis.get("valid"), 0)
            with self.refused(NO_PATH):
                axis.command("enable")
        self.assertEqual(self.client.gateway()["axes_online"], 0)
        self.sim.send(signal.SIGCONT)
        for axis in self.axes:
            axis.until(link_state=ONLINE)
            until("it has missed the gateway", lambda: "fault" in axis.inputs())
            self.reset(axis)
            self.targets[axis.number] = axis.get("position_actual")
            self.move(axis)


if __name__ == "__main__":
    main()
