# SPDX-License-Identifier: Apache-2.0
"""A DDS master that is gone: its process is killed or stands still, or it says nothing any more. Its motor stops."""
import signal
import time

from dds_stage import FAST, LEASE, VENDORS, DdsStory, main
from lease_stage import ANOTHER
from processes import until


class Masters(DdsStory):
    """A master of each vendor with a motor of its own; both go in the same way."""

    lines_of = ("serial", "modbus")
    lease = {"timeout_ms": 1500}
    lives_by = ()

    def setUp(self):
        super().setUp()
        self.begin()
        self.events = self.peer_of(FAST).read("axis_event")
        self.masters = {}
        for number, vendor in zip(self.numbers, VENDORS):
            self.at = vendor
            self.masters[number] = self.commander(vendor, "strength", 1, *self.lives_by)
        for number, master in self.masters.items():  # all are there before the first of them has to say again that it lives
            self.at = master.name
            self.run_by_dds(master, number)
        self.at = None

    def go_on(self, keep_alive=lambda number, master: None):
        """For longer than any lease, though nothing is asked for."""
        end = time.monotonic() + 1.5 * self.lease["timeout_ms"] / 1000
        while time.monotonic() < end:
            for number, master in self.masters.items():
                self.at = master.name
                keep_alive(number, master)
                self.assertEqual(self.watched(number).get("owner"), ANOTHER)
                self.assertNotEqual(self.speed(number), 0)
        self.at = None

    def each_goes(self, leave):
        place = self.events.now()
        for master in self.masters.values():
            leave(master)
        self.assert_stopped(place)

    def assert_stopped(self, place):
        for number, master in self.masters.items():
            self.at = master.name
            self.assert_stopped_for_good(number)
            self.events.sample("axis_event", lambda event: "has run out" in event["text"], since=place, axis=number, kind=LEASE)
        self.at = None

    def assert_another_may(self):
        for number, vendor in zip(self.masters, reversed(VENDORS)):
            self.at = vendor
            peer = self.commander(vendor, "strength", 1, *self.lives_by)
            self.run_by_dds(peer, number, rpm=-200)
            self.let_go(peer, number)
        self.at = None


class Gone(Masters):
    def test_their_processes_are_killed(self):
        self.each_goes(lambda master: master.process.kill())
        self.assert_another_may()

    def test_their_processes_stand_still(self):
        for master in self.masters.values():
            self.addCleanup(master.send, signal.SIGCONT)
        self.each_goes(lambda master: master.send(signal.SIGSTOP))


class ByHand(Masters):
    """MANUAL_BY_TOPIC: the program says that it lives, not its library."""

    lease = {"timeout_ms": 3000}
    lives_by = ("manual", 2000)

    def test_they_assert_their_liveliness_and_then_do_not(self):
        self.go_on(lambda number, master: master.say("assert", "axis_command"))
        self.each_goes(lambda master: self.assertIsNone(master.process.poll(), "the process itself is well"))
        for master in self.masters.values():
            master.wait("liveliness_lost", "axis_command")


class ByTheirLibraries(Masters):
    """AUTOMATIC: a library says so for its program, whatever that one does. It counts for nothing, and is told so."""

    lease = {"timeout_ms": 3000}
    lives_by = ("automatic", 1000)
    told = "its AUTOMATIC liveliness counts for nothing"

    def test_it_keeps_no_axis(self):
        until("the log says so of each", lambda: self.gateway.text().count(self.told) >= len(self.masters))
        self.each_goes(lambda master: self.assertIsNone(master.process.poll(), "the process itself is well"))
        self.assertEqual(self.gateway.text().count(self.told), len(self.masters), "once for each writer")


class ByHeartbeat(Masters):
    """axisgate/heartbeat: a counter that changes, from the participant of the writer of commands."""

    lease = {"timeout_ms": 4000}

    def setUp(self):
        super().setUp()
        self.counter = 0
        for master in self.masters.values():
            master.writer("heartbeat")

    def beat(self, number, master):
        del number
        self.counter += 1
        master.beat(self.counter)

    def test_a_counter_that_changes_keeps_their_axes_and_one_that_stands_does_not(self):
        self.go_on(self.beat)
        place = self.events.now()

        def all_stand():
            for master in self.masters.values():
                master.beat(self.counter)
            return all(self.speed(number) == 0 for number in self.masters)

        until("their axes stand", all_stand)
        self.assert_stopped(place)


if __name__ == "__main__":
    main()
