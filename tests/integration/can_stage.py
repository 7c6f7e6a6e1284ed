# SPDX-License-Identifier: Apache-2.0
"""Stories on CAN. One story is told twice: with simulated drives behind a serial CAN adapter (Lawicel) on a pty, and, in the folder
vcan, on virtual CAN interfaces of its own, which need a kernel that has them and the right to make them.

A story is run as: can_STORY_test.py AXISGATE AXISGATE_SIM SOURCE_FOLDER [--vcan] [unittest's arguments]
"""
import os
import subprocess
import sys
import time

ON_VCAN = "--vcan" in sys.argv
if ON_VCAN:
    sys.argv.remove("--vcan")

from modbus import BUSY, COMPLETED, DISABLED, ONLINE, Refused  # noqa: E402
from processes import until  # noqa: E402
from stage import DRIVES, Simulator, Story, drive, main  # noqa: E402,F401 main: for the stories

DRIVES["ld2"] = ("leadshine-ld2-can", {})
TURN = 10000
FAR = 20000 * TURN
RPM = 1000


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True)


class CanStory(Story):
    """One bus with a drive of each make: axes 1, 2, 3 are nodes 1, 2, 3. `drives_on` names the buses and what hangs on them."""

    drives_on = {"cell": "ld2@1,jd@2,md@3"}
    # Long enough for a machine that is busy with something else; what a story says of silence does not hang on it.
    timings = {"timeout_ms": 1000}
    patient = {"start_deadline_ms": 60000, "reply_deadline_ms": 60000}

    def setUp(self):
        super().setUp()
        if ON_VCAN:
            for name in self.drives_on:
                self.add_interface(name)

    def add_interface(self, name):
        ip("link", "add", "dev", self.wire(name), "type", "vcan")
        self.addCleanup(subprocess.run, ["ip", "link", "del", self.wire(name)], check=False, stderr=subprocess.DEVNULL)
        ip("link", "set", self.wire(name), "up")

    def wire(self, name):
        """What the simulator calls this bus."""
        return f"ag{os.getpid()}{list(self.drives_on).index(name)}" if ON_VCAN else name

    def node(self, number, bus_name=None):
        """What the simulator calls this drive."""
        return f"{self.wire(bus_name or next(iter(self.drives_on)))}/{number}"

    def device(self, name):
        return self.wire(name) if ON_VCAN else f"slcan:{self.path(name)}"

    def simulate(self, lines=None, *options):
        words = []
        for name, drives in (lines or self.drives_on).items():
            words += ["--line", f"{self.wire(name)}:can:{drives}" if ON_VCAN else f"{self.path(name)}:lawicel:{drives}"]
        self.sim = self.keep(Simulator(self.folder, {}, *words, *(options or self.sim_options)))
        return self.sim

    def can_bus(self, name, *drives, **more):
        return {"name": name, "adapter": "canopen", "device": self.device(name), "bitrate": 500000, "drives": list(drives),
                **self.timings, **more}

    def buses(self):
        buses, axis = [], 0
        for name, drives in self.drives_on.items():
            entries = []
            for word in drives.split(","):
                kind, number = word.split("+")[0].split("@")
                axis += 1
                entries.append(drive(kind, int(number), axis))
            buses.append(self.can_bus(name, *entries))
        return buses

    def listener(self, **more):
        return super().listener(**self.patient, **more)

    def begin(self, **options):
        """Everything is started, and every axis is online."""
        self.start(**options)
        self.look_around()

    def look_around(self):
        """Once the axes are online."""
        self.axes = [self.axis(number) for number in range(1, self.client.gateway()["axis_count"] + 1)]
        self.targets = {axis.number: axis.get("position_actual") for axis in self.axes}

    def prepare(self, axis):
        axis.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)

    def move(self, axis):
        """By one turn, enabled if need be."""
        self.targets[axis.number] += TURN
        axis.set(target_position=self.targets[axis.number])
        if "enabled" not in axis.inputs():
            axis.command("enable")
        number = axis.command("move_absolute")
        axis.until(motion_state=COMPLETED, motion_id=number)
        until("it is there", lambda: abs(axis.get("position_actual") - self.targets[axis.number]) <= 20)

    def until_accepted(self, what, ask, not_yet=(BUSY,)):
        """A drive that is set up anew takes nothing meanwhile, and says so by one of these exceptions."""
        def accepted():
            try:
                ask()
                return True
            except Refused as refused:
                self.assertIn(refused.code, not_yet)
                return False

        until(what, accepted)

    def reset(self, axis):
        self.until_accepted("the reset is accepted", lambda: axis.command("fault_reset"))
        axis.until(axis_state=DISABLED, error_code=0)

    def let_heartbeats_pass(self):
        """Two seconds, in which each node sends two: true ones among false may have been left out, and their node be missed."""
        then = time.monotonic() + 2.2
        until("heartbeats", lambda: self.client.gateway() and time.monotonic() > then)

    def assert_goes_on(self, *axes):
        for axis in axes:
            self.move(axis)
            self.assertEqual(axis.get("link_state"), ONLINE)

    def ask(self, words, number=None, bus_name=None):
        """A control word of the simulator; DRIVE stands for the node `number`, LINE for the bus."""
        bus_name = bus_name or next(iter(self.drives_on))
        return self.sim.ask(words.replace("DRIVE", self.node(number, bus_name)).replace("LINE", self.wire(bus_name)))

    def assert_one_request_at_a_time(self, *bus_names):
        for name in bus_names or self.drives_on:
            self.assertEqual(self.ask("overlaps LINE", bus_name=name), "0", "requests were on the bus at the same time")
