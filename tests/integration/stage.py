# SPDX-License-Identifier: Apache-2.0
"""What every story needs: simulated drives on their lines, the real gateway before them, and their logs where it fails.

A story is run as: STORY_test.py AXISGATE AXISGATE_SIM SOURCE_FOLDER [unittest's arguments]
"""
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

from disturbance import UndisturbedTest
from modbus import ONLINE, Client, Refused
from processes import NEVER, Ports, Program, until

AXISGATE, SIMULATOR, SOURCE = (os.path.abspath(path) for path in sys.argv[1:4])
PORTS = Ports()
DRIVES = {"jd": ("kinco-jd", {"peak_current_a": 27.5}), "md": ("kinco-md", {"peak_current_a": 36}), "id286pro": ("id286pro", {})}


def drive(kind, node, axis, **more):
    """A drive as a configuration has it."""
    profile, constants = DRIVES[kind]
    entry = {"axis": axis, "name": f"{kind}-{axis}", "lease": None, **more}
    return {"profile": profile, "node": node, "constants": constants, "axes": [entry]}


def bus(device, *drives, **more):
    """Waits for an answer longer than a machine that is busy with something else keeps a simulated drive from giving it."""
    return {"name": os.path.basename(device), "adapter": "kinco-serial", "device": device, "rs485": "off", "timeout_ms": 1000,
            "drives": list(drives), **more}


class Simulator(Program):
    """axisgate-sim with its control socket. A drive is called LINE/STATION."""

    def __init__(self, folder, lines, *options):
        control = f"{folder}/control"
        command = [SIMULATOR, "--control", control, *options]
        for name, drives in lines.items():
            command += ["--line", f"{folder}/{name}:{drives}"]
        super().__init__("axisgate-sim", command)
        self.wait_for("^control ")
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(NEVER)
        self.socket.connect(control)
        self.answers = self.socket.makefile()

    def ask(self, command):
        self.socket.sendall(command.encode() + b"\n")
        answer = self.answers.readline().rstrip("\n")
        assert answer.startswith("ok"), f"{command}: {answer}"
        return answer[3:]

    def state(self, drive_name):
        return self.ask(f"state {drive_name}")

    def object(self, drive_name, address):
        return int(self.ask(f"get {drive_name} {address}").split()[0])

    def writes(self, drive_name, *addresses):
        """How often the bus wrote these objects; without addresses, any object that a gateway might."""
        if not addresses:
            addresses = ("6040.00", "6060.00", "607A.00", "60FF.00", "60F6.08", "6071.00", "6073.00", "6080.00", "6081.00", "6083.00",
                         "6084.00", "607D.01", "607D.02", "6098.00", "6099.01", "6099.02", "609A.00", "607C.00", "2FF0.01")
        return sum(int(self.ask(f"writes {drive_name} {address}")) for address in addresses)

    def clean_up(self):
        self.answers.close()
        self.socket.close()
        super().clean_up()


class Gateway(Program):
    def __init__(self, config, *options):
        super().__init__("axisgate run", [AXISGATE, "run", config, *options])

    def found(self, pattern):
        """An axis may be asked for without the name that the log gives it: "axis 1: online" finds "axis 1 lift: online"."""
        return super().found(re.sub(r"\b(axis \d+): ", r"\1(?: [^:]*)?: ", pattern))

    def wait_until_it_listens(self):
        self.wait_for("listening on ")
        return self


class Story(UndisturbedTest):
    """A machine of two drives on two lines, unless a story builds another."""

    lines = {"lift": "jd@1", "feeder": "md@1"}
    sim_options = ()

    def run_once(self, result):
        self.programs = []
        super().run_once(result)
        if not result.wasSuccessful():
            for program in self.programs:
                print(f"--- {program.name} ({self.id()})\n{program.text()}", file=sys.stderr)

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-story-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def keep(self, program):
        self.programs.append(program)
        self.addCleanup(program.clean_up)
        return program

    def path(self, name):
        return f"{self.folder}/{name}"

    # The parts of a machine. A story that needs nothing special calls start() alone.

    def listener(self, **more):
        return {"listen": f"127.0.0.1:{PORTS.free()}", **more}

    def buses(self):
        return [bus(self.path("lift"), drive("jd", 1, 1)), bus(self.path("feeder"), drive("md", 1, 2))]

    def configure(self, listeners=None, buses=None, name="gateway.json"):
        """Writes a configuration; `self.ports` are its listeners' in order."""
        config = {"modbus_tcp": listeners or [self.listener()], "buses": buses or self.buses()}
        self.ports = [int(entry["listen"].rpartition(":")[2]) for entry in config["modbus_tcp"]]
        self.config = self.path(name)
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file, indent=2)
        return self.config

    def simulate(self, lines=None, *options):
        self.sim = self.keep(Simulator(self.folder, lines or self.lines, *(options or self.sim_options)))
        return self.sim

    def run_gateway(self, *options):
        self.gateway = self.keep(Gateway(self.config, *options)).wait_until_it_listens()
        return self.gateway

    def connect(self, listener=0, unit=1):
        client = Client(self.ports[listener], unit)
        self.addCleanup(client.close)
        return client

    def start(self, listeners=None, buses=None):
        """Drives, gateway, one client; returns when every axis is online."""
        self.simulate()
        self.configure(listeners, buses)
        self.run_gateway()
        self.client = self.connect()
        self.until_online()

    def until_online(self):
        until("all axes online", lambda: (g := self.client.gateway())["axes_online"] == g["axis_count"])

    def axis(self, number):
        return self.client.axis(number)

    def command_line(self, *arguments, answer=""):
        """axisgate as a user calls it, to its end."""
        return subprocess.run([AXISGATE, *arguments], input=answer, capture_output=True, text=True, timeout=NEVER, check=False)

    def later(self, work, *arguments):
        """Does it in a thread: a Future."""
        if not hasattr(self, "threads"):
            self.threads = ThreadPoolExecutor(max_workers=64)
            self.addCleanup(self.threads.shutdown)
        return self.threads.submit(work, *arguments)

    def code_of(self, future):
        """The exception code of a write done later; 0 where it went well."""
        failed = future.exception(timeout=NEVER)
        if failed is not None and not isinstance(failed, Refused):
            raise failed
        return failed.code if failed else 0

    @contextmanager
    def refused(self, *codes):
        with self.assertRaises(Refused) as caught:
            yield caught
        self.assertIn(caught.exception.code, codes)

    def assert_online(self, axis):
        self.assertEqual(axis.get("link_state"), ONLINE)


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
