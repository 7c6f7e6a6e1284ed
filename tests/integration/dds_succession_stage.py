# SPDX-License-Identifier: Apache-2.0
"""A DDS master on another host goes, in each way in which one can, and another program wants its axis: what the stories of that and the
table of its times (tests/bench/dds/masters) share."""
from own_network import HOST, OTHER, OTHER_ADDRESS, in_host, make_host, make_interfaces  # first: see there

import signal
import subprocess

from dds_stage import DdsStory, Peer

# How strong the successor of a master of strength 5 is.
STRENGTHS = {"equal": ("strength", 5), "stronger": ("strength", 9), "weaker": ("strength", 1), "shared": ("shared",)}
MASTER = {"shared": ("shared",)}
WAYS = ("leave", "kill", "stand", "cut")


def make_network():
    make_interfaces()
    make_host()


def on_host(*arguments):
    subprocess.run([*in_host(), "ip", *arguments], check=True)


class Succession(DdsStory):
    lines_of = ("serial",)
    dds = {"interfaces": ["lo", OTHER], "role": "engineer"}
    relation = "equal"

    def node(self, vendor, *wrapper):
        peer = self.keep(Peer(vendor, self.domain, wrapper, "as_it_comes"))
        peer.name = f"{vendor} {'master' if wrapper else 'successor'} {len(self.programs)}"
        return peer

    def cut(self):
        on_host("link", "set", HOST, "down")

    def mend(self):
        on_host("link", "set", HOST, "up")
        on_host("route", "replace", "default", "via", OTHER_ADDRESS)

    def pair(self, vendors):
        """A master on the other host, whose motor turns, and its successor to be, on the gateway's."""
        master = self.node(vendors[0], *in_host()).command_with(*MASTER.get(self.relation, ("strength", 5)))
        successor = self.node(vendors[1]).command_with(*STRENGTHS[self.relation])
        self.run_by_dds(master, 1)
        return master, successor

    def go(self, way, master):
        if way == "leave":
            master.say("quit")
        elif way == "kill":
            master.process.kill()
        elif way == "stand":
            self.addCleanup(master.send, signal.SIGCONT)
            master.send(signal.SIGSTOP)
        else:
            self.cut()

    def come_back(self, way, master):
        """As far as it can."""
        if way == "stand":
            master.send(signal.SIGCONT)
        if way == "cut":
            self.mend()
