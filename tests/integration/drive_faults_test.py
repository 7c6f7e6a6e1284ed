# SPDX-License-Identifier: Apache-2.0
"""One drive of a line is unresponsive, late or noisy: the others go on, and no value that is called valid is ever wrong. Each fault on
each drive is told with simulated time by RtuLineFault, RtuNeighbours, LateReply and EachStepFails of tests/unit/drive."""
from modbus import COMPLETED, NO_ANSWER, NO_PATH, OFFLINE, ONLINE, Refused
from processes import until
from stage import DRIVES, Story, bus, drive, main

DRIVES["ld2"] = ("leadshine-ld2-can", {})

# Three times the gateway's own: a busy machine keeps a simulated drive from its answer for as long as that.
TIMEOUT = 300
TURN = 10000
RPM = 1000
# Bits of `valid`.
QUANTITY = {"position_actual": 2, "velocity_actual": 3, "error_code": 7, "vendor_error": 8, "drive_temperature": 11, "dc_voltage": 13,
            "mode_display": 1, "target_position": 16, "profile_velocity": 20}


class Line(Story):
    """Axes 1, 2, 3 on one line; the middle one has the fault."""

    line = "line"
    simulated = ""  # how the simulator calls such a line
    adapter = "kinco-serial"
    kinds = ()

    def setUp(self):
        super().setUp()
        self.lines = {self.line: self.simulated + ",".join(f"{kind}@{number}" for number, kind in enumerate(self.kinds, 1))}
        self.start([self.listener(start_deadline_ms=60000, reply_deadline_ms=60000)], [self.bus()])
        self.axes = [self.axis(number) for number in (1, 2, 3)]
        for axis in self.axes:
            axis.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)
        self.middle, self.others = self.axes[1], [self.axes[0], self.axes[2]]
        self.drive = f"{self.line}/2"
        self.targets = {axis.number: 0 for axis in self.axes}

    def bus(self):
        drives = [drive(kind, number, number) for number, kind in enumerate(self.kinds, 1)]
        return bus(self.path(self.line), *drives, adapter=self.adapter, timeout_ms=TIMEOUT)

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

    def be_disturbed(self, what, enough):
        self.stand_somewhere()
        self.watch_until(what, enough)
        self.healed()
        for axis in self.axes:
            axis.until(link_state=ONLINE)
            self.move(axis)


class Chain(Line):
    """RS232, each drive hands on to the next and returns the host's frames."""

    kinds = ("jd", "md", "jd")

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
        self.be_disturbed("noise DRIVE 0.3", lambda bus_now: bus_now["dropped_bytes"] >= 100)

    def test_replies_that_come_twice(self):
        self.be_disturbed("duplicate DRIVE on", lambda bus_now: bus_now["late_replies"] + bus_now["dropped_bytes"] >= 20)


class Rs485(Line):
    """Kinco's own protocol, as the MD leaves the factory."""

    kinds = ("md", "md", "md")
    sim_options = ("--rs485",)

    def test_babble(self):
        self.be_disturbed("babble DRIVE 0.1", lambda bus_now: bus_now["dropped_bytes"] >= 100)


class ModbusRtu(Line):
    """Three makers' types; the stepper in their middle has the fault."""

    simulated = "rtu:"
    adapter = "modbus-rtu"
    kinds = ("jd", "id286pro", "md")

    def test_one_is_mute(self):
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
        self.move(self.middle)

    def test_frames_that_break_off_have_a_wrong_length_or_stick_together(self):
        def broken_frames(bus_now):
            return bus_now["dropped_bytes"] + bus_now["bad_frames"] + bus_now["late_replies"] + bus_now["timeouts"]

        self.stand_somewhere()
        for what in ("half", "wrong-length", "glued", "corrupt", "wrong-station"):
            before = broken_frames(self.client.bus(0))
            self.watch_until(f"{what} DRIVE 0.3", lambda bus_now, before=before: broken_frames(bus_now) >= before + 4)
            self.healed()
        for axis in self.axes:
            self.move(axis)


class Can(Line):
    simulated = "lawicel:"
    adapter = "canopen"
    kinds = ("ld2", "jd", "md")

    def bus(self):
        made = {**super().bus(), "device": f"slcan:{self.path(self.line)}", "bitrate": 500000}
        made.pop("rs485")
        return made

    def test_late_replies(self):
        self.be_disturbed(f"late DRIVE {TIMEOUT + 200} 0.3", lambda bus_now: bus_now["late_replies"] >= 5)


if __name__ == "__main__":
    main()
