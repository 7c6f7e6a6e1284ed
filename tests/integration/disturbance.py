# SPDX-License-Identifier: Apache-2.0
"""Tells a program that fails from a machine that had no time for it.

Stories start real programs, and much of what they ask is about time: a lease runs out after a second in which its owner was silent, a
drive's watchdog after one in which the gateway was. A machine that stands still for as long (a guest whose host is busy, a processor
shared with other work) makes the living look dead, and what a story then sees says nothing about axisgate. So all the while a test
runs, a thread watches whether it and its programs could run; a test that failed while they could not is set up and run anew. Without
such evidence a failure is one at once, and a test that passed has passed.
"""
import os
import select
import threading
import time
import tty
import unittest

ATTEMPTS = 5
PERIOD = 0.02  # seconds between two looks at the clock
LONG = 10  # seconds; a terminal that takes longer for a byte is told as one that took so long
LOOK_EVERY = 0.25  # seconds between two looks at the processes
WINDOW = 1.0  # the shortest lease, and the time of most watchdogs
# A drive's answer is waited for 100 ms and more, and a keep-alive comes three times in its watchdog's second: what is lacking by more
# than this within a second may be an answer too late or two keep-alives in one.
BOUND = 0.15
TICK = 1 / os.sysconf("SC_CLK_TCK")


def read(path):
    """Nothing where it is gone, or where this kernel does not tell it."""
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return file.read()
    except OSError:
        return ""


def children():
    """Of each process of this machine."""
    below = {}
    for name in os.listdir("/proc"):
        if name.isdigit() and (stat := read(f"/proc/{name}/stat")):
            below.setdefault(int(stat.rpartition(")")[2].split()[1]), []).append(int(name))
    return below


def family(root):
    """A process and all that it has started, and what these have."""
    below, found = children(), [root]
    for process in found:
        found += below.get(process, [])
    return found


def waits(processes):
    """How many seconds each thread of these processes has waited for a processor since it began."""
    waited = {}
    for process in processes:
        try:
            threads = os.listdir(f"/proc/{process}/task")
        except OSError:
            continue
        for thread in threads:
            if figures := read(f"/proc/{process}/task/{thread}/schedstat").split():
                waited[process, thread] = int(figures[1]) / 1e9
    return waited


def stolen():
    """How many seconds the processors of this guest were somebody else's, all together."""
    row = read("/proc/stat").partition("\n")[0].split()
    return int(row[8]) * TICK if len(row) > 8 else 0


class Terminal:
    """A pseudo-terminal, as the simulated lines are: a byte comes out of it when a thread of the kernel has had a processor."""

    def __enter__(self):
        self.near, self.far = os.openpty()
        tty.setraw(self.far)
        return self

    def __exit__(self, *_):
        os.close(self.near)
        os.close(self.far)

    def pass_a_byte(self):
        os.write(self.near, b".")
        if select.select([self.far], [], [], LONG)[0]:
            os.read(self.far, 64)


class Disturbance:
    """Watches this process and all that it starts, from `with` on."""

    def __init__(self):
        self.worst = (0, "")
        self.looks = []
        self.late = 0
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.watch, daemon=True)

    def __enter__(self):
        self.list_processes()
        self.look(self.listed, *self.so_far())
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()
        self.look(time.monotonic(), *self.so_far())

    def watch(self):
        last = looked = time.monotonic()
        over = False
        with Terminal() as terminal:
            while not over:
                over = self.over.wait(PERIOD)
                terminal.pass_a_byte()
                now = time.monotonic()
                self.passed(now - last)
                last = now
                if now - looked >= LOOK_EVERY:
                    looked = now
                    self.look(now, *self.so_far())

    def passed(self, seconds):
        """So long after the last look at the clock came this one."""
        late = max(0, seconds - PERIOD)
        self.late += late
        self.found(late, "the machine stood still")

    def list_processes(self):
        self.processes, self.listed = family(os.getpid()), time.monotonic()

    def so_far(self):
        if time.monotonic() - self.listed >= WINDOW:
            self.list_processes()
        return waits(self.processes), {"this guest had no processor": stolen(), "the machine was late": self.late}

    def look(self, now, waited, totals):
        """At how long each thread has waited since it began, and at other sums of seconds: what came to them within the last window?"""
        while len(self.looks) > 1 and self.looks[1][0] <= now - WINDOW:
            self.looks.pop(0)
        self.looks.append((now, waited, totals))
        _, waited_then, totals_then = self.looks[0]
        if len(self.looks) > 1:
            # Client, gateway and drive act in turn: what one of them waits the others wait too.
            self.found(sum(max(0, seconds - waited_then.get(who, 0)) for who, seconds in waited.items()),
                       "its programs waited for a processor")
            for words, seconds in totals.items():
                self.found(seconds - totals_then[words], words)

    def found(self, seconds, words):
        self.worst = max(self.worst, (seconds, words))

    def evidence(self):
        """Why this time is not to be relied on; empty where it is."""
        seconds, words = self.worst
        return f"{words} for {seconds * 1000:,.0f} ms" if seconds > BOUND else ""


class Trial(unittest.TestResult):
    """One run of a test: what it came to is kept until it is known whether it counts."""

    def __init__(self):
        super().__init__()
        self.told = []

    def tell(self, method, *arguments):
        self.told.append((method, arguments))
        getattr(super(), method)(*arguments)

    def addSuccess(self, *arguments):
        self.tell("addSuccess", *arguments)

    def addError(self, *arguments):
        self.tell("addError", *arguments)

    def addFailure(self, *arguments):
        self.tell("addFailure", *arguments)

    def addSkip(self, *arguments):
        self.tell("addSkip", *arguments)

    def addSubTest(self, *arguments):
        self.tell("addSubTest", *arguments)

    def words(self):
        """The last line of what went wrong first."""
        return (self.failures + self.errors)[0][1].strip().splitlines()[-1]

    def counts_for(self, result):
        for method, arguments in self.told:
            getattr(result, method)(*arguments)


class UndisturbedTest(unittest.TestCase):
    """A test that is run again where it failed and the machine was to blame: each time as a new object, set up from the beginning."""

    watch = Disturbance

    def run(self, result=None):
        result.startTest(self)
        for attempt in range(1, ATTEMPTS + 1):
            trial = Trial()
            with self.watch() as disturbance:
                type(self)(self._testMethodName).run_once(trial)
            if trial.wasSuccessful():
                break
            reason = disturbance.evidence()
            failed = f"{self.id()}: attempt {attempt} has failed: {trial.words()}\n    "
            if not reason or attempt == ATTEMPTS:
                print(f"{failed}{reason or 'the machine was not disturbed'}", flush=True)
                break
            print(f"{failed}{reason}: run again", flush=True)
        trial.counts_for(result)
        result.stopTest(self)
        return result

    def run_once(self, result):
        super().run(result)
