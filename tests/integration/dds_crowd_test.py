# SPDX-License-Identifier: Apache-2.0
"""Readers that are many or deaf hold up nobody."""
import collections
import signal

from dds_stage import CYCLONE, FAST, RPM, DdsStory, main
from modbus import Axis
from processes import until

READERS = 20


class Crowd(DdsStory):
    lines_of = ("serial",)

    def setUp(self):
        super().setUp()
        self.begin()
        self.process = self.dds_process()
        self.axis = Axis(self.peer(), 1)

    def assert_all_hear(self, readers, rpm):
        """A change of the axis that was made after this, and by the process that has been there all along."""
        places = [reader.now() for reader in readers]
        self.axis.set(target_velocity=rpm * 1000)
        for reader, place in zip(readers, places):
            self.at = reader.name
            reader.sample("axis_state", lambda data: abs(data["velocity"] - rpm * RPM) < 20 * RPM, place, axis=1)
        self.at = None
        self.assertEqual(self.dds_process(), self.process)

    def test_deaf_readers_and_twenty_others(self):
        deaf = [self.peer_of(vendor).read("axis_state") for vendor in (FAST, CYCLONE)]
        many = self.peer_of(FAST)
        for _ in range(READERS):
            many.say("reader", "axis_state")
        for count in range(READERS):
            many.wait("matched", "axis_state", since=0, look=lambda told, count=count: len(many.all("matched", "axis_state")) > count)
        live = self.peer_of(CYCLONE).read("axis_state")
        for reader in deaf:
            self.addCleanup(reader.send, signal.SIGCONT)
            reader.send(signal.SIGSTOP)
        self.set_running(self.axis)
        for rpm in (200, 300, 250):
            self.assert_all_hear([live, many], rpm)
        until("each of the many has heard one state", lambda: READERS in collections.Counter(
            sample["sequence_number"] for sample in many.samples("axis_state", axis=1)).values())
        for reader in deaf:
            reader.send(signal.SIGCONT)
        self.assert_all_hear([*deaf, live], 200)


if __name__ == "__main__":
    main()
