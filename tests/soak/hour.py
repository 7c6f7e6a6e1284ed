# SPDX-License-Identifier: Apache-2.0
"""The shipped programs before simulated drives in real time: what tests/soak/run --hour runs.

hour.py AXISGATE AXISGATE_SIM SOURCE_FOLDER MINUTES

Seven axes on five lines move to and fro for their clients; a monitor reads all of them, and each second a tool connects, reads and goes. In
each of twelve parts of the time something goes wrong that is counted here as well: a cable, a trip, a storm of clients, the DDS process. At
the end memory, descriptors and threads must be what they were, and every counter of every bus be what was done to it.
"""
import contextlib
import json
import os
import re
import signal
import sys
import tempfile
import time

sys.path.insert(0, f"{sys.argv[3]}/tests/integration")
from modbus import AXIS, COMMANDS, GATEWAY, Client, Closed, Refused, encode  # noqa: E402
from processes import Program, until  # noqa: E402
from stage import AXISGATE, PORTS, SOURCE, Gateway, Simulator, bus, drive  # noqa: E402
from stage import DRIVES  # noqa: E402

PARTS = 12
STORM = 200  # clients at once
PATIENCE = 600  # seconds: a machine that is busy with something else is slow
GROWTH_KIB = 1024  # of memory, between the second part and the end
DOMAIN = 142
DRIVES.update(ld2=("leadshine-ld2-can", {}), keya=("keya-kydas4860-2e", {}))
LINES = {"lift": "jd@1", "feeder": "md@1", "turntable": "rtu:id286pro@1", "press": "lawicel:ld2@1", "wheels": "keya-rs232"}
MOVERS = (1, 2, 3, 4)  # deploy/demo_move.py moves each of them
RUNNERS = (5, 6)  # a Keya as delivered runs at speed
CABLES = ("lift", "feeder", "turntable", "wheels")
TRIP = {"lift/1": "2601 0x0020", "feeder/1": "2601 0x0020"}


def configuration(folder, port):
    buses = [bus(f"{folder}/lift", drive("jd", 1, 1)), bus(f"{folder}/feeder", drive("md", 1, 2)),
             bus(f"{folder}/turntable", drive("id286pro", 1, 3), adapter="modbus-rtu"),
             bus(f"slcan:{folder}/press", drive("ld2", 1, 4), adapter="canopen", bitrate=500000),
             bus(f"{folder}/wheels", drive("keya", 1, 5), adapter="keya-rs232")]
    buses[3].pop("rs485")
    buses[3]["name"] = "press"
    buses[4]["drives"][0]["axes"].append({"axis": 6, "name": "keya-6", "lease": None})
    return {"modbus_tcp": [{"listen": f"127.0.0.1:{port}", "client": "address"}], "dds": {"domain": DOMAIN, "ros2": True}, "buses": buses}


def size_of(pid):
    """Resident KiB, open files, threads."""
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        status = file.read()
    return (int(re.search(r"VmRSS:\s+(\d+)", status)[1]), len(os.listdir(f"/proc/{pid}/fd")), int(re.search(r"Threads:\s+(\d+)", status)[1]))


def child_of(pid, name):
    """The newest process of this name that it has started."""
    with open(f"/proc/{pid}/task/{pid}/children", encoding="utf-8") as file:
        for child in reversed(file.read().split()):
            with contextlib.suppress(OSError), open(f"/proc/{child}/comm", encoding="utf-8") as comm:
                if comm.read().strip() == name:
                    return int(child)
    return None


class Hour:
    def __init__(self, folder, minutes):
        self.folder, self.part = folder, minutes * 60 / PARTS
        self.programs, self.sizes, self.wrong = [], {}, []
        self.done = dict.fromkeys(("cables", "trips", "storms", "DDS processes", "connects", "reads", "refused"), 0)
        self.cables = dict.fromkeys(LINES, 0)

    def keep(self, program):
        self.programs.append(program)
        return program

    def start(self):
        self.sim = self.keep(Simulator(self.folder, LINES))
        self.port = PORTS.free()
        with open(f"{self.folder}/gateway.json", "w", encoding="utf-8") as file:
            json.dump(configuration(self.folder, self.port), file)
        self.gateway = self.keep(Gateway(f"{self.folder}/gateway.json")).wait_until_it_listens()
        self.monitor = Client(self.port)
        until("all axes are online", lambda: (g := self.monitor.gateway())["axes_online"] == g["axis_count"], PATIENCE)
        for axis in RUNNERS:
            self.run(axis)
        for axis in MOVERS:
            self.keep(Program(f"mover of axis {axis}", [f"{SOURCE}/deploy/demo_move.py", "127.0.0.1", str(self.port), str(axis)]))
        self.keep(Program("axisgate topics", [AXISGATE, "topics", f"{self.folder}/gateway.json", "--json"]))
        until("the DDS process runs", lambda: child_of(self.gateway.pid, "axisgate-dds"), PATIENCE)

    def ask(self, what, *arguments):
        """An exception is an answer, and counted."""
        try:
            return what(*arguments)
        except Refused:
            self.done["refused"] += 1
            return None

    def command(self, axis, name):
        """As a button does it: 0 first, no id."""
        for number in (0, COMMANDS[name]):
            self.ask(self.monitor.write, 100 * axis + 54, number)

    def run(self, axis):
        self.command(axis, "enable")
        self.ask(self.monitor.write, 100 * axis + 44, *encode("i32", 100000))
        self.command(axis, "run_velocity")

    def go_on(self):
        """Everything is as it was before: all that moved moves again."""
        until("all axes are online", lambda: (g := self.monitor.gateway())["axes_online"] == g["axis_count"], PATIENCE)
        for axis in (*MOVERS, *RUNNERS):
            block = self.monitor.axis(axis).block()
            if block["axis_state"] == 6:
                self.command(axis, "fault_reset")
            if block["axis_state"] in (0, 5, 6):
                self.command(axis, "enable")
            if axis in RUNNERS and self.monitor.axis(axis).get("axis_state") != 3:
                self.run(axis)

    def look(self, end):
        """What clients do all the time, until then."""
        while time.monotonic() < end:
            for _ in range(10):
                for axis in (*MOVERS, *RUNNERS):
                    self.monitor.table(AXIS, 100 * axis)
                    self.done["reads"] += 1
                time.sleep(0.1)
            tool = Client(self.port)
            tool.table(GATEWAY, 0)
            tool.close()
            self.done["connects"] += 1

    # What goes wrong.

    def pull_a_cable(self, turn):
        line = CABLES[turn % len(CABLES)]
        self.sim.ask(f"unplug {line}")
        self.look(time.monotonic() + 2)
        self.sim.ask(f"plug {line}")
        self.cables[line] += 1
        self.done["cables"] += 1

    def trip(self, turn):
        where = list(TRIP)[turn % len(TRIP)]
        self.sim.ask(f"fault {where} {TRIP[where]}")
        self.look(time.monotonic() + 1)
        self.sim.ask(f"clear {where} {TRIP[where]}")
        self.done["trips"] += 1

    def storm(self, _):
        crowd = []
        for _ in range(STORM):
            with contextlib.suppress(Closed):
                crowd.append(Client(self.port))
        for client in crowd:
            client.close()
        self.done["storms"] += 1

    def kill_dds(self, _):
        before = child_of(self.gateway.pid, "axisgate-dds")
        os.kill(before, signal.SIGKILL)
        until("another DDS process runs", lambda: child_of(self.gateway.pid, "axisgate-dds") not in (None, before), PATIENCE)
        self.done["DDS processes"] += 1

    def measure(self):
        """Names of programs: a DDS process that was killed is another one afterwards."""
        for name, pid in (("axisgate", self.gateway.pid), ("axisgate-dds", child_of(self.gateway.pid, "axisgate-dds")),
                          ("axisgate-sim", self.sim.pid)):
            self.sizes.setdefault(name, []).append(size_of(pid))

    def play(self):
        wrongs = (self.pull_a_cable, self.trip, self.storm, self.kill_dds)
        begun = time.monotonic()
        for part in range(PARTS):
            # In its first half nothing is wrong.
            self.look(begun + (part + 0.5) * self.part)
            wrongs[part % len(wrongs)](part // len(wrongs))
            self.go_on()
            self.look(begun + (part + 1) * self.part)
            self.measure()
            print(f"part {part + 1} of {PARTS}: " + "; ".join(
                f"{name} {sizes[-1][0]} KiB, {sizes[-1][1]} files, {sizes[-1][2]} threads" for name, sizes in self.sizes.items()), flush=True)

    # What must be so at the end.

    def must(self, is_so, words):
        if not is_so:
            self.wrong.append(words)

    def judge(self):
        for name, sizes in self.sizes.items():
            memory, files, threads = ([size[column] for size in sizes[1:]] for column in range(3))
            self.must(memory[-1] <= memory[0] + GROWTH_KIB, f"{name} grew from {memory[0]} to {memory[-1]} KiB")
            self.must(max(files) - min(files) <= 1, f"{name} had {min(files)} to {max(files)} open files")
            self.must(len(set(threads)) == 1, f"{name} had {sorted(set(threads))} threads")
        for number, line in enumerate(LINES):
            shown = self.monitor.bus(number)
            print(f"bus {line}: " + ", ".join(f"{name} {value}" for name, value in shown.items()))
            lost = shown["requests"] - shown["replies"] - shown["timeouts"]
            self.must(shown["link"] == 1, f"{line} is not up")
            self.must(shown["reconnects"] == self.cables[line], f"{line}: {self.cables[line]} cables, {shown['reconnects']} reconnects")
            self.must(-1 <= lost <= self.cables[line] + 1, f"{line}: {lost} requests without a reply or a timeout")
            self.must(shown["timeouts"] <= shown["late_replies"] + self.cables[line],
                      f"{line}: {shown['timeouts']} timeouts, {shown['late_replies']} late replies")
            for name in ("bad_frames", "refused"):
                self.must(shown[name] == 0, f"{line}: {name} {shown[name]}")
            self.must(shown["dropped_bytes"] == 0 or self.cables[line], f"{line}: dropped_bytes {shown['dropped_bytes']}")
        for program in self.programs:
            self.must(program.process.poll() is None, f"{program.name} has ended: {program.text()[-500:]}")
        print("done: " + ", ".join(f"{name} {count}" for name, count in self.done.items()))
        print(f"log: {len(self.gateway.lines)} lines")
        for words in self.wrong:
            print(f"not explained: {words}")
        return 1 if self.wrong else 0


def main():
    with tempfile.TemporaryDirectory(prefix="axisgate-hour-") as folder:
        hour = Hour(folder, float(sys.argv[4]))
        try:
            hour.start()
            hour.play()
            code = hour.judge()
            code = hour.gateway.terminate() or code
            print(f"the gateway ended with {code}" if not code else "".join(line + "\n" for line in hour.gateway.lines[-200:]))
            return code
        finally:
            for program in reversed(hour.programs):
                program.clean_up()


if __name__ == "__main__":
    sys.exit(main())
