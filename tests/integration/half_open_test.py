# SPDX-License-Identifier: Apache-2.0
"""A master on another computer whose network is gone: not one packet says so, in neither direction. The network is a pair of interfaces
between two namespaces, and one end is taken down."""
from own_network import HOST, HOST_ADDRESS, OTHER_ADDRESS, in_host, make_host, make_interfaces  # first: see there

import socket
import struct
import subprocess

from lease_stage import NOBODY, RPM, Machine, main
from processes import Program, until
from stage import SOURCE

ESTABLISHED = "01"  # as /proc/net/tcp has it
MASTER = f"""
import sys
sys.path.insert(0, "{SOURCE}/tests/integration")
from modbus import Axis, Client
from pymodbus.client import ModbusTcpClient
client = Client.__new__(Client)
client.unit, client.tcp = 1, ModbusTcpClient("{OTHER_ADDRESS}", port=int(sys.argv[1]), timeout=60, retries=0)
assert client.tcp.connect()
axes = [Axis(client, number) for number in map(int, sys.argv[2:])]
for axis in axes:
    axis.command("enable")
    axis.set(target_velocity={300 * RPM})
    axis.command("run_velocity")
print("runs", flush=True)
while True:  # it lives, and asks
    for axis in axes:
        axis.block()
"""


class Master(Machine):
    lines_of = ("serial", "stepper", "leadshine")
    allow = [{"from": "127.0.0.0/8", "role": "engineer"}, {"from": "10.77.0.0/24", "role": "operator"}]

    @classmethod
    def setUpClass(cls):
        make_interfaces()
        make_host()

    def setUp(self):
        super().setUp()
        self.set_cable("up")  # a test that was disturbed is run again, and has left it out

    def listener(self, **more):
        entry = super().listener(**more)
        return {**entry, "listen": entry["listen"].replace("127.0.0.1", "0.0.0.0")}

    def test_its_motors_stop_and_it_is_given_up_and_others_go_on(self):
        self.begin()
        master = self.keep(Program("the master", [*in_host(), "/usr/bin/python3", "-B", "-c", MASTER, str(self.ports[0]),
                                                  *map(str, self.numbers)]))
        master.wait_for("^runs")
        for number in self.each():
            self.until_it_turns(number)
        self.cut()
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assertEqual(self.watched(number).get("owner"), NOBODY)
        until("the system has given its connection up", lambda: not self.connections())
        for number in self.each():
            self.assert_it_can_be_had_again(number)

    def cut(self):
        """At the master's end: what the gateway sends is on its way for ever."""
        self.assertTrue(self.connections())
        self.set_cable("down")

    @staticmethod
    def set_cable(state):
        subprocess.run([*in_host(), "ip", "link", "set", HOST, state], check=True)

    def connections(self):
        """Of the master, that the gateway's system has."""
        with open(f"/proc/{self.gateway.pid}/net/tcp", encoding="ascii") as file:
            rows = [line.split() for line in list(file)[1:]]
        far = struct.unpack("=I", socket.inet_aton(HOST_ADDRESS))[0]
        return [row for row in rows if row[2].startswith(f"{far:08X}:") and row[3] == ESTABLISHED]


if __name__ == "__main__":
    main()
