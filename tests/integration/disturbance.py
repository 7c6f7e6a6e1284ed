"""Tells a program that fails from a machine that had no time for it.

Stories start real programs, and much of what they ask is about time: a lease runs out after a second in which its owner was silent, a
drive's watchdog after one in which the gateway was. A machine that stands still for as long (a guest whose host is busy, a processor
shared with other work) makes the living look dead, and what a story then sees says nothing about axisgate. So all the while a test
runs, a thread watches whether it and its programs could run; a test that failed while they could not is set up and run anew. Without
such evidence a failure is one at once, and a test that passed has passed.
"""
import os
import threading
import time
import unittest

ATTEMPTS = 5
PERIOD = 0.02  # seconds between two looks at the clock
LOOK_EVERY = 0.25  # seconds between two looks at the processes
WINDOW = 1.0  # the shortest lease, and the time of most watchdogs
# The sooner half of such a time is what the gateway, its client and the drive need in turn, at their usual pace. Three of them that
# each lack a bit more than a seventh of it have used up the other half.
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
    """How many seconds each processor of this guest was somebody else's."""
    rows = [line.split() for line in read("/proc/stat").splitlines() if line.startswith("cpu")]
    return {row[0]: int(row[8]) * TICK for row in rows[1:] if len(row) > 8}


class Disturbance:
    """Watches this process and all that it starts, from `with` on."""

    def __init__(self):
        self.worst = (0, "")
        self.looks = []
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.watch, daemon=True)

    def __enter__(self):
        self.processes, self.listed = family(os.getpid()), time.monotonic()
        self.look(self.listed, self.waited_so_far())
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()
        self.look(time.monotonic(), self.waited_so_far())

    def watch(self):
        last = looked = time.monotonic()
        over = False
        while not over:
            over = self.over.wait(PERIOD)
            now = time.monotonic()
            self.passed(now - last)
            last = now
            if now - looked >= LOOK_EVERY:
                looked = now
                self.look(now, self.waited_so_far())

    def waited_so_far(self):
        if time.monotonic() - self.listed >= WINDOW:
            self.processes, self.listed = family(os.getpid()), time.monotonic()
        return {**waits(self.processes), **stolen()}

    def passed(self, seconds):
        """So long after the last look at the clock came this one."""
        self.found(seconds - PERIOD, "the machine stood still")

    def look(self, now, waited):
        """At all that waited, each with its time since it began: what came to it within the last window?"""
        while len(self.looks) > 1 and self.looks[1][0] <= now - WINDOW:
            self.looks.pop(0)
        if self.looks:
            before = self.looks[0][1]
            for who, seconds in waited.items():
                more = seconds - before.get(who, 0)
                if more > self.worst[0]:
                    self.found(more, self.words(who))
        self.looks.append((now, waited))

    @staticmethod
    def words(who):
        if isinstance(who, str):
            return f"{who} was taken from this machine"
        name = read(f"/proc/{who[0]}/comm").strip() or "a program that has ended"
        return f"{name} waited for a processor"

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
            if not reason or attempt == ATTEMPTS:
                print(f"{self.id()}: attempt {attempt} has failed; {reason or 'the machine was not disturbed'}", flush=True)
                break
            print(f"{self.id()}: attempt {attempt} has failed; {reason}: run again", flush=True)
        trial.counts_for(result)
        result.stopTest(self)
        return result

    def run_once(self, result):
        super().run(result)
