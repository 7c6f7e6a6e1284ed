#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""deploy/demo as a user has it: what it shows is true, what it prints can be typed, and however it ends nothing is left behind.

usage: demo_test.py SOURCE_FOLDER BUILD_FOLDER
"""
import fcntl
import html
import os
import pty
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

SOURCE, BUILD = (os.path.abspath(folder) for folder in sys.argv[1:3])
sys.path.insert(0, f"{SOURCE}/tests/integration")
from disturbance import UndisturbedTest  # noqa: E402 where the stories have it
from processes import Ports  # noqa: E402

LONGEST = 60
COLUMNS, ROWS = 80, 24  # the smallest terminal that there is
PORTS = Ports()


def processes_in(folder):
    """Processes whose current folder is in `folder`, as all of the demo's are."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.readlink(f"/proc/{pid}/cwd").startswith(folder):
                found.append(int(pid))
        except OSError:
            continue
    return found


def until(what, condition):
    deadline = time.monotonic() + LONGEST
    while time.monotonic() < deadline:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"{what}: not within {LONGEST} s")


def without_colours(lines):
    return [re.sub(r"\x1b\[\d+m", "", line) for line in lines]


def is_how_a_machine_is_built(lines):
    """All axes are online, nothing is red, and yellow are the standing alarms of such drives alone."""
    plain = "\n".join(without_colours(lines))
    online = all(re.search(rf"(?m)^ +\d  {name} +online ", plain) for name in ("lift", "feeder", "turntable", "press", "ejector"))
    yellow = set(re.findall(r"\w+", " ".join(re.findall(r"\x1b\[33m(.*?)\x1b", "\n".join(lines)))))
    standing = yellow - {"alarms", "no", "comm", "watchdog"} == {"no_comm_watchdog", "not_homed", "cannot_deenergise"}
    return online and standing and not any("\x1b[31m" in line for line in lines)


class Demo(UndisturbedTest):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.port, self.page = PORTS.free(), PORTS.free()
        self.environment = {**os.environ, "TMPDIR": self.folder.name, "TERM": "xterm"}

    def command(self, *options):
        return [f"{SOURCE}/deploy/demo", "--built", BUILD, "--port", str(self.port), "--page", str(self.page), *options]

    def start_on_terminal(self, *options):
        """Its pid and the other end of its terminal."""
        pid, terminal = pty.fork()
        if pid == 0:
            os.execve(f"{SOURCE}/deploy/demo", self.command(*options), self.environment)
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        os.set_blocking(terminal, False)
        return pid, terminal

    def read(self, terminal, so_far):
        try:
            so_far.append(os.read(terminal, 65536).decode(errors="replace"))
        except (BlockingIOError, OSError):
            pass
        return "".join(so_far)

    def wait_for_table(self, terminal, holds="axes online 5 of 5", is_it=lambda lines: True):
        """The lines of the first whole frame with these words of which that is true, colours and all."""
        screen = []

        def frame():
            frames = re.findall(r"\x1b\[H(.*?)\x1b\[J", self.read(terminal, screen), re.S)
            lines = (re.split(r"\r*\n", one.replace("\x1b[K", "")) for one in frames if holds in one)
            return next(filter(is_it, lines), None)

        return until("a table", frame)

    def ended(self, pid, terminal=None):
        def look():
            if terminal is not None:
                self.read(terminal, [])  # a full terminal would hold it up
            done, status = os.waitpid(pid, os.WNOHANG)
            return (status,) if done else None

        return os.waitstatus_to_exitcode(until("its end", look)[0])

    def assert_nothing_left(self):
        until("no process left", lambda: not processes_in(self.folder.name))
        self.assertEqual(os.listdir(self.folder.name), [])

    def test_without_a_terminal_it_prints_tables_and_ends_by_itself(self):
        ended = subprocess.run(self.command("--seconds", "10"), env=self.environment, stdin=subprocess.DEVNULL, capture_output=True,
                               text=True, timeout=LONGEST, check=False)
        self.assertEqual(ended.returncode, 0, ended.stderr + ended.stdout)
        self.assertGreaterEqual(ended.stdout.count("axes online 5 of 5"), 3)
        self.assertNotIn("\x1b", ended.stdout)
        for told in (f"http://127.0.0.1:{self.page}/", "axisgate explain no_comm_watchdog"):
            self.assertIn(told, ended.stdout.partition("axes online")[0])
        for axis, name in ((1, "lift"), (4, "press")):
            positions = set(re.findall(rf"^ +{axis}  {name} .*?profile position +(-?\d+)", ended.stdout, re.M))
            self.assertGreaterEqual(len(positions), 2, f"axis {axis} does not move:\n" + ended.stdout)
        self.assert_nothing_left()

    def test_what_it_shows_fits_is_no_failure_and_can_be_typed(self):
        pid, terminal = self.start_on_terminal("--no-move")
        # A simulated drive that a busy machine keeps from answering is shown as it is, suspect or faulted: that passes.
        screen = self.wait_for_table(terminal, is_it=is_how_a_machine_is_built)
        plain = without_colours(screen)
        self.assertLessEqual(len(plain), ROWS)
        self.assertLessEqual(max(map(len, plain)), COLUMNS, plain)
        self.assertIn("turns, ", "\n".join(plain))
        below = "\n".join(plain[plain.index("") :])
        explain = re.search(r"^yellow .*: (axisgate explain no_comm_watchdog)$", below, re.M)
        self.assertIn("the drive does not notice", subprocess.run(f"{BUILD}/bin/{explain[1]}", shell=True, capture_output=True, text=True, check=True).stdout)
        self.assertIn(f"http://127.0.0.1:{self.page}/", below)
        move = " ".join(below.split()).partition("in another terminal: ")[2]
        tries = []

        def reached():
            self.read(terminal, [])  # a full terminal would hold the demo up
            typed = subprocess.run(move.split(), capture_output=True, text=True, timeout=LONGEST, check=False)
            tries.append(typed.stdout + typed.stderr)
            return typed.returncode == 0

        until("a move as it is typed", reached)
        self.assertIn("reached: axis 2  5.0000 turns", tries[-1])
        self.wait_for_table(terminal, "       50000 ")
        os.write(terminal, b"\x03")
        self.assertEqual(self.ended(pid, terminal), 0)
        self.assert_nothing_left()
        os.close(terminal)
        self.assert_picture_is_like(plain)

    def assert_picture_is_like(self, screen):
        """README's picture has the columns and names of today (deploy/demo_picture draws it)."""
        with open(f"{SOURCE}/docs/demo.svg", encoding="utf-8") as picture:
            drawn = [html.unescape(text) for text in re.findall(r">([^<]*)</text>", picture.read())]
        header = next(line for line in screen if line.startswith("axis "))
        self.assertIn(header, drawn)
        self.assertIn(next(line for line in screen if line.startswith("yellow")), drawn)

    def test_ctrl_c_leaves_nothing_behind(self):
        pid, terminal = self.start_on_terminal()
        self.wait_for_table(terminal)
        os.write(terminal, b"\x03")
        self.assertEqual(self.ended(pid, terminal), 0)
        self.assert_nothing_left()
        os.close(terminal)

    def test_closing_the_terminal_leaves_nothing_behind(self):
        pid, terminal = self.start_on_terminal()
        self.wait_for_table(terminal)
        os.close(terminal)
        self.ended(pid)
        self.assert_nothing_left()

    def test_being_terminated_leaves_nothing_behind(self):
        pid, terminal = self.start_on_terminal()
        self.wait_for_table(terminal)
        os.kill(pid, signal.SIGTERM)
        self.assertEqual(self.ended(pid, terminal), 128 + signal.SIGTERM)
        self.assert_nothing_left()
        os.close(terminal)

    def test_a_taken_port_is_named(self):
        with socket.create_server(("127.0.0.1", self.port)):
            ended = subprocess.run(self.command("--seconds", "1"), env=self.environment, stdin=subprocess.DEVNULL,
                                   capture_output=True, text=True, timeout=LONGEST, check=False)
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"port {self.port} is taken", ended.stderr)
        self.assert_nothing_left()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
