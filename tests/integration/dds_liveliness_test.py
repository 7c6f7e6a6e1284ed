# SPDX-License-Identifier: Apache-2.0
"""A DDS master that is gone: its process is killed, its writer deleted, or it says nothing any more. Its motor stops."""
import signal
import time

from dds_stage import CYCLONE, FAST, LEASE, RPM, VENDORS, DdsStory, main
from lease_stage import ANOTHER
from modbus import Axis
from processes import until


class Masters(DdsStory):
    """A master of each vendor with a motor of its own; both go in the same way."""

    lines_of = ("serial", "modbus")
    lease = {"timeout_ms": 1500}
    vendors = VENDORS
    lives_by = ()

    def setUp(self):
        super().setUp()
        self.begin()
        self.events = self.peer_of(FAST).read("axis_event")
        self.masters = {}
        for number, vendor in zip(self.numbers, self.vendors):
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
    vendors = (FAST,)

    def test_their_processes_are_killed(self):
        self.each_goes(lambda master: master.process.kill())
        self.assert_another_may()

    def test_their_processes_stand_still(self):
        for master in self.masters.values():
            self.addCleanup(master.send, signal.SIGCONT)
        self.each_goes(lambda master: master.send(signal.SIGSTOP))

    def test_their_writers_are_deleted(self):
        self.each_goes(lambda master: master.delete())
        self.assert_another_may()

    def test_they_leave_in_good_order(self):
        self.each_goes(lambda master: master.leave())


class GoneCyclone(Gone):
    vendors = (CYCLONE,)

    def test_their_processes_are_killed(self):  # a class is run where it has a test of its own; the others are inherited
        super().test_their_processes_are_killed()


class ByHand(Masters):
    """MANUAL_BY_TOPIC: the program says that it lives, not its library."""

    lease = {"timeout_ms": 3000}
    lives_by = ("manual", 2000)

    def test_they_assert_their_liveliness_and_then_do_not(self):
        self.go_on(lambda number, master: master.say("assert", "axis_command"))
        self.each_goes(lambda master: self.assertIsNone(master.process.poll(), "the process itself is well"))
        for master in self.masters.values():
            master.wait("liveliness_lost", "axis_command")

    def test_one_that_goes_takes_no_other_with_it(self):
        def stopped():
            self.masters[2].say("assert", "axis_command")
            self.assertNotEqual(self.speed(2), 0)
            return self.speed(1) == 0

        self.masters[1].process.kill()
        until("motor 1 is stopped", stopped)
        self.assertIn("stop_latched", self.watched(1).inputs())
        self.assertNotIn("stop_latched", self.watched(2).inputs())
        self.enable(Axis(self.peer(), 1))
        self.let_go(self.masters[2], 2)


class ByTheirLibraries(Masters):
    """AUTOMATIC: a library says so for its program, whatever that one does. It counts for nothing, and is told so."""

    lease = {"timeout_ms": 3000}
    lives_by = ("automatic", 1000)
    told = "its AUTOMATIC liveliness counts for nothing"

    def test_it_keeps_no_axis(self):
        until("the log says so of each", lambda: self.gateway.text().count(self.told) >= len(self.masters))
        self.each_goes(lambda master: self.assertIsNone(master.process.poll(), "the process itself is well"))
        self.assertEqual(self.gateway.text().count(self.told), len(self.masters), "once for each writer")

    def test_a_bystander_takes_no_master_with_it(self):
        """One with such a lease that never writes once made everybody's leases doubtful."""
        self.peer_of(FAST).writer("axis_command", "automatic", 1000)
        self.peer_of(CYCLONE).writer("axis_command", "automatic", 1000)
        self.go_on(lambda number, master: master.do(number, target_velocity=300 * RPM))


class ByParticipant(ByTheirLibraries):
    lives_by = ("participant", 1000)
    told = "its MANUAL_BY_PARTICIPANT liveliness counts for nothing"

    def test_it_keeps_no_axis(self):
        super().test_it_keeps_no_axis()


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

    def test_nobody_beats_for_another(self):
        impostor = self.peer_of(FAST)
        impostor.writer("heartbeat")
        clients = [master.guids["axis_command"] for master in self.masters.values()]

        def all_stand():
            for client in clients:
                self.counter += 1
                impostor.beat(self.counter, client=client)
            return all(self.speed(number) == 0 for number in self.masters)

        until("their axes stand", all_stand)

    def test_who_ends_its_heartbeat_is_gone(self):
        (number, master), = ((each, master) for each, master in self.masters.items() if master.vendor == CYCLONE)
        self.at = master.name
        place = self.events.now()

        def told():  # each may be lost
            self.counter += 2
            master.beat(self.counter)
            master.beat(self.counter + 1, verb="writedispose")
            return any("is gone" in event["text"] for event in self.events.samples("axis_event", place, axis=number, kind=LEASE))

        until("it is told as gone", told)
        self.assert_stopped_for_good(number)

    def test_who_asks_for_a_shorter_lease_is_stopped_sooner(self):
        place = self.events.now()

        def all_stand():  # the first of these that arrives counts, and no other
            for master in self.masters.values():
                master.beat(1, lease_ms=300)
            return all(self.speed(number) == 0 for number in self.masters)

        until("their axes stand", all_stand)
        self.assert_stopped(place)
        for number in self.masters:
            told = self.events.sample("axis_event", lambda event: "has run out" in event["text"], since=place, axis=number, kind=LEASE)
            self.assertIn("for 300 ms", told["text"])


class Endless(Masters):
    """Writers with an infinite lease: silent, they might as well be dead. Only samples keep their axes."""

    lease = {"timeout_ms": 3000}
    lives_by = ()

    def test_they_write_samples_and_then_do_not(self):
        self.go_on(lambda number, master: master.do(number, target_velocity=300 * RPM))
        self.each_goes(lambda master: self.assertIsNone(master.process.poll(), "the process itself is well"))


if __name__ == "__main__":
    main()
