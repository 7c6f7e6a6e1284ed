# SPDX-License-Identifier: Apache-2.0
"""An address that this computer gets after the gateway has started: what is there is served, and the other one as soon as it comes."""
from own_network import OTHER, ip, make_interfaces  # first: see there

import socket

from modbus import Client
from processes import until
from stage import PORTS, Gateway, Story, main

LATE = "10.77.0.99"
LISTENER_DOWN = 1 << 14


def setUpModule():
    make_interfaces()


class Late(Story):
    lines = {"lift": "jd@1"}

    def setUp(self):
        super().setUp()
        self.addCleanup(self.take_address_away)

    def take_address_away(self):
        if self.has_address:
            ip("address", "del", f"{LATE}/24", "dev", OTHER)

    has_address = False

    def give_address(self):
        ip("address", "add", f"{LATE}/24", "dev", OTHER)
        self.has_address = True

    def buses(self):
        return super().buses()[:1]

    def late_listener(self):
        return {"listen": f"{LATE}:{PORTS.free()}"}

    def is_down(self):
        return bool(self.client.gateway()["alarms"] & LISTENER_DOWN)

    def assert_late_one_serves(self, place):
        client = Client(self.ports[place], 1, host=LATE)
        self.addCleanup(client.close)
        self.assertEqual(client.gateway()["axis_count"], 1)
        until("the alarm is gone", lambda: not self.is_down())

    def test_the_other_listener_serves_and_it_follows(self):
        self.simulate()
        self.configure([self.late_listener(), self.listener()])
        self.run_gateway()
        self.client = self.connect(1)
        self.until_online()
        self.assertTrue(self.is_down())
        self.gateway.wait_for(f"warning gateway: /modbus_tcp/0/listen: cannot listen on {LATE}:.*trying again each second")
        self.give_address()
        self.gateway.wait_for(f"listening on {LATE}:")
        self.assert_late_one_serves(0)

    def test_a_reload_adds_one_that_is_not_there_yet(self):
        self.start([self.listener()])
        self.assertFalse(self.is_down())
        self.configure([{"listen": f"127.0.0.1:{self.ports[0]}"}, self.late_listener()])
        reload = self.command_line("reload", self.config)
        self.assertEqual(reload.returncode, 0, reload.stderr)
        until("the alarm", self.is_down)
        self.give_address()
        self.gateway.wait_for(f"listening on {LATE}:")
        self.assert_late_one_serves(1)

    def test_one_that_is_taken_ends_the_start_as_ever(self):
        with socket.socket() as holder:
            holder.bind(("127.0.0.1", 0))
            holder.listen()
            self.configure([self.late_listener(), {"listen": f"127.0.0.1:{holder.getsockname()[1]}"}])
            gateway = self.keep(Gateway(self.config))
            self.assertEqual(gateway.ended(), 1)
        self.assertIn("/modbus_tcp/1/listen: cannot listen on", gateway.text())


if __name__ == "__main__":
    main()
