# SPDX-License-Identifier: Apache-2.0
"""One drive of a line is unresponsive, late, noisy, or restarts: the others go on, and no value that is called valid is ever wrong."""
from modbus import (AXIS, COMPLETED, DISABLED, FAILED, NO_ANSWER, NO_PATH, OFFLINE, ONLINE, REFUSED, SETUP, STANDSTILL, SUSPECT,
                    UNKNOWN, Refused)
from processes import until
from stage import Story, bus, drive, main

# Three times the gateway's own: a busy machine keeps a simulated drive from its answer for as long as that.
TIMEOUT = 300
TURN = 10000
FAR = 20000 * TURN
RPM = 1000
# Bits of `valid`.
QUANTITY = {"position_actual": 2, "velocity_actual": 3, "error_code": 7, "vendor_error": 8, "drive_temperature": 11, "dc_voltage": 13,
            "mode_display": 1, "target_position": 16, "profile_velocity": 20}


class Line(Story):
    """Axes 1, 2, 3 on one line; the middle one has the fault."""

    adapter = "kinco-serial"

    def setUp(self):
        super().setUp()
        self.start(buses=[bus(self.path(self.line), *self.drives(), adapter=self.adapter, timeout_ms=TIMEOUT)])
        self.axes = [self.axis(number) for number in (1, 2, 3)]
        for axis in self.axes:
            axis.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)
        self.middle, self.others = self.axes[1], [self.axes[0], self.axes[2]]
        self.drive = f"{self.line}/2"
        self.targets = {axis.number: 0 for axis in self.axes}

    def move(self, axis):
        """Enabled if need be, by one turn."""
        self.targets[axis.number] += TURN
        axis.set(target_position=self.targets[axis.number])
        if "enabled" not in axis.inputs():
            axis.command("enable")
        number = axis.command("move_absolute")
        axis.until(motion_state=COMPLETED, motion_id=number)
        until("it is there", lambda: abs(axis.get("position_actual") - self.targets[axis.number]) <= 20)

    def assert_others_go_on(self):
        for axis in self.others:
            self.move(axis)
            self.assertEqual(axis.get("link_state"), ONLINE)

    def fault(self, what):
        self.sim.ask(what.replace("DRIVE", self.drive))

    def healed(self):
        self.sim.ask(f"clear {self.drive}")
        self.middle.until(link_state=ONLINE)

    def truth(self, axis):
        """What a standing axis has to read, by name."""
        block = axis.block()
        return {name: block[name] for name in QUANTITY}

    def assert_true(self, axis, truth):
        block = axis.block()
        for name, bit in QUANTITY.items():
            if block["valid"] >> bit & 1:
                self.assertEqual(block[name], truth[name], f"{name} of axis {axis.number} is called valid")

    def watch_until(self, what, enough):
        """Reads all axes again and again; each valid value has to be the true one."""
        truths = {axis.number: self.truth(axis) for axis in self.axes}
        self.fault(what)

        def look():
            for axis in self.axes:
                self.assert_true(axis, truths[axis.number])
            return enough(self.client.bus(0))

        until(f"enough of '{what}'", look)

    def stand_somewhere(self):
        """Every value of every axis differs from its neighbour's."""
        for turns, axis in enumerate(self.axes, 1):
            self.targets[axis.number] = turns * TURN // 2
            self.move(axis)
            axis.until(position_actual=self.targets[axis.number])  # a drive says "reached" a little before it stands
            axis.command("disable")
            axis.until_input("moving", False)
            axis.set(profile_velocity=(600 + turns) * RPM)
            axis.until(velocity_actual=0)

    # The stories, on each kind of line.

    def tell_mute(self):
        self.be_unresponsive_for_a_while()
        self.middle.until_input("enabled")  # nobody told it to stop
        self.middle.command("disable")
        self.middle.until(axis_state=DISABLED)
        self.move(self.middle)

    def be_unresponsive_for_a_while(self):
        self.move(self.middle)
        self.fault("unresponsive DRIVE on")
        self.middle.until(link_state=OFFLINE)
        block = self.middle.block()
        self.assertEqual((block["statusword"], block["valid"], block["error_code"]), (0, 0, 0x8130))
        with self.refused(NO_PATH):
            self.middle.command("move_absolute")
        self.assertEqual((self.client.bus(0)["link"], self.client.gateway()["axes_online"]), (2, 2))
        self.assert_others_go_on()
        self.healed()

    def tell_restart(self, meanwhile):
        for axis in self.axes:
            axis.command("enable")
        self.middle.set(target_position=FAR)
        number = self.middle.command("move_absolute")
        self.middle.until_input("moving")
        restarts = int(self.sim.ask(f"restarts {self.drive}"))
        self.fault("restart DRIVE")
        until("the restart", lambda: int(self.sim.ask(f"restarts {self.drive}")) == restarts + 1)
        until("no values", lambda: self.middle.get("link_state") in (SUSPECT, OFFLINE, UNKNOWN, SETUP))
        meanwhile()
        self.middle.until(link_state=ONLINE)
        block = self.middle.until(motion_state=FAILED, axis_state=DISABLED)
        self.assertEqual(block["motion_id"], number)
        self.assertNotIn("operation", self.sim.state(self.drive))
        with self.refused(REFUSED):
            self.middle.command("move_absolute")
        for axis in self.others:
            axis.until_input("enabled")  # another drive's restart is no reason to stop
            axis.command("disable")
        self.middle.set(profile_velocity=600 * RPM)
        self.targets[2] = self.middle.get("position_actual")
        for axis in self.axes:
            self.move(axis)

    def tell_late(self, milliseconds=TIMEOUT + 30):
        """More than the gateway waits for an answer."""
        self.stand_somewhere()
        self.watch_until(f"late DRIVE {milliseconds} 0.3", lambda bus_now: bus_now["late_replies"] >= 5)
        self.healed()
        self.assert_others_go_on()
        self.move(self.middle)


class Chain(Line):
    """RS232, each drive hands on to the next and returns the host's frames."""

    line = "chain"
    lines = {"chain": "jd@1,md@2,jd@3"}

    def drives(self):
        return [drive("jd", 1, 1), drive("md", 2, 2), drive("jd", 3, 3)]

    def test_mute(self):
        self.tell_mute()

    def test_unresponsive_for_a_moment_only(self):
        self.fault("unresponsive DRIVE next 1")
        until("a timeout", lambda: self.client.bus(0)["timeouts"] >= 1)
        self.middle.until(link_state=ONLINE)
        self.assertEqual(len(self.gateway.found("axis 2: .*offline")), 0)

    def test_late_replies(self):
        self.tell_late()

    def test_lost_replies_of_writes_are_not_written_twice(self):
        for value in range(20000, 20010):
            before = self.sim.writes(self.drive, "6083.00")
            self.fault("lose DRIVE 0.3")
            try:
                self.middle.set(profile_acceleration=value)
                told = True
            except Refused as refused:
                told = False
                self.assertIn(refused.code, (NO_ANSWER, NO_PATH, 0x06))
            self.healed()
            written = self.sim.writes(self.drive, "6083.00") - before
            self.assertLessEqual(written, 1)
            if told:
                self.assertEqual(written, 1)
                self.assertAlmostEqual(self.middle.get("profile_acceleration"), value, delta=10)

    def test_noise(self):
        self.stand_somewhere()
        self.watch_until("noise DRIVE 0.3", lambda bus_now: bus_now["dropped_bytes"] >= 100)
        self.assert_others_go_on()
        self.healed()
        self.move(self.middle)

    def test_corrupt_replies(self):
        self.stand_somewhere()
        self.watch_until("corrupt DRIVE 0.2", lambda bus_now: bus_now["timeouts"] + bus_now["bad_frames"] >= 10)
        self.healed()
        self.assert_others_go_on()
        self.move(self.middle)

    def test_replies_of_a_wrong_station(self):
        self.stand_somewhere()
        self.watch_until("wrong-station DRIVE 0.2", lambda bus_now: bus_now["timeouts"] >= 5)
        self.healed()
        self.assert_others_go_on()

    def test_replies_that_come_twice(self):
        self.stand_somewhere()
        self.watch_until("duplicate DRIVE on", lambda bus_now: bus_now["late_replies"] + bus_now["dropped_bytes"] >= 20)
        self.move(self.middle)
        self.assert_others_go_on()

    def test_split_replies_are_nothing_special(self):
        before = self.client.bus(0)
        self.fault("split DRIVE on")
        self.move(self.middle)
        self.assert_others_go_on()
        after = self.client.bus(0)
        self.assertEqual([after[name] - before[name] for name in ("timeouts", "bad_frames", "dropped_bytes")], [0, 0, 0])

    def test_a_restart_while_it_moves_starts_nothing(self):
        # What boots hands nothing on: the whole chain is cut for that time.
        self.tell_restart(lambda: [axis.until(link_state=ONLINE) for axis in self.others])

    def test_what_a_drive_refuses_comes_with_its_own_code(self):
        self.middle.set(object_index=0x6041, object_subindex=0, object_size=2, object_data=1)
        try:
            self.middle.set(object_request=2)  # a statusword cannot be written
        except Refused as refused:
            self.assertEqual(refused.code, REFUSED)
        block = self.middle.until(object_status=3)
        self.assertEqual(block["object_detail"], 0x06010002)
        self.assertEqual(self.middle.get("link_state"), ONLINE)
        self.middle.set(object_index=0x6041, object_subindex=0, object_size=2)
        self.middle.set(object_request=1)
        block = self.middle.until(object_status=2)
        self.assertEqual(block["object_data"], block["statusword"])

    def test_every_row_it_supports_has_a_value(self):
        for axis in self.axes:
            block = axis.block()
            self.assertEqual(block["supported"] & block["valid"], block["supported"])
            self.assertEqual(set(block), set(AXIS))
            self.assertEqual(block["axis_state"], DISABLED)
            axis.command("enable")
            axis.until(axis_state=STANDSTILL)


class Rs485(Line):
    """RS485 with Kinco's own protocol, as the MD leaves the factory."""

    line = "field"
    lines = {"field": "md@1,md@2,md@3"}
    sim_options = ("--rs485",)

    def drives(self):
        return [drive("md", number, number) for number in (1, 2, 3)]

    def test_mute(self):
        self.tell_mute()

    def test_late_replies(self):
        self.tell_late()

    def test_a_restart_while_it_moves_starts_nothing(self):
        self.tell_restart(self.assert_others_go_on)

    def test_babble(self):
        self.stand_somewhere()
        self.watch_until("babble DRIVE 0.1", lambda bus_now: bus_now["dropped_bytes"] >= 100)
        self.healed()
        for axis in self.axes:
            axis.until(link_state=ONLINE)
        self.assert_others_go_on()


if __name__ == "__main__":
    main()
