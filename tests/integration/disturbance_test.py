# SPDX-License-Identifier: Apache-2.0
"""A test that fails is run again where the machine was to blame, and nowhere else.

Run as: disturbance_test.py AXISGATE AXISGATE_SIM SOURCE_FOLDER [unittest's arguments] (as the stories, of which it needs none)
"""
import io
import os
import signal
import subprocess
import sys
import unittest
from contextlib import redirect_stdout

from disturbance import ATTEMPTS, BOUND, PERIOD, Disturbance, UndisturbedTest, family, waits

STOOD_STILL = "the machine stood still for 1,230 ms"


def results_of(test):
    """What a run of it reports, and what it prints."""
    result, printed = unittest.TestResult(), io.StringIO()
    with redirect_stdout(printed):
        test.run(result)
    return result, printed.getvalue()


class Told:
    """Stands in for the watch: says of each attempt in turn what the machine did."""

    def __init__(self, *reasons):
        self.reasons = list(reasons)

    def __call__(self):
        return self

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.reason = self.reasons.pop(0)

    def evidence(self):
        return self.reason


def story(watched, *outcomes):
    """A test whose attempts end like this, one after the other; and what it did."""
    left, done = list(outcomes), []

    class Example(UndisturbedTest):
        watch = watched

        def setUp(self):
            done.append("set up")
            self.addCleanup(done.append, "cleaned up")

        def test_it(self):
            self.assertFalse(hasattr(self, "used"), "an object of its own")
            self.used = True
            outcome = left.pop(0)
            if isinstance(outcome, Exception):
                raise outcome

    return Example("test_it"), done


FAILURE, ERROR, PASSES = AssertionError("not so"), ValueError("broken"), None


class Repeats(unittest.TestCase):
    def run_story(self, told, *outcomes):
        test, done = story(Told(*told), *outcomes)
        result, printed = results_of(test)
        self.assertEqual(result.testsRun, 1)
        self.assertEqual(done, ["set up", "cleaned up"] * (len(done) // 2))
        return result, printed, len(done) // 2

    def test_a_failure_while_the_machine_stood_still_is_not_believed(self):
        for outcome in (FAILURE, ERROR):
            with self.subTest(outcome=outcome):
                result, printed, attempts = self.run_story([STOOD_STILL, ""], outcome, PASSES)
                self.assertTrue(result.wasSuccessful())
                self.assertEqual(attempts, 2)
                self.assertIn(f"{STOOD_STILL}: run again", printed)
                self.assertIn(str(outcome), printed, "what it was is told all the same")

    def test_a_failure_of_a_machine_that_ran_is_one_at_once(self):
        for outcome, failures, errors in ((FAILURE, 1, 0), (ERROR, 0, 1)):
            with self.subTest(outcome=outcome):
                result, printed, attempts = self.run_story([""], outcome)
                self.assertEqual((len(result.failures), len(result.errors), attempts), (failures, errors, 1))
                self.assertIn("not disturbed", printed)

    def test_a_failure_that_comes_each_time_is_one_whatever_the_machine_did(self):
        result, printed, attempts = self.run_story([STOOD_STILL] * ATTEMPTS, *[FAILURE] * ATTEMPTS)
        self.assertEqual((len(result.failures), attempts), (1, ATTEMPTS))
        self.assertEqual(printed.count("run again"), ATTEMPTS - 1)

    def test_only_the_evidence_of_the_same_attempt_counts(self):
        result, _, attempts = self.run_story([STOOD_STILL, ""], FAILURE, FAILURE)
        self.assertEqual((len(result.failures), attempts), (1, 2))

    def test_what_passed_has_passed(self):
        result, printed, attempts = self.run_story([STOOD_STILL], PASSES)
        self.assertTrue(result.wasSuccessful())
        self.assertEqual((attempts, printed), (1, ""))


class Evidence(unittest.TestCase):
    def setUp(self):
        self.disturbance = Disturbance()
        self.disturbance.list_processes()

    def test_a_look_at_the_clock_that_comes_late(self):
        self.disturbance.passed(PERIOD + 0.9 * BOUND)
        self.assertEqual(self.disturbance.evidence(), "")
        self.disturbance.passed(PERIOD + 1.23)
        self.disturbance.passed(PERIOD)
        self.assertEqual(self.disturbance.evidence(), STOOD_STILL)
        self.assertAlmostEqual(self.disturbance.so_far()[1]["the machine was late"], 1.23 + 0.9 * BOUND)

    def look(self, *rows, every=0.25):
        """Each row is what two threads had waited, and a sum, at one look."""
        for count, (gateway, drive, total) in enumerate(rows):
            self.disturbance.look(100 + count * every, {"gateway": gateway, "drive": drive}, {"the machine was late": total})
        return self.disturbance.evidence()

    def test_what_was_before_is_nothing(self):
        self.assertEqual(self.look((7.0, 8.0, 9.0), (7.01, 8.02, 9.1)), "")

    def test_what_programs_wait_within_a_second_adds_up(self):
        self.assertEqual(self.look((7.0, 8.0, 0), (7.05, 8.0, 0), (7.05, 8.1, 0), (7.1, 8.1, 0)),
                         "its programs waited for a processor for 200 ms")

    def test_and_so_does_what_comes_late(self):
        self.assertEqual(self.look((7.0, 8.0, 9.0), (7.0, 8.0, 9.1), (7.0, 8.0, 9.2)), "the machine was late for 200 ms")

    def test_but_not_over_many_seconds(self):
        self.assertEqual(self.look(*((7.0 + 0.02 * count, 8.0, 9.0 + 0.03 * count) for count in range(100))), "")

    def test_a_thread_that_is_new_has_waited_within_this_window(self):
        self.disturbance.look(100, {}, {})
        self.disturbance.look(100.5, {"gateway": 0.3}, {})
        self.assertEqual(self.disturbance.evidence(), "its programs waited for a processor for 300 ms")


# The watch in a process of its own: it says when it watches, waits for a line, and tells what it has seen.
WATCHER = """from disturbance import Disturbance
with Disturbance() as seen:
    print('watching', flush=True)
    input()
print(seen.evidence())
"""


class Watches(unittest.TestCase):
    def setUp(self):
        self.process = subprocess.Popen([sys.executable, "-B", "-c", WATCHER], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, cwd=os.path.dirname(os.path.abspath(__file__)))
        self.addCleanup(self.end)
        self.assertEqual(self.process.stdout.readline(), "watching\n")

    def end(self):
        if self.process.returncode is None:
            self.process.communicate("\n")

    def test_a_process_that_was_stopped_knows_how_long(self):
        self.process.send_signal(signal.SIGSTOP)
        os.waitpid(self.process.pid, os.WUNTRACED)
        # Nobody says how long a second is but the clock that it looks at itself.
        subprocess.run(["sleep", "1"], check=True)
        self.process.send_signal(signal.SIGCONT)
        told, _ = self.process.communicate("\n")
        self.assertRegex(told, r"^the machine (stood still|was late) for [\d,]*\d{3} ms\n$")

    def test_it_looks_at_all_that_a_story_has_started(self):
        known = family(os.getpid())
        self.assertIn(self.process.pid, known)
        waited = waits(known)
        self.assertIn((os.getpid(), str(os.getpid())), waited)
        self.assertGreaterEqual(len([process for process, _ in waited if process == self.process.pid]), 2, "each of its threads")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
