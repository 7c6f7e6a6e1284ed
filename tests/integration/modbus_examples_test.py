# SPDX-License-Identifier: Apache-2.0
"""The programs of deploy/examples/modbus, as a user calls them, with real pymodbus, libmodbus and mbpoll: each moves its axis, and leaves
nothing moving behind, however it ends."""
import os
import re
import signal
import subprocess
import sys

from examples_stage import EXAMPLES, FAR, PROGRAMS, TOOLS, TURN, Examples, main
from modbus import DISABLED, ERROR_STOP
from processes import Program, until
from stage import SOURCE

sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page  # noqa: E402

TURNS = 2.5


class OfPrograms(Examples):
    """The programs that move an axis to a position."""

    def each(self):
        """How each is called: the command up to the listener's port, without the target."""
        for name, command, listener, unit in (
                ("move_pymodbus", ["/usr/bin/python3", "-B", f"{EXAMPLES}/modbus/move_pymodbus.py"], PROGRAMS, 1),
                ("move_libmodbus", [self.path("move_libmodbus")], PROGRAMS, 1),
                ("move_mbpoll", [f"{EXAMPLES}/modbus/move_mbpoll.sh"], TOOLS, TURN)):
            with self.subTest(name):
                yield lambda turns, name=name, command=command, listener=listener, unit=unit: self.keep(Program(
                    name, [*command, "127.0.0.1", str(self.ports[listener]), "1", str(round(turns * unit, 3 if unit == 1 else None)), "300"],
                    start_new_session=True))

    def setUp(self):
        super().setUp()
        source = f"{EXAMPLES}/modbus/move_libmodbus.c"
        with open(source, encoding="utf-8") as file:
            line = re.search(r"(gcc -O2 .*) \*/", file.read())[1]  # as its first comment has it
        line = line.replace("move_libmodbus.c", source).replace("-o move_libmodbus", f"-Wall -Wextra -Werror -o {self.path('move_libmodbus')}")
        subprocess.run(line, shell=True, check=True)


class Programs(OfPrograms):
    lease_ms = 30000  # a machine that stands still is no dead program

    def test_they_move_the_axis_and_let_it_go(self):
        for run in self.each():
            for turns in (TURNS, -0.5):
                program = run(turns)
                self.assertEqual(program.ended(), 0, program.text())
                program.wait_for("^there")
                self.assertAlmostEqual(self.position(), turns, delta=0.01)
                self.until_it_stands_without_torque()
                self.axis(1).until(owner=0)

    def test_a_signal_stops_the_motor_before_they_end(self):
        for run in self.each():
            for number in (signal.SIGINT, signal.SIGTERM):
                program = run(FAR)
                self.until_it_turns()
                # Ctrl-C is for all that the terminal has; a service manager knows the one that it has started.
                (os.killpg if number == signal.SIGINT else os.kill)(program.pid, number)
                self.assertEqual(program.ended(), 1, program.text())
                program.wait_for("stopping")
                self.assertIn("stop_latched", self.axis(1).inputs(), "a disable alone may let it coast")
                self.until_it_stands_without_torque()
                self.axis(1).until(owner=0)

    def test_what_goes_wrong_is_told_and_nothing_is_enabled(self):
        self.sim.ask("unresponsive lift/1 on")
        self.axis(1).until(link_state=4)
        for run in self.each():
            program = run(TURNS)
            self.assertEqual(program.ended(), 1, program.text())
            program.wait_for("not online")
        self.assertEqual(self.sim.writes("lift/1", "6040.00"), 0)
        self.sim.ask("unresponsive lift/1 off")
        self.axis(1).until(link_state=2)
        self.sim.ask("set lift/1 2010.03 1")  # DIN1 has the last word on the enable
        for run in self.each():
            program = run(TURNS)
            self.assertEqual(program.ended(), 1, program.text())
            program.wait_for("(?i)result|illegal|failure")
            self.axis(1).until_input("enabled", False)


class ProgramsDie(OfPrograms):
    """Killed, they say nothing any more: the lease, as the examples' configuration has it, stops the motor."""

    def test_their_motor_is_stopped(self):
        for run in self.each():
            program = run(FAR)
            self.until_it_turns()
            program.process.kill()
            self.axis(1).until_input("stop_latched")
            until("it stands", lambda: self.speed() == 0 and self.speed() == 0)
            self.axis(1).until(owner=0)


class CommandsOfPages(Examples):
    """mbpoll, as the first pages have it, at the listener for tools."""

    lease_ms = 60000
    listener_options = {"start_deadline_ms": 60000, "reply_deadline_ms": 60000}

    def typed(self, command):
        # More time for an answer: this machine may be busy with something else.
        command = command.replace("1502", str(self.ports[TOOLS])).replace("mbpoll", "mbpoll -o 10", 1).replace("./sim.sock", self.path("control"))
        return subprocess.run(command, shell=True, check=True, stdout=subprocess.PIPE, text=True).stdout

    def told(self, command):
        """socat waits for an answer half a second and no longer."""
        until("the simulator has answered", lambda: self.typed(command) == "ok\n")

    def test_a_fault_is_made_and_reset(self):
        self.told(of_page("docs/quick_start.md", "echo 'fault lift/1"))
        self.axis(1).until(axis_state=ERROR_STOP, error_code=0x3210)
        self.told(of_page("docs/quick_start.md", "echo 'clear lift/1"))
        self.typed(of_page("docs/quick_start.md", "mbpoll -0 -m tcp -p 1502 -t 0 -r 101"))
        self.axis(1).until(axis_state=DISABLED, error_code=0)

    def test_they_read_enable_and_stop(self):
        enable = of_page("README.md", "mbpoll -0 -m tcp -p 1502 -t 0 -r 100 127.0.0.1 1")
        self.assertRegex(self.typed(of_page("README.md", "mbpoll -0 -m tcp -p 1502 -t 4:hex")), r"(?m)^\[118\]:\s+0x0002$")
        self.typed(enable)
        self.axis(1).until_input("enabled")
        self.typed(of_page("README.md", "mbpoll -0 -m tcp -p 1502 -t 0 -r 102"))
        self.until_it_stands_without_torque()
        self.axis(1).until_input("stop_latched")
        self.typed(of_page("README.md", "mbpoll -0 -m tcp -p 1502 -t 0 -r 100 127.0.0.1 0"))
        self.typed(enable)
        self.axis(1).until_input("enabled")


if __name__ == "__main__":
    main()
