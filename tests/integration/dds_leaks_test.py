# SPDX-License-Identifier: Apache-2.0
"""axisgate-dds is killed again and again: neither files of shared memory nor ports, descriptors or processes are left behind. The story
has a network and a /dev/shm of its own, so that what is there is of this gateway."""
from own_network import make_interfaces  # first: see there

import os
import signal
import subprocess

from dds_stage import CYCLONE, DdsStory, main
from processes import until
from stage import Gateway

GATEWAYS = 4
# Of each: the pause before a start doubles with each kill, so 20 of one gateway would take minutes.
KILLS = int(os.environ.get("AXISGATE_KILLS", "5"))


def setUpModule():
    make_interfaces()


class Killed(DdsStory):
    """Four gateways, each killed five times: 20 kills. Their lines are not plugged in: the DDS half is all the same."""

    lines_of = ("serial",)
    dds = {"ros2": True}  # with shared memory

    def start_gateways(self):
        self.gateways = []
        for number in range(GATEWAYS):
            self.gateway_name = f"cell_{number}"
            self.configure(name=f"{self.gateway_name}.json")
            self.gateways.append(self.keep(Gateway(self.config)).wait_until_it_listens())

    def processes(self):
        """The axisgate-dds of each gateway that has one."""
        found = {}
        for self.gateway in self.gateways:
            if (process := self.dds_process()) is not None:
                found[self.gateway] = process
        return found

    def left(self):
        """Descriptors of the gateways, UDP ports that anybody holds, files of shared memory, and all that the gateways have started."""
        with open("/proc/net/udp", encoding="ascii") as file:
            ports = len(list(file)) - 1
        parents = ",".join(str(gateway.pid) for gateway in self.gateways)
        children = subprocess.run(["ps", "--no-headers", "-o", "pid", "--ppid", parents], capture_output=True, text=True, check=False).stdout
        return {"descriptors": sum(len(os.listdir(f"/proc/{gateway.pid}/fd")) for gateway in self.gateways), "ports": ports,
                "files": len(os.listdir("/dev/shm")), "children": len(children.split())}

    def until_their_topics_come(self, since):
        for number in range(GATEWAYS):
            self.reader.sample("axis_state", since=since, axis=1, gateway=f"cell_{number}")

    def kill_each(self):
        """Killed, started anew, and its topics come back."""
        before = self.processes()
        self.assertEqual(len(before), GATEWAYS)
        for process in before.values():
            os.kill(process, signal.SIGKILL)
        until("each has another process", lambda: len({*self.processes().items()} - {*before.items()}) == GATEWAYS)
        self.until_their_topics_come(self.reader.now())

    def test_nothing_is_left_behind(self):
        self.start_gateways()
        self.reader = self.peer_of(CYCLONE).read("axis_state")
        self.until_their_topics_come(0)
        self.kill_each()  # what the library keeps from one life to the next is there then
        before = self.left()
        for _ in range(KILLS - 1):
            self.kill_each()
        until(f"no more than after the first ones: {before}", lambda: all(count <= before[what] for what, count in self.left().items()))


if __name__ == "__main__":
    main()
