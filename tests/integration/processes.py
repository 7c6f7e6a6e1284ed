# SPDX-License-Identifier: Apache-2.0
"""Programs under test: started, watched by what they print, and ended by their own number."""
import os
import re
import signal
import socket
import subprocess
import threading
import time

NEVER = 60  # seconds; what has not happened by then never will


def until(what, look, seconds=NEVER):
    """The first true value of `look`, which is asked again and again."""
    deadline = time.monotonic() + seconds
    while True:
        value = look()
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError(f"{what}: not within {seconds} s")
        time.sleep(0.02)


class Program:
    """One child process. Its output is kept line by line."""

    def __init__(self, name, command, **options):
        self.name = name
        self.lines = []
        options.setdefault("stdin", subprocess.DEVNULL)
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", **options)
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip("\n"))

    @property
    def pid(self):
        return self.process.pid

    def found(self, pattern):
        """All lines that match so far."""
        return [match for line in list(self.lines) if (match := re.search(pattern, line))]

    def wait_for(self, pattern, count=1):
        def look():
            matches = self.found(pattern)
            if len(matches) >= count:
                return matches
            if not self.reader.is_alive():
                matches = self.found(pattern)
                assert len(matches) >= count, f"{self.name} has ended without '{pattern}':\n{self.text()}"
                return matches
            return None

        return until(f"{self.name} says '{pattern}'", look)

    def text(self):
        return "\n".join(self.lines)

    def send(self, number):
        self.process.send_signal(number)

    def ended(self):
        """Waits for its end: the exit code, negative for a signal."""
        code = self.process.wait(timeout=NEVER)
        self.reader.join(timeout=NEVER)
        return code

    def terminate(self):
        self.send(signal.SIGTERM)
        return self.ended()

    def clean_up(self):
        if self.process.poll() is None:
            self.process.kill()
        self.ended()
        self.process.stdout.close()


class Ports:
    """Ports of loopback that neither another test at the same time nor an outgoing connection takes: each is kept by a name in the
    kernel as long as the test runs, also while nobody listens there."""

    def __init__(self):
        self.next = 10000 + os.getpid() * 16 % 20000
        self.claims = []

    def free(self):
        while True:
            port, self.next = self.next, self.next + 1 if self.next < 30000 else 10000
            claim = socket.socket(socket.AF_UNIX)
            with socket.socket() as probe:
                try:
                    claim.bind(f"\0axisgate-test-port-{port}")
                    probe.bind(("127.0.0.1", port))
                except OSError:
                    claim.close()
                    continue
            self.claims.append(claim)
            return port
