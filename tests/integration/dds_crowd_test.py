# SPDX-License-Identifier: Apache-2.0
"""Readers that are many or deaf hold up nobody, with 200 axes: one whose simulated motor turns, and 199 whose lines are not plugged in. An
axis that is offline has its topic and its events as well."""
import collections
import signal

from dds_stage import CYCLONE, FAST, LINK, RPM, VENDORS, DdsStory, main
from modbus import ONLINE, Axis
from processes import until
from stage import bus, drive

READERS = 20
AXES = 200
BUSES = 4  # that are not plugged in


class Crowd(DdsStory):
    lines_of = ("serial",)
    all_axes = {*range(1, AXES + 1)}

    def buses(self):
        buses, number = super().buses(), len(self.lines_of)
        for place in range(BUSES):
            many = [drive("jd", 1 + node, number + 1 + node) for node in range((AXES - len(self.lines_of) + BUSES - 1 - place) // BUSES)]
            number += len(many)
            buses.append(bus(self.path(f"not-plugged-in-{place}"), *many))
        self.assertEqual(number, AXES)
        return buses

    def until_online(self):
        until("the one that can be is online", lambda: self.watched(1).get("link_state") == ONLINE)

    def assert_all_hear(self, readers, rpm):
        """A change of the axis that was made after this, and by the process that has been there all along."""
        places = [reader.now() for reader in readers]
        self.axis.set(target_velocity=rpm * 1000)
        for reader, place in zip(readers, places):
            self.at = reader.name
            reader.sample("axis_state", lambda data: abs(data["velocity"] - rpm * RPM) < 20 * RPM, place, axis=1)
        self.at = None
        self.assertEqual(self.dds_process(), self.process)

    def assert_it_hears_all_axes(self, reader, since=0):
        until(f"{reader.name} has heard all axes",
              lambda: {state["axis"] for state in reader.samples("axis_state", since)} >= self.all_axes)

    def assert_a_late_one_hears_the_start(self, late):
        """So little has happened to each axis that all of it is kept: none of the numbers is missing."""
        def heard():
            events = late.samples("axis_event")
            numbers = [event["number"] for event in events]
            return events if sorted(numbers) == list(range(1, len(numbers) + 1)) and {event["axis"] for event in events} >= self.all_axes else None

        events = until(f"{late.name} has heard of all axes", heard)
        for axis in self.all_axes - {1}:
            first = next(event for event in events if event["axis"] == axis)
            self.assertEqual((first["kind"], first["text"]), (LINK, "link unknown -> link_down"))

    def test_deaf_readers_and_twenty_others(self):
        self.begin()
        self.process = self.dds_process()
        self.axis = Axis(self.peer(), 1)
        deaf = [self.peer_of(vendor).read("axis_state").read("axis_event") for vendor in VENDORS]
        many = self.peer_of(FAST)
        for _ in range(READERS):
            many.say("reader", "axis_state")
        for count in range(READERS):
            many.wait("matched", "axis_state", since=0, look=lambda told, count=count: len(many.all("matched", "axis_state")) > count)
        live = self.peer_of(CYCLONE).read("axis_state")
        for reader in deaf:
            self.addCleanup(reader.send, signal.SIGCONT)
            reader.send(signal.SIGSTOP)
        for vendor in self.each_vendor():
            self.assert_a_late_one_hears_the_start(self.peer_of(vendor).read("axis_event"))
        self.set_running(self.axis)
        for rpm in (200, 300, 250):
            self.assert_all_hear([live, many], rpm)
        for reader in (live, many):
            self.assert_it_hears_all_axes(reader, reader.now())
        until("each of the many has heard one state", lambda: READERS in collections.Counter(
            sample["sequence_number"] for sample in many.samples("axis_state", axis=1)).values())
        for reader in deaf:
            reader.send(signal.SIGCONT)
        self.assert_all_hear([*deaf, live], 200)
        for reader in deaf:
            self.assert_it_hears_all_axes(reader)


if __name__ == "__main__":
    main()
