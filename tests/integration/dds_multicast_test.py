# SPDX-License-Identifier: Apache-2.0
"""A loopback with the multicast flag, as some computers of ROS 2 have it: readers of Cyclone DDS there name a multicast address, and two of
them ended a writer of Fast DDS 2.9.1 by an assertion. The gateway's DDS process goes on."""
from own_network import ip, make_interfaces  # first: see there

from dds_stage import CYCLONE, RPM, DdsStory, Peer, main
from modbus import Axis

READERS = 2
# As the pages have it for a loopback, but with multicast. Only found by unicast (Peers) do such readers meet a writer that does not know
# their multicast address yet.
LOOPBACK = "env", "CYCLONEDDS_URI=<General><Interfaces><NetworkInterface name='lo'/></Interfaces><AllowMulticast>true</AllowMulticast>" \
    "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>30</MaxAutoParticipantIndex>" \
    "<Peers><Peer address='127.0.0.1'/></Peers></Discovery>"


def setUpModule():
    make_interfaces()
    ip("link", "set", "lo", "multicast", "on")
    ip("route", "add", "239.0.0.0/8", "dev", "lo")


class Loopback(DdsStory):
    lines_of = ("serial",)

    def test_two_readers_of_cyclone_hear_the_same_process_all_along(self):
        self.begin()
        process = self.dds_process()
        axis = Axis(self.peer(), 1)
        self.set_running(axis, 200)
        readers = []
        for _ in range(READERS):
            reader = self.keep(Peer(CYCLONE, self.domain, LOOPBACK, "as_it_comes"))
            for topic in ("axis_state", "axis_event"):
                reader.read(topic)
            readers.append(reader)
        for rpm in (300, -300, 200):
            places = [reader.now() for reader in readers]
            axis.set(target_velocity=rpm * 1000)
            for reader, place in zip(readers, places):
                reader.sample("axis_state", lambda data: abs(data["velocity"] - rpm * RPM) < 20 * RPM, place, axis=1)
        self.assertEqual(self.dds_process(), process)


if __name__ == "__main__":
    main()
