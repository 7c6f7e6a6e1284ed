# SPDX-License-Identifier: Apache-2.0
"""A gateway is started while both motors of a Keya are enabled and run: it reads, lets them run, and its open lease is all that a start
can lead to."""
from keya_stage import ALARM_NO_COMM_WATCHDOG, CANOPEN, KEYA_CAN, RPM, RS232, RS485, SPEED, KeyaStory, main, on
from modbus import ALARM_ADOPTED, ALARM_STOP_LATCHED, DISABLED, ONLINE
from processes import until

NOBODY, ME = 0, 1
ATTEMPTS = 5
COMMUNICATION = 0x8130


class FoundRunningOnRs485(KeyaStory):
    """Where it has no watchdog, the drive runs on until somebody stops it."""

    def setUp(self):
        super().setUp()
        self.begin(RS485, lease={"timeout_ms": 1500})
        self.run_both()
        self.kill_the_gateway()
        self.assert_runs_on()
        self.before = self.commands()
        self.start_another_gateway()
        for axis in self.seen:
            block = axis.until(link_state=ONLINE)
            self.assertEqual(block["axis_alarms"] & (ALARM_ADOPTED | ALARM_NO_COMM_WATCHDOG), ALARM_ADOPTED | ALARM_NO_COMM_WATCHDOG)

    def test_nobody_comes_and_the_open_lease_stops_them(self):
        for axis in self.seen:
            self.gateway.wait_for(f"axis {axis.number}: found enabled, and nobody owns it: quick stop")
        self.until_it_stands()
        for axis in self.seen:
            until("latched", lambda: axis.get("axis_alarms") & ALARM_STOP_LATCHED)
            until("no longer adopted", lambda: not axis.get("axis_alarms") & ALARM_ADOPTED)
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()

    def test_a_client_that_writes_takes_them_over(self):
        for axis in self.axes:
            axis.set(heartbeat=1)
            self.assertEqual(axis.get("owner"), ME)
        self.let_pass(2, self.client.gateway)
        self.assertEqual((self.enabled(), self.speeds()), ([True, True], [SPEED, SPEED]))
        self.assertEqual(self.commands(), self.before, "nothing was sent")
        left, right = self.axes
        right.command("quick_stop")
        until("right stands without torque", lambda: self.speeds()[1] == 0 and self.enabled()[1] is False)
        self.assertIn(self.speeds()[0], range(SPEED + 1), "what ran before this gateway was started is never made faster")
        left.command("quick_stop")
        self.until_it_stands()
        self.assert_fresh_enable_works()

    def test_a_client_that_runs_one_of_them_is_refused_because_nobody_knows_what_the_other_was_told(self):
        left, right = self.axes
        for axis in self.axes:
            axis.set(heartbeat=1)
        # It runs, so a new speed would act at once: one frame tells both motors theirs.
        with self.assertRaisesRegex(Exception, "0x04"):
            left.set(target_velocity=2 * SPEED * RPM)
        with self.assertRaisesRegex(Exception, "0x04"):
            left.command("run_velocity")
        self.assertEqual((self.enabled(), self.speeds()), ([True, True], [SPEED, SPEED]))
        for axis in (right, left):
            axis.command("quick_stop")
        self.until_it_stands()
        self.assert_fresh_enable_works()


class OneOfTwoFoundRunningOnRs485(KeyaStory):
    """Motor A runs, motor B is disabled: what is sent for one never switches the other."""

    def setUp(self):
        super().setUp()
        self.begin(RS485, lease={"timeout_ms": 1500})
        self.enable(self.axes[0])
        self.run_axis(self.axes[0])
        self.kill_the_gateway()
        self.start_another_gateway()
        self.assertTrue(self.seen[0].get("axis_alarms") & ALARM_ADOPTED)
        self.assertEqual((self.enabled(), self.speeds()), ([True, False], [SPEED, 0]))

    def test_nobody_comes_and_the_open_lease_stops_it(self):
        self.gateway.wait_for("axis 1: found enabled, and nobody owns it: quick stop")
        self.until_it_stands()
        self.seen[0].until_input("stop_latched")
        self.assertNotIn("stop_latched", self.seen[1].inputs())
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()

    def test_a_client_takes_it_over_and_runs_the_other(self):
        left, right = self.axes
        left.set(heartbeat=1)
        self.assertEqual(left.get("owner"), ME)
        self.let_pass(2, self.client.gateway)
        self.assertEqual((self.enabled(), self.speeds()), ([True, False], [SPEED, 0]))
        left.command("quick_stop")
        self.until_it_stands()
        self.assert_fresh_enable_works()


class FoundRunning(KeyaStory):
    """Where the drive watches its master, a start in time finds it enabled, and is no command: the watchdog goes on counting."""

    @on(RS232, KEYA_CAN, CANOPEN)
    def test_it_lets_them_run_and_the_watchdog_goes_on(self, interface):
        self.begin(interface)
        for _ in range(ATTEMPTS):
            trips = self.trips()
            self.run_both()
            self.kill_the_gateway()
            self.start_another_gateway()
            self.gateway.wait_for("axis 1.*: online")  # what it has found is told there
            if self.gateway.found("axis 1: online, found enabled: adopted"):
                break  # the machine was fast enough
        else:
            self.fail("no gateway was up within a second")
        until("the drive's watchdog", lambda: self.trips() > trips)
        self.until_it_stands()
        for axis in self.seen:
            axis.until(link_state=ONLINE, axis_state=DISABLED, error_code=COMMUNICATION)
            until("no longer adopted", lambda: not axis.get("axis_alarms") & ALARM_ADOPTED)
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()


if __name__ == "__main__":
    main()
