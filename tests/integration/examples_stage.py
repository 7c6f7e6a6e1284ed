# SPDX-License-Identifier: Apache-2.0
"""What the stories of deploy/examples need: the examples' own configuration before a simulated drive, and what its motor does."""
import json
import os
import re

from processes import until
from stage import SOURCE, Story, main  # noqa: F401 main: for the stories

EXAMPLES = f"{SOURCE}/deploy/examples"
PROGRAMS, TOOLS, FLOATS, FUNCTION_6 = range(4)  # the listeners of deploy/examples/modbus/gateway.json
TURN = 10000
FAR = 9000  # turns


def without_comments(text):
    return re.sub(r'("(?:[^"\\]|\\.)*")|//[^\n]*', lambda found: found[1] or "", text)


class Examples(Story):
    """The examples' own configuration, on free ports and before a simulated drive."""

    lines = {"lift": "jd@1"}
    lease_ms = None  # as it is written there
    listener_options = {}

    def setUp(self):
        super().setUp()
        with open(f"{EXAMPLES}/modbus/gateway.json", encoding="utf-8") as file:
            config = json.loads(without_comments(file.read()))
        listeners = [{**entry, **self.listener_options, "listen": self.listener()["listen"]} for entry in config["modbus_tcp"]]
        for bus in config["buses"]:
            # A machine that is busy with something else keeps a simulated drive from its answer.
            bus.update(device=self.path(os.path.basename(bus["device"])), timeout_ms=1000)
            for axis in (axis for drive in bus["drives"] for axis in drive["axes"]):
                axis["lease"]["timeout_ms"] = self.lease_ms or axis["lease"]["timeout_ms"]
        self.start(listeners, config["buses"])

    def position(self):
        return self.sim.object("lift/1", "6063.00") / TURN

    def speed(self):
        return self.sim.object("lift/1", "606C.00")

    def until_it_turns(self):
        until("the motor turns", lambda: self.speed() != 0)

    def until_it_stands_without_torque(self):
        until("it stands", lambda: self.speed() == 0 and self.speed() == 0)
        self.axis(1).until_input("enabled", False)
