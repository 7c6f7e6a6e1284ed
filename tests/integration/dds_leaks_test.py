# SPDX-License-Identifier: Apache-2.0
"""axisgate-dds is killed again and again: neither files of shared memory nor ports, descriptors or processes are left behind. The story
has a network and a /dev/shm of its own, so that what is there is of this gateway."""
from own_network import make_interfaces  # first: see there

import os
import signal
import subprocess

from dds_stage import CYCLONE, DdsStory, main
from processes import until


def setUpModule():
    make_interfaces()


class Killed(DdsStory):
    lines_of = ("serial",)
    dds = {"ros2": True}  # with shared memory
    kills = int(os.environ.get("AXISGATE_KILLS", "6"))  # the pause before each start doubles

    def left(self):
        """Descriptors of the gateway, UDP ports that anybody holds, files of shared memory, dead children."""
        listed = subprocess.run(["ps", "--no-headers", "-o", "stat", "--ppid", str(self.gateway.pid)],
                                capture_output=True, text=True, check=False).stdout
        with open("/proc/net/udp", encoding="ascii") as file:
            ports = len(list(file)) - 1
        return {"descriptors": len(os.listdir(f"/proc/{self.gateway.pid}/fd")), "ports": ports, "files": len(os.listdir("/dev/shm")),
                "zombies": sum(line.startswith("Z") for line in listed.split())}

    def once_more(self):
        """Killed, started anew, and its topics come back."""
        before, place = self.dds_process(), self.reader.now()
        os.kill(before, signal.SIGKILL)
        until("another process is there", lambda: self.dds_process() not in (None, before))
        self.reader.wait("matched", "axis_state", lambda told: told["count"] > 0, place)
        self.reader.sample("axis_state", since=self.reader.now(), axis=1)

    def test_nothing_is_left_behind(self):
        self.begin()
        self.reader = self.peer_of(CYCLONE).read("axis_state")
        self.once_more()  # what the library keeps from one life to the next is there then
        before = self.left()
        for _ in range(self.kills - 1):
            self.once_more()
        until("no more than after the first one", lambda: all(count <= before[what] for what, count in self.left().items()), 10)


if __name__ == "__main__":
    main()
