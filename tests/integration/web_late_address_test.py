# SPDX-License-Identifier: Apache-2.0
"""The page's address comes after the gateway has started: the axes are served without it, and the page as soon as it is there."""
from own_network import OTHER, ip, make_interfaces  # first: see there

import json

from processes import until
from stage import PORTS, Story, main

LATE = "10.77.0.98"
LISTENER_DOWN = 1 << 14


def setUpModule():
    make_interfaces()


class Late(Story):
    lines = {"lift": "jd@1"}

    def buses(self):
        return super().buses()[:1]

    def configure(self, listeners=None, buses=None, name="gateway.json"):
        super().configure(listeners, buses, name)
        with open(self.config, encoding="utf-8") as file:
            config = json.load(file)
        config["web"] = {"listen": f"{LATE}:{PORTS.free()}", "insecure": True, "allow": [{"from": "10.77.0.0/24"}]}
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file, indent=2)

    def is_down(self):
        return bool(self.client.gateway()["alarms"] & LISTENER_DOWN)

    def test_the_axes_are_served_and_the_page_follows(self):
        self.start()
        self.gateway.wait_for("axisgate-web has no such address yet on this computer as `listen` of `web` names; trying again each second")
        until("the alarm", self.is_down)
        ip("address", "add", f"{LATE}/24", "dev", OTHER)
        self.addCleanup(ip, "address", "del", f"{LATE}/24", "dev", OTHER)
        self.gateway.wait_for("axisgate-web .* runs")
        until("the alarm is gone", lambda: not self.is_down())


if __name__ == "__main__":
    main()
