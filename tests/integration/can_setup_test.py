# SPDX-License-Identifier: Apache-2.0
"""Drives that are not as expected: another device under the number, one that will not map its values, one that nobody answers for."""
from can_stage import RPM, CanStory, main
from modbus import ABORTED, ALARM_LOCAL_CONTROL, BUSY, DISABLED, ONLINE, REFUSED
from processes import until

IDENTITY_MISMATCH = 1 << 2
LEADSHINE, KINCO = 0x4321, 0x300


class AnotherDevice(CanStory):
    def buses(self):
        buses = super().buses()
        buses[0]["drives"][0]["identity"] = {"vendor": LEADSHINE, "product": 7}
        buses[0]["drives"][1]["identity"] = {"vendor": KINCO, "product": 1, "revision": 1, "serial": 1}
        return buses

    def test_it_is_shown_and_not_commanded(self):
        self.simulate()
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.look_around()
        wrong, right = self.axes[0], self.axes[1:]
        until("the alarm", lambda: wrong.get("axis_alarms") & IDENTITY_MISMATCH)
        self.assertEqual(self.client.gateway()["alarms"] >> 3 & 1, 1)
        self.gateway.wait_for("axis 1: not the configured drive: product is 0x1, configured 0x7")
        block = wrong.until(axis_state=DISABLED)
        self.assertTrue(block["valid"] >> 2 & 1, "its position is shown")
        self.assertNotIn("ready", wrong.inputs())
        self.assertEqual(self.ask("nmt DRIVE", 1), "pre_operational", "it is not started")
        self.assertEqual([self.ask(f"get DRIVE {name}", 1).split()[0] for name in ("1016.01", "1017.00")], ["0", "0"], "nor set up")
        before = [self.ask(f"writes DRIVE {name}", 1) for name in ("6040.00", "6060.00", "607A.00", "6083.00")]
        for refused in (lambda: wrong.command("enable"), lambda: wrong.set(profile_acceleration=12345), lambda: wrong.set(mode=3),
                        lambda: wrong.command("move_absolute")):
            with self.refused(BUSY):
                refused()
        self.assertEqual([self.ask(f"writes DRIVE {name}", 1) for name in ("6040.00", "6060.00", "607A.00", "6083.00")], before)
        for axis in right:
            self.assertEqual(axis.get("axis_alarms") & IDENTITY_MISMATCH, 0)
            self.prepare(axis)
            self.move(axis)


class MappingRefused(CanStory):
    """What a drive will not send by itself is read."""

    timings = {**CanStory.timings, "decode": True}

    def test_values_are_good_all_the_same(self):
        self.simulate()
        self.ask("reply-delay LINE 20")
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        refusing = set()

        def all_refuse():
            # From the moment that its first process data are switched off, whatever it is asked.
            for number in {1, 2, 3} - refusing:
                if self.gateway.found(f"-> 60{number} .* SDO write 180.:01"):
                    self.ask("exception DRIVE 0x06040041 on", number)
                    refusing.add(number)
            return len(refusing) == 3

        until("all are being mapped", all_refuse)
        for number in refusing:
            self.gateway.wait_for(f"axis {number}: .*is polled")
            self.ask("clear DRIVE", number)
        self.ask("reply-delay LINE 1")
        self.until_online()
        self.look_around()
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                self.prepare(axis)
                until("every value it supports", lambda: (now := axis.block())["valid"] == now["supported"])
                self.move(axis)
                axis.set(target_velocity=300 * RPM)
                axis.command("run_velocity")
                until("its speed", lambda: abs(axis.get("velocity_actual") - 300 * RPM) <= 5 * RPM)
                axis.command("halt")
                axis.until(motion_state=ABORTED)
        self.assert_one_request_at_a_time()


class OtherUnits(CanStory):
    """What a Leadshine counts in a turn is a setting of the drive, read from it."""

    drives_on = {"cell": "ld2@1+2008.00=5000,ld2@2+6091.01=1+6091.02=2,ld2@3+6092.01=3600"}

    def test_a_turn_is_a_turn(self):
        self.begin()
        for axis, counts in zip(self.axes, (5000, 20000, 3600)):
            with self.subTest(axis=axis.number):
                self.prepare(axis)
                self.move(axis)
                self.assertAlmostEqual(int(self.ask("position DRIVE", axis.number)), counts, delta=20)
                axis.set(target_velocity=300 * RPM)
                axis.command("run_velocity")
                until("its speed", lambda: abs(axis.get("velocity_actual") - 300 * RPM) <= 5 * RPM)
                self.assertAlmostEqual(int(self.ask("get DRIVE 60FF.00", axis.number).split()[0]), 5 * counts, delta=1)
                axis.command("disable")


class FactoryFresh(CanStory):
    drives_on = {"cell": "jd@1+fresh,md@2+fresh"}

    def test_local_control_is_told_and_not_changed(self):
        self.begin()
        for axis in self.axes:
            with self.subTest(axis=axis.number):
                until("the alarm", lambda: axis.get("axis_alarms") & ALARM_LOCAL_CONTROL)
                self.assertNotIn("ready", axis.inputs())
                with self.refused(REFUSED, BUSY):
                    axis.command("enable")
                self.assertNotIn("operation", self.ask("state DRIVE", axis.number))
                self.assertEqual(self.ask("stores DRIVE", axis.number), "0")


class LaterThanTheGateway(CanStory):
    def test_drives_that_are_switched_on_one_by_one(self):
        self.simulate()
        for number in (1, 2, 3):
            self.ask("connect DRIVE off", number)
        self.configure()
        self.run_gateway()
        self.client = self.connect()
        self.axes = [self.axis(number) for number in (1, 2, 3)]
        self.targets = {}
        for axis in self.axes:
            self.assertNotEqual(axis.get("link_state"), ONLINE)
            self.assertEqual(axis.get("valid"), 0)
        for axis in self.axes:
            self.ask("restart DRIVE", axis.number)
            self.ask("connect DRIVE on", axis.number)
            axis.until(link_state=ONLINE, axis_state=DISABLED)
            self.prepare(axis)
            self.targets[axis.number] = 0
            self.move(axis)
        self.assertEqual(self.client.gateway()["axes_online"], 3)


if __name__ == "__main__":
    main()
